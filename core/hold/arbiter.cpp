#include "trimtab/hold/arbiter.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace trimtab {
namespace {

/// Render scale falls by a twentieth a step, particles by an eighth: below what a still image shows.
constexpr double kScaleStep = 0.05, kParticleStep = 0.125;
constexpr std::size_t kMostScales = 17, kMostParticles = 9;
/// Lowering aims this share of the limit below it, so that a load that keeps rising does not lower the level
/// of detail again and again. For an eye at rest no load rises.
constexpr double kMovingReserve = 0.06, kRestingReserve = 0.03;
/// Head-room must win more than this part of the loss: less is not worth a change.
constexpr double kWorthwhile = 0.1;
/// A setting with another allowed error exchanges levels, so its loss counts for so many times as much, and
/// head-room must win more than a fifth by it.
constexpr double kExchange = 1.25;
/// While the eye moves, the allowed error moves by half octaves.
constexpr std::size_t kMovingPlaces = kPlacesPerOctave / 2;
constexpr std::size_t kNoPlace = kErrorPlaces + 1;
/// While the eye moves, the allowed error returns only after head-room for so long, which is longer than a
/// glance lasts, because the next view may need what this one does not. It is less if the image takes less
/// than this part of the limit, because then too much was given up; but still so long that a head that looks
/// around does not exchange levels at each turn. Patience multiplies both.
constexpr double kMovingCalmMs = 1000, kAmple = 0.75, kAmpleCalmMs = 400;
/// A restoration that is taken back within so long was too early.
constexpr double kLastsMs = 4000, kMostPatience = 32;
/// The allowed error waits no longer for meshes.
constexpr double kMostBuildingMs = 2000;
/// Settings whose times differ by less are alike.
constexpr double kAlike = 1.03;
/// No image counts for more than this part of the calm that restoring waits for, however far the clock jumps;
/// but each may count for so long, so that a short calm does not stop the waits above.
constexpr double kMostOfCalm = 1.0 / 3, kAlwaysCountsMs = 40;

/// The settings of one lever, from what is asked for downwards, with the loss of each.
template <std::size_t Most>
struct Settings {
  std::array<double, Most> value{}, loss{};
  std::size_t size = 0;
  void add(double v, double l) { value[size] = v, loss[size++] = l; }
};

/// Allowed errors by place: 0 is what is asked for, place i the i-th of the scale. Places before `first` are
/// not above what is asked for.
struct Errors {
  std::array<double, kErrorPlaces + 1> value{}, loss{}, triangles{};
  std::size_t first = 1, size = 1;
};

struct Choice {
  Errors error;
  Settings<kMostScales> scale;
  Settings<kMostParticles> particles;
  Settings<2> blur;
};

/// The part of the loss from 1 to 16 px that lies between two errors, of which the first may not be smaller.
/// FLIP over Kansai rises by 0.0025, 0.011 and 0.033 from 1 px to 2, 4 and 8 px (resources/docs/results.md).
double errorLoss(double errorPx, double freePx) {
  const auto power = [](double px) { return px * std::sqrt(px); };
  return std::max(power(errorPx) - power(freePx), 0.0) / (power(16) - power(1));
}

/// The part of the loss from full scale to half. Any smaller scale blurs the finest detail at once: 0.7
/// already loses two thirds of what 0.5 does.
double scaleLoss(double scale, double fullScale) {
  return std::sqrt(std::max(fullScale / scale - 1, 0.0));
}

Choice choiceOf(const HoldGiven& given, const HoldParameters& p) {
  Choice c;
  const HeldLevers& asked = given.asked;
  Errors& e = c.error;
  e.value[0] = asked.errorPx;
  e.triangles[0] = given.triangles[0];
  for (std::size_t i = 1; i <= kErrorPlaces; ++i) {
    const double errorPx = errorAtPlace(static_cast<std::uint8_t>(i), asked.errorPx);
    if (errorPx > p.errorMaximum.value() * (1 + 1e-9)) break;
    e.size = i + 1;
    if (errorPx <= asked.errorPx) {
      e.first = i + 1;
      continue;
    }
    e.value[i] = errorPx;
    e.triangles[i] = trianglesAt(given.triangles, asked.errorPx, errorPx);
    e.loss[i] = p.lossError.value() * errorLoss(errorPx, std::max(asked.errorPx, given.unseenPx));
  }
  const double leastScale = std::min(p.renderScaleMinimum.value(), asked.renderScale);
  for (double scale = asked.renderScale; scale > leastScale - 1e-9 && c.scale.size < kMostScales;
       scale = asked.renderScale - kScaleStep * static_cast<double>(c.scale.size))
    c.scale.add(scale, p.lossRenderScale.value() * scaleLoss(scale, asked.renderScale));
  if (given.particles > 0) {
    const double least = std::min(p.particlesMinimum.value(), asked.particleShare);
    for (double share = asked.particleShare; share > least - 1e-9 && c.particles.size < kMostParticles;
         share = asked.particleShare - kParticleStep * static_cast<double>(c.particles.size))
      c.particles.add(std::max(share, 0.0), p.lossParticles.value() * (asked.particleShare - share));
  } else {
    c.particles.add(asked.particleShare, 0);
  }
  c.blur.add(asked.blurShare, 0);
  if (given.blurs && asked.blurShare > p.blurMinimum.value())
    c.blur.add(p.blurMinimum.value(), p.lossBlur.value() * (asked.blurShare - p.blurMinimum.value()));
  return c;
}

HeldLevers leversAt(const Choice& c, const HoldSteps& s) {
  return {c.error.value[s.error], c.scale.value[s.renderScale], c.particles.value[s.particles],
          c.blur.value[s.blur]};
}

double lossAt(const Choice& c, const HoldSteps& s) {
  return c.error.loss[s.error] + c.scale.loss[s.renderScale] + c.particles.loss[s.particles] +
         c.blur.loss[s.blur];
}

/// The steps of the image before, as far as the levers still have them.
HoldSteps within(const Choice& c, const HoldSteps& s) {
  const auto least = [](std::uint8_t step, std::size_t size) {
    return static_cast<std::uint8_t>(std::min<std::size_t>(step, size - 1));
  };
  const std::uint8_t error = least(s.error, c.error.size);
  return {error < c.error.first ? std::uint8_t{0} : error, least(s.renderScale, c.scale.size),
          least(s.particles, c.particles.size), least(s.blur, c.blur.size)};
}

class Search {
 public:
  /// `before` are the steps of the image before, and `kept` its place of the allowed error; kNoPlace if it
  /// cannot stay there. `caution` is hold.caution.
  Search(const HoldGiven& given, const Choice& choice, const HoldSteps& before, std::size_t kept,
         double caution)
      : given_(given), choice_(choice), kept_(kept), caution_(caution), loadBefore_(loadAt(before)) {
    msBefore_ = predict(given.cost, loadBefore_).total();
    bandBefore_ = coefficientBandMs(given.cost, loadBefore_);
  }

