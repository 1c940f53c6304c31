#include "core/scene/passes/near_particles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/scene/passes/scene_view.h"
#include "core/scene/passes/weather_precipitation.h"

namespace trimtab::scene {
namespace {

/// A particle draws its streak for so long, seconds, and the streak is at most this long, metres.
constexpr double kExposureS = 1.0 / 40, kLongestStreakM = 0.9;
/// A fainter particle changes no pixel that one would notice.
constexpr double kFaintest = 0.012;
/// The lattice repeats after so many cells along each axis.
constexpr std::int64_t kLatticeCells = 1 << 16;

/// Many far drops or flakes that are drawn as one soft streak or spot, since each alone is narrower than a
/// pixel.
struct Bundle {
  double radiusM = 0, lengthM = 0, opacity = 0;
};
/// A hollow ball around the eye with particles of its own. Each is about twice as large as the one before and
/// holds about as many, so that the particles in a pixel's solid angle stay few.
struct Shell {
  double nearM, farM;
  double count;        ///< in a view of kReferenceArea, at the greatest amount
  double fallScale;    ///< of the fall speed, so that no two shells fall as one
  Bundle bundle = {};  ///< if its radius is not 0, the shell has bundles
};
constexpr std::array<Shell, 5> kRainShells{{{0.8, 4, 260, 1.04},
                                            {3, 9, 800, 1},
                                            {7, 18, 1500, 0.95},
                                            {14, 36, 1900, 0.91},
                                            {16, 60, 220, 0.93, {0.25, 4, 0.10}}}};
constexpr std::array<Shell, 5> kSnowShells{{{0.8, 4, 160, 1.1},
                                            {3, 10, 700, 1},
                                            {8, 22, 1600, 0.95},
                                            {17, 45, 2400, 0.9},
                                            {18, 70, 700, 0.93, {0.22, 0, 0.14}}}};
/// Width times height of a view at distance 1, 60 by 36 degrees.
constexpr double kReferenceArea = 0.75;

/// Says what distinguishes rain from snow.
struct Kind {
  std::span<const Shell> shells;
  double opacity;    ///< of a particle that does not move
  double smeared;    ///< the least share of it that is left in a long streak
  double realSizeM;  ///< nearer particles get smaller, down to their real size
  double flutterM;   ///< how far a flake swings aside
  /// The greatest part of the image that the particles of one shell may cover; where two overlap, both count.
  /// Rain may cover more than snow, because its streaks are thin and an image needs more of them.
  double mostCovered;
};
constexpr Kind kRain{kRainShells, 0.8, 0.55, 9, 0, 0.12};
constexpr Kind kSnow{kSnowShells, 0.95, 0.35, 7, 0.12, 0.08};

const Kind& kindOf(const PrecipitationView& falling) {
  return falling.kind == Precipitation::snow ? kSnow : kRain;
}

Vec3 finite(Vec3 v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) ? v : Vec3{};
}

double smoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Above a layer of haze the air is clear.
double extinctionAtEye(const SceneView& view) {
  const bool above = view.air.layered && view.heightM > double{view.air.topM};
  return above ? 0 : double{view.air.extinction};
}

/// Applies the finaliser of SplitMix64.
std::uint64_t mixed(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9u;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Returns the lowest, middle and highest 21 bits as 0..1.
Vec3 unitVector(std::uint64_t bits) {
  constexpr auto part = [](std::uint64_t b) { return static_cast<double>(b & 0x1fffff) * 0x1p-21; };
  return {part(bits), part(bits >> 21), part(bits >> 42)};
}

/// Swings once forth and back for x from 0 to 1, about like a sine.
double swing(double x) {
  const double t = 2 * (x - std::floor(x)) - 1;
  return 4 * t * (1 - std::abs(t));
}

/// The pyramid of a view, in eye axes.
class Pyramid {
 public:
  explicit Pyramid(const ViewShape& v)
      : left(std::min(v.left, v.right)),
        right(std::max(v.left, v.right)),
        bottom(std::min(v.bottom, v.top)),
        top(std::max(v.bottom, v.top)) {}

  bool hasArea() const { return std::isfinite(area()) && area() > 0; }
  double area() const { return (right - left) * (top - bottom); }
  /// Reports whether a ball may reach into it.
  bool meets(Vec3 centre, double radius) const {
    const double depth = -centre.z;
    return depth > -radius && left * depth - centre.x <= radius * slant_[0] &&
           centre.x - right * depth <= radius * slant_[1] &&
           bottom * depth - centre.y <= radius * slant_[2] && centre.y - top * depth <= radius * slant_[3];
  }

  const double left, right, bottom, top;  ///< tangents

 private:
  /// Measures of a metre that is square to each side, across the view.
  const std::array<double, 4> slant_{std::hypot(1, left), std::hypot(1, right), std::hypot(1, bottom),
                                     std::hypot(1, top)};
};

/// Holds what the particles of all shells share.
struct Search {
  const PrecipitationView& falling;
  const SceneView& view;
  const Kind& kind;
  const ParticleMotion motion;
  const Pyramid pyramid;
  const Mat3 toWorld;
  const Vec3 eyeInAir;
  const double pixelsPerMetre;  ///< of the image, at 1 m
  const double extinction;
  const double opacity;
  const double haze;      ///< of the bundles' opacity
  const double amount;    ///< of the shells' counts
  const double share;     ///< of these, that is drawn; a wide view lowers it too
  const double stronger;  ///< so many times as strong is each that is drawn, for those that are left out
  const double streakM;
  const double time;
  std::vector<NearParticle>& found;

  double farthest(const Shell& shell) const;
  double radiusOf(const Shell& shell) const;
  double lengthOf(const Shell& shell) const;
  double room(const Shell& shell) const;
  void searchShell(const Shell& shell, std::uint64_t number);
  void searchCell(const Shell& shell, double far, Vec3 corner, double side, std::uint64_t seed, double count);
};

/// Returns the distance beyond which a particle is narrower than three quarters of a pixel, or fog leaves a
/// fiftieth of it.
double Search::farthest(const Shell& shell) const {
  const double wide = 2 * radiusOf(shell) * pixelsPerMetre / 0.75;
  const double clear = extinction > 0 ? 3.9 / extinction : shell.farM;
  return std::min({shell.farM, wide, clear});
}

double Search::radiusOf(const Shell& shell) const {
  return shell.bundle.radiusM > 0 ? shell.bundle.radiusM : motion.radiusM;
}

double Search::lengthOf(const Shell& shell) const {
  return streakM + shell.bundle.lengthM;
}

/// Returns the part of the shell's particles that is drawn. It is below 1 where all of them would cover too
/// much of the image, as long streaks do.
double Search::room(const Shell& shell) const {
  const double perMetre = pixelsPerMetre / (0.75 * shell.farM);
  // The pass draws at least two pixels of the scene.
  const double width = std::max(2 * radiusOf(shell) * perMetre, 2 / falling.renderScale);
  const double covered = amount * shell.count * width * (width + lengthOf(shell) * perMetre);
  const double scene = double{1} * view.shape.widthPx * view.shape.heightPx;
  const double image = scene / (falling.renderScale * falling.renderScale);
  return std::min(1.0, kind.mostCovered * image / covered);
}

void Search::searchShell(const Shell& shell, std::uint64_t number) {
  const double far = farthest(shell);
  if (!(far > shell.nearM)) return;
  const double side = shell.farM / 4, period = side * kLatticeCells;
  const auto wrapped = [period](double x) {
    const double rest = std::fmod(x, period);
    return std::isfinite(rest) ? rest : 0;
  };
  const Vec3 air{wrapped(eyeInAir.x), wrapped(eyeInAir.y),
                 wrapped(wrapped(eyeInAir.z) - wrapped(motion.fall.z * shell.fallScale * time))};
  const double volume = kReferenceArea / 3 * (std::pow(shell.farM, 3) - std::pow(shell.nearM, 3));
  const double count = share * amount * room(shell) * shell.count * side * side * side / volume;

  // A particle may reach out of its cell.
  const double margin = kind.flutterM + lengthOf(shell) + radiusOf(shell);
  Vec3 low, high;
  for (const double x : {pyramid.left, pyramid.right})
    for (const double y : {pyramid.bottom, pyramid.top}) {
      const Vec3 corner = toWorld * (Vec3{x, y, -1} * far);
      low = {std::min(low.x, corner.x), std::min(low.y, corner.y), std::min(low.z, corner.z)};
      high = {std::max(high.x, corner.x), std::max(high.y, corner.y), std::max(high.z, corner.z)};
    }
  const auto first = [&](double air_, double from) {
    return static_cast<std::int64_t>(std::floor((air_ + std::max(from, -far) - margin) / side));
  };
  const auto last = [&](double air_, double to) {
    return static_cast<std::int64_t>(std::floor((air_ + std::min(to, far) + margin) / side));
  };
  const double reach = side * 0.87 + margin;
  for (std::int64_t k = first(air.z, low.z); k <= last(air.z, high.z); ++k)
    for (std::int64_t j = first(air.y, low.y); j <= last(air.y, high.y); ++j)
      for (std::int64_t i = first(air.x, low.x); i <= last(air.x, high.x); ++i) {
        const auto at = [side](std::int64_t cell) { return static_cast<double>(cell) * side; };
        const Vec3 corner = Vec3{at(i), at(j), at(k)} - air;
        const Vec3 middle = corner + Vec3{side, side, side} * 0.5;
        const double distance = length(middle);
        if (distance - reach > far || distance + reach < shell.nearM) continue;
        if (!pyramid.meets(view.eye.axes * middle, reach)) continue;
        const auto bits = [](std::int64_t cell) {
          return static_cast<std::uint64_t>(cell & (kLatticeCells - 1));
        };
        const std::uint64_t seed = mixed(number << 48 | bits(i) << 32 | bits(j) << 16 | bits(k));
        searchCell(shell, far, corner, side, seed, count);
      }
}

void Search::searchCell(const Shell& shell, double far, Vec3 corner, double side, std::uint64_t seed,
                        double count) {
  const bool bundles = shell.bundle.radiusM > 0;
  const double lengthM = lengthOf(shell), reach = lengthM / 2 + radiusOf(shell);
  const Vec3 halfStreak = streakM > 0 ? motion.streak * (lengthM / streakM / 2) : Vec3{};
  for (std::uint64_t i = 0; static_cast<double>(i) < count && found.size() < kMostParticles; ++i) {
    const std::uint64_t bits = mixed(seed + i * 0x9e3779b97f4a7c15u);
    const Vec3 own = unitVector(mixed(bits));
    Vec3 inWorld = corner + unitVector(bits) * side;
    if (kind.flutterM > 0)
      inWorld = inWorld + Vec3{swing(time * 0.31 + own.x), swing(time * 0.37 + own.y), 0} * kind.flutterM;
    const Vec3 p = view.eye.axes * inWorld;
    if (!(p.z < -0.3) || !pyramid.meets(p + halfStreak, reach)) continue;
    const double distance = length(p);
    if (distance > far || distance < shell.nearM) continue;
    const double size = bundles ? 1 : std::clamp(distance / kind.realSizeM, 0.15, 1.0);
    const double radius = radiusOf(shell) * size * (0.6 + 0.8 * own.z);
    const double widthPx = 2 * radius * pixelsPerMetre / -p.z;
    const double strength = std::min(stronger * (bundles ? shell.bundle.opacity * haze : opacity), 1.0) *
                            std::min(1.0, count - static_cast<double>(i)) *
                            smoothStep(shell.nearM, 1.4 * shell.nearM, distance) *
                            (1 - smoothStep(0.75 * far, far, distance)) * smoothStep(0.75, 1.5, widthPx) *
                            std::exp(-extinction * distance);
    if (strength > kFaintest) found.push_back({p, radius, lengthM, strength});
  }
}

}  // namespace

// Size and speed are those that osgParticle::PrecipitationEffect::rain() and snow() give a density.
ParticleMotion particleMotion(const PrecipitationView& falling, const SceneView& view) {
  const bool snow = falling.kind == Precipitation::snow;
  const double density = falling.density;
  const double speed = (snow ? 0.75 + 0.25 * density : 2 + 5 * density) * falling.look.fallSpeed.value();
  const double size = (snow ? 0.02 + 0.03 * density : 0.01 + 0.02 * density) * falling.look.size.value();
  Vec3 back = finite(falling.velocity) + Vec3{0, 0, speed};
  back = back * std::min(kExposureS, kLongestStreakM / std::max(length(back), 1e-3));
  return {{0, 0, -speed}, view.eye.axes * back, size / 2};
}

void findNearParticles(const PrecipitationView& falling, const SceneView& view,
                       std::vector<NearParticle>& particles) {
  particles.clear();
  const Pyramid pyramid(view.shape);
  const double amount = std::min(falling.amount, 1.0), share = std::min(falling.share, 1.0);
  if (!pyramid.hasArea() || !(amount > 0 && share > 0)) return;
  const Kind& kind = kindOf(falling);
  const ParticleMotion motion = particleMotion(falling, view);
  const double size = 2 * motion.radiusM;
  const double still = size / (size + length(motion.streak));
  Search search{.falling = falling,
                .view = view,
                .kind = kind,
                .motion = motion,
                .pyramid = pyramid,
                .toWorld = transposed(view.eye.axes),
                .eyeInAir = finite(view.eye.position - falling.airDrift),
                .pixelsPerMetre = pixelsPerRadian(view.shape) / falling.renderScale,
                .extinction = extinctionAtEye(view),
                .opacity = kind.opacity * (kind.smeared + (1 - kind.smeared) * still),
                .haze = std::max(amount - 0.2, 0.0) / 0.8,
                .amount = amount,
                .share = share * std::min(1.0, kReferenceArea / pyramid.area()),
                .stronger = 1 / share,
                .streakM = length(motion.streak),
                .time = std::isfinite(falling.time) ? falling.time : 0,
                .found = particles};
  for (std::size_t i = 0; i < kind.shells.size(); ++i) search.searchShell(kind.shells[i], i);
}

}  // namespace trimtab::scene
