#include "landscape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "trimtab/terrain/grid/parallel.h"

namespace trimtab::terrain {

double latticeNoise(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9e3779b1u ^
                    static_cast<std::uint32_t>(y) * 0x85ebca77u ^ seed * 0xc2b2ae3du;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  h ^= h >> 15;
  return h / 2147483647.5 - 1;
}

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

double smoothNoise(double x, double y, std::uint32_t seed) {
  const double fx = std::floor(x), fy = std::floor(y);
  const auto i = static_cast<std::int32_t>(fx), j = static_cast<std::int32_t>(fy);
  const auto ease = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
  const double u = ease(x - fx), v = ease(y - fy);
  const double south = latticeNoise(i, j, seed) * (1 - u) + latticeNoise(i + 1, j, seed) * u;
  const double north = latticeNoise(i, j + 1, seed) * (1 - u) + latticeNoise(i + 1, j + 1, seed) * u;
  return south * (1 - v) + north * v;
}

/// Returns how near a point is to a line between two others: 1 on it, falling with the square of the distance
/// over `width`.
double ridge(double x, double y, double x0, double y0, double x1, double y1, double width) {
  const double dx = x1 - x0, dy = y1 - y0;
  const double t = std::clamp(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
  const double ex = x - x0 - t * dx, ey = y - y0 - t * dy;
  return std::exp(-(ex * ex + ey * ey) / (width * width));
}

/// Positive on land; x and y are -1..1 over the square.
double coast(double x, double y, std::uint32_t seed) {
  return 0.76 - x + 0.10 * std::sin(2.3 * y + 0.6) + 0.22 * fractalNoise(1.6 * x + 5, 1.6 * y, 6, seed + 11);
}

/// Rise of the ground, 0..1.
double uplift(double x, double y, std::uint32_t seed) {
  // The ranges bend.
  const double bx = x + 0.16 * fractalNoise(1.3 * x, 1.3 * y + 9, 3, seed + 21),
               by = y + 0.16 * fractalNoise(1.3 * x + 7, 1.3 * y, 3, seed + 22);
  double rise = 0.17;
  rise += 0.95 * ridge(bx, by, -1.0, -0.35, -0.2, 1.0, 0.30);
  rise += 0.60 * ridge(bx, by, 0.42, 1.05, 0.46, 0.34, 0.20);
  rise += 0.42 * ridge(bx, by, -0.75, -0.85, 0.35, -0.72, 0.22);
  rise *= 0.75 + 0.45 * fractalNoise(3.2 * x, 3.2 * y, 3, seed + 23);
  // The basin in the middle opens to the coast; a low swell in it keeps its rivers off the very centre.
  const double basin =
      std::max(ridge(bx, by, -0.10, -0.04, 0.10, -0.02, 0.22), ridge(x, y, 0.0, -0.05, 0.85, -0.25, 0.14));
  rise *= 1 - 0.75 * basin;
  rise += 0.05 * std::exp(-(x * x + y * y) / (0.065 * 0.065));
  return std::max(0.012, rise);
}

/// One resolution of the process.
class Process {
 public:
  Process(std::uint32_t side, double cellM) : side_(side), cellM_(cellM) {
    const std::size_t size = std::size_t{side} * side;
    heights.assign(size, 0);
    land_.resize(size);
    drained.resize(size);
    receiver_.resize(size);
    next_.resize(size);
    order_.reserve(size);
  }

  /// Decides where land is, how it rises and how soft it is.
  void lay(std::uint32_t seed) {
    rise_.resize(heights.size());
    softness_.resize(heights.size());
    forEachParallel(
        side_,
        [&](std::uint32_t r) {
          for (std::uint32_t c = 0; c < side_; ++c) {
            const double x = 2.0 * c / (side_ - 1) - 1, y = 2.0 * r / (side_ - 1) - 1;
            const std::size_t i = std::size_t{r} * side_ + c;
            land_[i] = c + 1 < side_ && coast(x, y, seed) > 0;
            rise_[i] = static_cast<float>(uplift(x, y, seed));
            softness_[i] = static_cast<float>(std::exp2(1.6 * fractalNoise(7 * x, 7 * y, 5, seed + 31)));
          }
        },
        nullptr);
  }

  /// Starts as a rough ramp away from the coast.
  void start(std::uint32_t seed) {
    for (std::uint32_t r = 0; r < side_; ++r)
      for (std::uint32_t c = 0; c < side_; ++c) {
        const double x = 2.0 * c / (side_ - 1) - 1, y = 2.0 * r / (side_ - 1) - 1;
        const std::size_t i = std::size_t{r} * side_ + c;
        if (land_[i])
          heights[i] = static_cast<float>(20 + 60 * std::max(0.0, coast(x, y, seed)) +
                                          30 * fractalNoise(8 * x, 8 * y, 6, seed + 41) + 12);
        heights[i] = std::max(heights[i], 0.0f);
      }
  }

  /// Starts from a coarser one, roughened a little so that small valleys find their own way.
  void refine(const Process& coarse, std::uint32_t seed) {
    for (std::uint32_t r = 0; r < side_; ++r)
      for (std::uint32_t c = 0; c < side_; ++c) {
        const std::size_t i = std::size_t{r} * side_ + c;
        if (!land_[i]) continue;
        const double scale = (coarse.side_ - 1.0) / (side_ - 1.0);
        const double rough =
            0.06 * cellM_ *
            latticeNoise(static_cast<std::int32_t>(c), static_cast<std::int32_t>(r), seed + 51);
        heights[i] = static_cast<float>(std::max(0.05, coarse.between(r * scale, c * scale) + rough));
      }
  }

  void step(double years) {
    flood();
    drain();
    accumulate();
    erode(years);
    creep(0.5f);
  }

  /// Takes ground as it is, and cuts through what dams a hollow.
  void carve() {
    for (std::size_t i = 0; i < heights.size(); ++i) {
      land_[i] = heights[i] > 0.02f;
      if (!land_[i]) heights[i] = 0;
    }
    flood();
    for (std::size_t k = order_.size(); k-- > 0;) {
      const std::uint32_t cell = order_[k], down = receiver_[cell];
      if (down != cell && land_[down])
        heights[down] = std::min(heights[down], std::max(0.03f, heights[cell] - 0.002f));
    }
    flood();
    drain();
    accumulate();
  }

  std::vector<float> heights, drained;

 private:
  double between(double y, double x) const {
    const auto r = std::min(static_cast<std::uint32_t>(y), side_ - 2),
               c = std::min(static_cast<std::uint32_t>(x), side_ - 2);
    const double v = y - r, u = x - c;
    const float* h = &heights[std::size_t{r} * side_ + c];
    return (h[0] * (1 - u) + h[1] * u) * (1 - v) + (h[side_] * (1 - u) + h[side_ + 1] * u) * v;
  }

  /// Water rises from the sea: each cell drains to the neighbour it was reached from, through any hollow.
  /// Cells come in the order of that level, by buckets of height.
  void flood() {
    constexpr std::uint32_t kBuckets = 1 << 15;
    const float highest = *std::max_element(heights.begin(), heights.end());
    const float scale = static_cast<float>(kBuckets - 1) / std::max(highest, 1.0f);
    std::vector<std::uint32_t> head(kBuckets, kNone), tail(kBuckets, kNone);
    order_.clear();
    std::fill(receiver_.begin(), receiver_.end(), kNone);
    const auto push = [&](std::uint32_t cell, std::uint32_t bucket) {
      next_[cell] = kNone;
      (head[bucket] == kNone ? head[bucket] : next_[tail[bucket]]) = cell;
      tail[bucket] = cell;
    };
    const auto width = static_cast<std::int32_t>(side_);
    for (std::uint32_t i = 0; i < heights.size(); ++i)
      if (!land_[i]) {
        receiver_[i] = i;
        push(i, 0);
      }
    for (std::uint32_t bucket = 0; bucket < kBuckets; ++bucket)
      while (head[bucket] != kNone) {
        const std::uint32_t cell = head[bucket];
        head[bucket] = next_[cell];
        order_.push_back(cell);
        const auto r = static_cast<std::int32_t>(cell / side_), c = static_cast<std::int32_t>(cell % side_);
        for (std::int32_t dr = -1; dr <= 1; ++dr)
          for (std::int32_t dc = -1; dc <= 1; ++dc) {
            const std::int32_t row = r + dr, column = c + dc;
            if (row < 0 || column < 0 || row >= width || column >= width) continue;
            const auto other = static_cast<std::uint32_t>(row * width + column);
            if (receiver_[other] != kNone) continue;
            receiver_[other] = cell;
            push(other, std::max(bucket, static_cast<std::uint32_t>(heights[other] * scale)));
          }
      }
  }

  /// A cell drains down its steepest side, and through the flood's way out of a hollow where there is none.
  /// Diagonals are weighed at random (Fairfield and Leymarie's rho8): else valleys run in eight directions.
  void drain() {
    // The place in the order stands in next_: a receiver must come earlier.
    for (std::uint32_t k = 0; k < order_.size(); ++k) next_[order_[k]] = k;
    const auto width = static_cast<std::int32_t>(side_);
    ++turn_;
    forEachParallel(
        side_,
        [&](std::uint32_t at) {
          const auto r = static_cast<std::int32_t>(at);
          for (std::int32_t c = 0; c < width; ++c) {
            const std::uint32_t cell = at * side_ + static_cast<std::uint32_t>(c);
            if (!land_[cell]) continue;
            const double diagonal = 1 / (1.41421356 + 0.35 * latticeNoise(c, r, turn_));
            double best = 0;
            for (std::int32_t row = std::max(0, r - 1); row <= std::min(width - 1, r + 1); ++row)
              for (std::int32_t column = std::max(0, c - 1); column <= std::min(width - 1, c + 1); ++column) {
                const auto other = static_cast<std::uint32_t>(row * width + column);
                const double fall =
                    (heights[cell] - heights[other]) * (row != r && column != c ? diagonal : 1);
                if (fall > best && next_[other] < next_[cell]) best = fall, receiver_[cell] = other;
              }
          }
        },
        nullptr);
  }

  void accumulate() {
    std::fill(drained.begin(), drained.end(), static_cast<float>(cellM_ * cellM_));
    for (std::size_t k = order_.size(); k-- > 0;) {
      const std::uint32_t cell = order_[k];
      if (receiver_[cell] != cell) drained[receiver_[cell]] += drained[cell];
    }
  }

  /// Stream power, dh/dt = U - K sqrt(A) dh/dx, implicitly from the sea upwards (Braun and Willett), with
  /// slopes kept below what rock stands at.
  void erode(double years) {
    constexpr double kRise = 1,
                     kCut = 1.0 / 70;  // metres a year are a matter of scale: heights are fitted later
    for (const std::uint32_t cell : order_) {
      const std::uint32_t down = receiver_[cell];
      if (down == cell) continue;
      const bool across = down % side_ != cell % side_ && down / side_ != cell / side_;
      const double distance = across ? cellM_ * 1.41421356 : cellM_;
      const double cut =
          kCut * softness_[cell] * years * std::sqrt(static_cast<double>(drained[cell])) / distance;
      const double base = heights[down];
      double height = (heights[cell] + kRise * rise_[cell] * years + cut * base) / (1 + cut);
      height = std::min(height, base + kSteepest * distance);
      heights[cell] = static_cast<float>(std::max(height, base + 2e-4 * distance));
    }
  }

  /// Soil creeps: ridges are round, and slopes between streams are one piece.
  void creep(float share) {
    scratch_ = heights;
    forEachParallel(
        side_,
        [&](std::uint32_t r) {
          for (std::size_t c = 0; c < side_; ++c) {
            const std::size_t i = r * side_ + c;
            if (!land_[i] || drained[i] > kStreamM2) continue;
            const std::size_t w = c == 0 ? i : i - 1, e = c + 1 == side_ ? i : i + 1,
                              s = r == 0 ? i : i - side_, n = r + 1 == side_ ? i : i + side_;
            heights[i] += share * ((scratch_[w] + scratch_[e] + scratch_[s] + scratch_[n]) / 4 - scratch_[i]);
          }
        },
        nullptr);
  }

  static constexpr double kSteepest = 0.9;
  static constexpr float kStreamM2 = 1.5e6f;

  std::uint32_t side_;
  double cellM_;
  std::vector<std::uint8_t> land_;
  std::vector<float> rise_, softness_, scratch_;
  std::vector<std::uint32_t> receiver_, next_, order_;
  std::uint32_t turn_ = 0;
};

/// Draws the same ground on cloth that was pulled a little here and there: no valley is straight, and what
/// runs down still does.
Landscape bent(const std::vector<float>& heights, const LandscapeShape& land) {
  Landscape result{land.side, land.cellM, heights, {}};
  const std::uint32_t seed = land.seed;
  const double last = land.side - 1.0, km = land.cellM / 1000;
  forEachParallel(
      land.side,
      [&](std::uint32_t r) {
        for (std::uint32_t c = 0; c < land.side; ++c) {
          const double x = c * km, y = r * km;
          const double dx = 0.75 * smoothNoise(x / 4.1, y / 4.1, seed + 61) +
                            0.16 * smoothNoise(x / 0.9, y / 0.9, seed + 62);
          const double dy = 0.75 * smoothNoise(x / 4.1, y / 4.1, seed + 63) +
                            0.16 * smoothNoise(x / 0.9, y / 0.9, seed + 64);
          const double column = std::clamp(c + dx / km, 0.0, last), row = std::clamp(r + dy / km, 0.0, last);
          const auto i = std::min(static_cast<std::uint32_t>(column), land.side - 2),
                     j = std::min(static_cast<std::uint32_t>(row), land.side - 2);
          const auto u = static_cast<float>(column - i), v = static_cast<float>(row - j);
          const std::size_t at = std::size_t{j} * land.side + i, to = std::size_t{r} * land.side + c;
          const float* h = &heights[at];
          result.heights[to] =
              (h[0] * (1 - u) + h[1] * u) * (1 - v) + (h[land.side] * (1 - u) + h[land.side + 1] * u) * v;
        }
      },
      nullptr);
  return result;
}

}  // namespace

double fractalNoise(double x, double y, int octaves, std::uint32_t seed) {
  double sum = 0, height = 0.5;
  for (int k = 0; k < octaves; ++k, height /= 2) {
    sum += height * smoothNoise(x, y, seed + static_cast<std::uint32_t>(k) * 101);
    const double turned = 1.6 * x + 1.2 * y + 3.7;
    y = 1.6 * y - 1.2 * x + 1.3;
    x = turned;
  }
  return sum;
}

void carveHollows(Landscape& land) {
  Process process(land.side, land.cellM);
  process.heights = std::move(land.heights);
  process.carve();
  land.heights = std::move(process.heights);
  land.drainedM2 = std::move(process.drained);
}

Landscape erodedLandscape(const LandscapeShape& shape, const std::function<bool(double)>& carryOn) {
  // Large forms come from a coarse grid, where a step is cheap; each finer one adds its own valleys.
  std::vector<std::uint32_t> sides{shape.side};
  while (sides.back() > 450) sides.push_back((sides.back() + 1) / 2);
  constexpr std::array<int, 3> kSteps{2, 6, 40};
  const auto stepsOf = [&](std::size_t k) {
    return k + 1 == sides.size() ? kSteps[2] : kSteps[std::min<std::size_t>(k, 1)];
  };
  double total = 0, done = 0;
  const auto costOf = [&](std::size_t k) { return static_cast<double>(sides[k]) * sides[k]; };
  for (std::size_t k = 0; k < sides.size(); ++k) total += costOf(k) * stepsOf(k);

  std::unique_ptr<Process> process;
  for (std::size_t k = sides.size(); k-- > 0;) {
    auto finer = std::make_unique<Process>(sides[k], shape.cellM * (shape.side - 1) / (sides[k] - 1));
    finer->lay(shape.seed);
    if (process)
      finer->refine(*process, shape.seed + static_cast<std::uint32_t>(k));
    else
      finer->start(shape.seed);
    process = std::move(finer);
    const bool coarsest = k + 1 == sides.size();
    for (int step = 0; step < stepsOf(k); ++step) {
      process->step(coarsest ? (step < 25 ? 80 : 30) : 8);
      done += costOf(k);
      if (carryOn && !carryOn(done / total)) return {};
    }
  }
  Landscape land = bent(process->heights, shape);
  process.reset();
  carveHollows(land);
  return land;
}

}  // namespace trimtab::terrain