  double timeAt(const HoldSteps& s) const { return predictAt(s).total(); }
  StageTimes predictAt(const HoldSteps& s) const { return predict(given_.cost, loadAt(s)); }
  /// Returns the time with `caution` of the bands by which it is less certain than at the steps before, but
  /// no more than it can be. If that is above the limit, any time above the limit may be returned.
  double timeForSure(const HoldSteps& s, double limitMs) const {
    const FrameLoad load = loadAt(s);
    const double ms = predict(given_.cost, load).total();
    const double most = msBefore_ * mostTimesAsLong(loadBefore_, load);
    if (std::min(ms, most) > limitMs) return std::min(ms, most);  // whatever the band
    const double band = coefficientBandMs(given_.cost, load);
    const double late = caution_ * std::sqrt(std::max(band * band - bandBefore_ * bandBefore_, 0.0));
    return std::min(ms + late, most);
  }

  /// Returns what is asked for if it takes at most `limitMs`; else, of all settings that do, the one that
  /// loses least, with kExchange; of those that lose the same, the quickest. If there is none, the quickest
  /// of all.
  HoldSteps best(double limitMs) const {
    return best(limitMs, kInfinity, [this](const HoldSteps& s) { return timeAt(s); });
  }
  /// Returns the same of the settings that fit for sure and are worth a change from a loss of `lost`.
  HoldSteps bestForSure(double limitMs, double lost) const {
    return best(limitMs, lost, [=, this](const HoldSteps& s) { return timeForSure(s, limitMs); });
  }

 private:
  FrameLoad loadAt(const HoldSteps& s) const {
    return loadOf(given_, leversAt(choice_, s), choice_.error.triangles[s.error]);
  }
  template <class Time>
  HoldSteps best(double limitMs, double lost, const Time& time) const {
    if (time({}) <= limitMs) return {};
    HoldSteps best{}, quickest{};
    double bestLoss = 0, bestMs = 0, quickestMs = 0;
    bool found = false, any = false;
    forEach([&](const HoldSteps& s) {
      const bool exchanges = s.error != kept_;
      const double loss = (exchanges ? kExchange : 1) * lossAt(choice_, s);
      if (loss >= (exchanges ? 1 : 1 - kWorthwhile) * lost || (found && loss > bestLoss)) return;
      const double ms = time(s);
      if (!any || ms < quickestMs) quickest = s, quickestMs = ms, any = true;
      if (!(ms <= limitMs) || (found && loss == bestLoss && ms >= bestMs)) return;
      best = s, bestLoss = loss, bestMs = ms, found = true;
    });
    return found ? best : quickest;
  }
  bool isOffered(std::size_t place) const {
    if (place == 0 || place == kept_) return true;
    return place >= choice_.error.first && (!given_.moves || (place - 1) % kMovingPlaces == 0);
  }
  template <class Visit>
  void forEach(const Visit& visit) const {
    HoldSteps s;
    for (std::size_t error = 0; error < choice_.error.size; ++error) {
      if (!isOffered(error)) continue;
      s.error = static_cast<std::uint8_t>(error);
      for (s.renderScale = 0; s.renderScale < choice_.scale.size; ++s.renderScale)
        for (s.particles = 0; s.particles < choice_.particles.size; ++s.particles)
          for (s.blur = 0; s.blur < choice_.blur.size; ++s.blur) visit(s);
    }
  }

  const HoldGiven& given_;
  const Choice& choice_;
  std::size_t kept_;
  double caution_;
  FrameLoad loadBefore_;
  double msBefore_ = 0, bandBefore_ = 0;
};

/// Returns the steps one image nearer to `to`, which are fewer: blur at once, the error too if it may return,
/// the others by one.
HoldSteps raised(const HoldSteps& from, const HoldSteps& to, bool errorReturns) {
  const auto one = [](std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(a > b ? a - 1 : b);
  };
  return {errorReturns ? to.error : from.error, one(from.renderScale, to.renderScale),
          one(from.particles, to.particles), to.blur};
}

/// The time since the last image, milliseconds; 0 if the clock stands, goes back or is not a number.
double passed(const HoldGiven& given, HoldMemory& memory) {
  const double ms = memory.begun ? (given.timeS - memory.timeS) * 1e3 : 0;
  if (std::isfinite(given.timeS)) memory.timeS = given.timeS;
  return ms > 0 ? ms : 0;
}

/// Follows how long the last restoration has lasted. One that lasts ends the patience at once, and an eye
/// that moves halves it in that time.
void bePatient(bool moves, double ms, HoldMemory& memory) {
  memory.restoredMs += ms;
  if (memory.restoredMs >= kLastsMs && std::isfinite(memory.restoredMs)) {
    memory.patience = 1;
    memory.restoredMs = kInfinity;
  }
  if (moves) memory.patience = std::max(1.0, memory.patience * std::exp2(-ms / kLastsMs));
}

/// Notes to which place the allowed error is to go, so that its meshes are named. Returns false while a finer
/// one has to wait for them.
bool meshesReady(const HoldGiven& given, std::uint8_t from, std::uint8_t to, double ms, HoldMemory& memory) {
  const bool named = memory.wantedError < from;
  memory.wantedError = to;
  const bool waits = to < from && (!named || given.meshesLeft > 0);
  memory.waitedMs = waits ? memory.waitedMs + ms : 0;
  return !waits || memory.waitedMs >= kMostBuildingMs;
}

/// Averages the model's uncertainty into the memory, because a single late image must not lower anything.
void noteBand(double bandMs, HoldMemory& memory) {
  constexpr double kShare = 0.02;
  const double band = std::isfinite(bandMs) ? std::max(bandMs, 0.0) : 0;
  memory.bandMs = memory.begun ? memory.bandMs + kShare * (band - memory.bandMs) : band;
}

/// Returns what a prediction may reach: the budget without its margin, and less if the model is so uncertain
/// that an image which is late by hold.caution bands would take more than 1.1 of the budget. Of a normal
/// distribution one image in a hundred is later than 1.41 of its 90 % bands (2.326 / 1.645).
double limitOf(double budgetMs, double bandMs, const HoldParameters& p) {
  constexpr double kOver = 1.1, kLeast = 0.75;
  const double most = budgetMs * (1 - p.margin.value());
  const double sure = std::max(kOver * budgetMs - p.caution.value() * bandMs, kLeast * budgetMs);
  return std::min(most, sure);
}

bool isNumber(const HoldGiven& g) {
  const CostCoefficients& c = g.cost;
  double sum = g.asked.errorPx + g.asked.renderScale + g.asked.particleShare + g.asked.blurShare +
               g.unseenPx + g.particles + g.imageMpx + g.groundMpx + c.fixed + c.perTriangle +
               c.perTriangleSide + c.perGroundMpx + c.perParticles + c.perWeatherMpx + c.perBlurMpx + c.other;
  for (const double triangles : g.triangles) sum += triangles;
  for (const double variance : c.variance.ground) sum += variance;
  for (const double variance : c.variance.weather) sum += variance;
  sum += c.variance.blur;
  return std::isfinite(sum);
}

}  // namespace

double rememberedMs() {
  return kMovingCalmMs + kLastsMs;
}

double errorAtPlace(std::uint8_t place, double askedPx) {
  return place == 0 ? askedPx : kFirstErrorPx * std::exp2((place - 1) / double{kPlacesPerOctave});
}

double trianglesAt(const TriangleLadder& ladder, double askedPx, double errorPx) {
  const double places =
      askedPx > 0 && errorPx > askedPx ? double{kPlacesPerOctave} * std::log2(errorPx / askedPx) : 0;
  const double toNext = placesToNext(askedPx), last = static_cast<double>(kErrorSteps - 1);
  const double at = std::min(places < toNext ? places / toNext : 1 + places - toNext, last);
  const auto low = static_cast<std::size_t>(std::min(std::floor(at + 1e-6), last));
  const std::size_t high = std::min<std::size_t>(low + 1, kErrorSteps - 1);
  const double part = std::max(at - static_cast<double>(low), 0.0);
  return ladder[low] + (ladder[high] - ladder[low]) * part;
}

FrameLoad loadOf(const HoldGiven& given, const HeldLevers& levers, double triangles) {
  const double part = levers.renderScale * levers.renderScale;
  const double asked = given.asked.particleShare;
  return {triangles, given.groundMpx * part, given.imageMpx * part,
          asked > 0 ? given.particles * levers.particleShare / asked : 0,
          given.blurs && levers.blurShare > 0};
}

HoldDecision arbitrate(const HoldGiven& given, const HoldParameters& p, HoldMemory& memory) {
  HoldDecision d;
  d.asked = d.held = given.asked;
  const double passedMs = passed(given, memory);
  const double ms = std::min(passedMs, std::max(kMostOfCalm * p.calm.value(), kAlwaysCountsMs));
  const bool budget = given.budgetMs > 0 && std::isfinite(given.budgetMs);
  if (!p.enabled || !budget || !given.cost.known || !isNumber(given)) {
    d.reason = !p.enabled ? HoldReason::off : !budget ? HoldReason::no_budget : HoldReason::cost_unknown;
    const double timeS = memory.timeS;
    memory = {};
    memory.timeS = timeS;
    return d;
  }
  noteBand(given.cost.bandMs, memory);
  d.limitMs = limitOf(given.budgetMs, memory.bandMs, p);
  d.bandMs = given.cost.bandMs;

  const Choice choice = choiceOf(given, p);
  const double aimMs = d.limitMs * (1 - (given.moves ? kMovingReserve : kRestingReserve));
  const HoldSteps before = within(choice, memory.steps);
  const std::size_t kept = memory.begun && before.error == memory.steps.error ? before.error : kNoPlace;
  const Search search(given, choice, before, kept, p.caution.value());
  HoldSteps now = before;
  bePatient(given.moves, ms, memory);
  if (!memory.begun || search.timeAt(before) > d.limitMs) {
    now = search.best(memory.begun ? aimMs : d.limitMs);
    // Where nothing fits, a setting that is next to no quicker is not worth a change.
    if (memory.begun && search.timeAt(now) > d.limitMs &&
        search.timeAt(before) <= kAlike * search.timeAt(now))
      now = before;
    d.reason = HoldReason::lowered;
    memory.calmMs = 0;
    // In a view that sees little ground a finer cut can be the quicker one, because fewer of its nodes reach
    // into it. It waits for its meshes like one that is restored.
    if (!meshesReady(given, before.error, now.error, passedMs, memory) && memory.begun) now = before;
    if (memory.restoredMs < kLastsMs) memory.patience = std::min(2 * memory.patience, kMostPatience);
    memory.restoredMs = kInfinity;
  } else {
    const HoldSteps wanted = search.bestForSure(aimMs, lossAt(choice, before));
    const bool room = wanted != before && search.timeForSure(wanted, aimMs) <= aimMs;
    memory.calmMs = room ? memory.calmMs + ms : 0;
    const bool ready = meshesReady(given, before.error, room ? wanted.error : before.error, passedMs, memory);
    d.reason = HoldReason::held;
    const bool ample = search.timeAt(before) < kAmple * d.limitMs;
    if (room && memory.calmMs >= p.calm.value() * (ample ? 1 : memory.patience)) {
      const double movingCalmMs = (ample ? kAmpleCalmMs : kMovingCalmMs) * memory.patience;
      const bool returns = ready && (!given.moves || memory.calmMs >= movingCalmMs);
      const HoldSteps nearer = raised(before, wanted, returns);
      if (nearer != before && search.timeForSure(nearer, d.limitMs) <= d.limitMs)
        now = nearer, d.reason = HoldReason::restored, memory.restoredMs = 0;
    }
  }
  memory.begun = true;
  memory.steps = now;
  d.held = leversAt(choice, now);
  d.heldMs = search.predictAt(now);
  d.askedMs = search.predictAt({});
  if (now == HoldSteps{} && d.reason != HoldReason::restored) d.reason = HoldReason::fits;
  if (d.heldMs.total() > d.limitMs) d.reason = HoldReason::out_of_reach;
  return d;
}

double smearPx(double degreesPerS, double exposureMs, double pixelsPerRadian) {
  return degreesPerS * std::numbers::pi / 180 * exposureMs * 1e-3 * pixelsPerRadian;
}

double errorInMotion(double errorPx, double degreesPerS, double exposureMs, double pixelsPerRadian) {
  const double smear = smearPx(degreesPerS, exposureMs, pixelsPerRadian);
  return smear > errorPx && std::isfinite(smear) ? std::sqrt(errorPx * smear) : errorPx;
}

HoldGains gainsOf(const HoldGiven& given, const HoldDecision& d, const HoldParameters& p) {
  constexpr std::size_t kHeld = 4;
  if (d.held == d.asked || !isNumber(given)) return {};
  // Bit i says that lever i is lowered.
  std::array<double, 1u << kHeld> ms{};
  for (unsigned lowered = 0; lowered < ms.size(); ++lowered) {
    const auto of = [lowered](unsigned bit, double asked, double held) {
      return (lowered >> bit & 1u) != 0 ? held : asked;
    };
    const HeldLevers levers{
        of(0, d.asked.errorPx, d.held.errorPx), of(1, d.asked.renderScale, d.held.renderScale),
        of(2, d.asked.particleShare, d.held.particleShare), of(3, d.asked.blurShare, d.held.blurShare)};
    const double triangles = trianglesAt(given.triangles, d.asked.errorPx, levers.errorPx);
    ms[lowered] = predict(given.cost, loadOf(given, levers, triangles)).total();
  }
  // Among four levers, n are lowered before a given one in n! (3 - n)! of 4! orders.
  constexpr std::array<double, kHeld> kWeight{6.0 / 24, 2.0 / 24, 2.0 / 24, 6.0 / 24};
  std::array<double, kHeld> won{};
  for (unsigned lever = 0; lever < kHeld; ++lever)
    for (unsigned before = 0; before < ms.size(); ++before) {
      if ((before >> lever & 1u) != 0) continue;
      won[lever] +=
          kWeight[static_cast<std::size_t>(std::popcount(before))] * (ms[before] - ms[before | 1u << lever]);
    }
  const double freePx = std::max(d.asked.errorPx, given.unseenPx);
  return {{won[0], p.lossError.value() * errorLoss(d.held.errorPx, freePx)},
          {won[1], p.lossRenderScale.value() * scaleLoss(d.held.renderScale, d.asked.renderScale)},
          {won[2], p.lossParticles.value() * (d.asked.particleShare - d.held.particleShare)},
          {won[3], p.lossBlur.value() * (d.asked.blurShare - d.held.blurShare)}};
}

std::string explain(const HoldDecision& d) {
  char text[240] = "";
  const auto write = [&](const char* format, auto... values) {
    std::snprintf(text, sizeof text, format, values...);
    return std::string(text);
  };
  const std::string levers = write("%.3g px, render scale %.2f, particles %.2f, blur %.2f", d.held.errorPx,
                                   d.held.renderScale, d.held.particleShare, d.held.blurShare);
  const std::string times = write("%.1f ms predicted for %.1f ms, %.1f ms as asked", d.heldMs.total(),
                                  d.limitMs, d.askedMs.total());
  switch (d.reason) {
    case HoldReason::off:
      return "the budget is not held";
    case HoldReason::no_budget:
      return "no budget: it is not a number above 0";
    case HoldReason::cost_unknown:
      return "the cost of an image is not known yet";
    case HoldReason::fits:
      return "what is asked for fits: " + times;
    case HoldReason::lowered:
      return "lowered to " + levers + ": " + times;
    case HoldReason::held:
      return "held at " + levers + ": " + times;
    case HoldReason::restored:
      return "restored to " + levers + ": " + times;
    case HoldReason::out_of_reach:
      return "out of reach at " + levers + ": " + times;
  }
  return "";
}

}  // namespace trimtab
