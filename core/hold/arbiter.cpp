#include "trimtab/hold/arbiter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

namespace trimtab {
namespace {

/// Render scale falls by a twentieth a step, particles by an eighth: below what a still image shows.
constexpr double kScaleStep = 0.05, kParticleStep = 0.125;
constexpr std::size_t kMostScales = 17, kMostParticles = 9;
/// The hysteresis. Lowering aims this share of the limit below it, and restoring must fit there too.
constexpr double kReserve = 0.08;
/// A setting with another allowed error exchanges levels, which is seen, so it loses so many times as much.
constexpr double kExchange = 1.5;
/// Where nothing fits, a setting whose time is at most so many times the quickest one's does as well.
constexpr double kAlike = 1.02;
/// Predictions are not trusted once the median of the last ones is off by this part of the budget, or of the
/// quickest image if that is longer, until it is off by half as much.
constexpr double kMostOff = 0.3;
/// The allowed error waits no longer for meshes.
constexpr double kMostBuildingMs = 2000;
/// No image counts for more than this part of the calm that restoring waits for, however far the clock jumps.
constexpr double kMostOfCalm = 1.0 / 3;
constexpr std::size_t kNoPlace = kErrorPlaces + 1;

/// Holds the settings of one lever, from what is asked for downwards, with the loss of each.
template <std::size_t Most>
struct Settings {
  std::array<double, Most> value{}, loss{};
  std::size_t size = 0;
  void add(double v, double l) { value[size] = v, loss[size++] = l; }
  /// Adds what is asked for and steps below it down to `least`.
  template <class Loss>
  void addSteps(double asked, double least, double step, const Loss& lossOf) {
    for (double v = asked; v > std::min(least, asked) - 1e-9 && size < Most;
         v = asked - step * static_cast<double>(size))
      add(std::max(v, 0.0), lossOf(v));
  }
};

/// Allowed errors by place: 0 is what is asked for, place i the i-th of the scale. Places before `first` are
/// not above what is asked for.
struct Errors {
  std::array<double, kErrorPlaces + 1> value{}, loss{}, triangles{};
  std::size_t first = 1, size = 1;
  /// Visits what is asked for, and the places above it.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (std::size_t e = 0; e < size; e = std::max(e + 1, first)) visit(static_cast<std::uint8_t>(e));
  }
};

/// Where an allowed error lies on a ladder: so far from a step to the next.
struct OnLadder {
  std::size_t low = 0, high = 0;
  double part = 0;
  double operator()(const TriangleLadder& ladder) const {
    return ladder[low] + (ladder[high] - ladder[low]) * part;
  }
};
OnLadder onLadder(double askedPx, double errorPx) {
  const double places =
      askedPx > 0 && errorPx > askedPx ? double{kPlacesPerOctave} * std::log2(errorPx / askedPx) : 0;
  const double toNext = placesToNext(askedPx), last = static_cast<double>(kErrorSteps - 1);
  const double at = std::min(places < toNext ? places / toNext : 1 + places - toNext, last);
  OnLadder on;
  on.low = static_cast<std::size_t>(std::min(std::floor(at + 1e-6), last));
  on.high = std::min<std::size_t>(on.low + 1, kErrorSteps - 1);
  on.part = std::max(at - static_cast<double>(on.low), 0.0);
  return on;
}

struct Choice {
  Errors error;
  Settings<kMostScales> scale;
  Settings<kMostParticles> particles;
  Settings<2> blur;
};

/// The places of the scale from what is asked for to the most that is allowed. Image after image asks for the
/// same, and their logarithms would take longer than all the rest of a decision.
struct ErrorScale {
  double askedPx = kNan, mostPx = kNan;
  Errors errors;  ///< with the loss of each, and no triangles
  std::array<OnLadder, kErrorPlaces + 1> on{};
};
const ErrorScale& scaleBetween(double askedPx, double mostPx) {
  thread_local ErrorScale scale;
  if (scale.askedPx == askedPx && scale.mostPx == mostPx) return scale;
  scale = {.askedPx = askedPx, .mostPx = mostPx, .errors = {}, .on = {}};
  Errors& e = scale.errors;
  for (std::size_t i = 1; i <= kErrorPlaces; ++i) {
    const double errorPx = errorAtPlace(static_cast<std::uint8_t>(i), askedPx);
    if (errorPx > mostPx * (1 + 1e-9)) break;
    e.size = i + 1;
    if (errorPx <= askedPx) {
      e.first = i + 1;
      continue;
    }
    e.value[i] = errorPx;
    e.loss[i] = errorLoss(errorPx, askedPx);
    scale.on[i] = onLadder(askedPx, errorPx);
  }
  return scale;
}

Choice choiceOf(const HoldGiven& given, const HoldParameters& p) {
  Choice c;
  const HeldLevers& asked = given.asked;
  const ErrorScale& above = scaleBetween(asked.errorPx, p.errorMaximum.value());
  Errors& e = c.error;
  e.first = above.errors.first;
  e.size = above.errors.size;
  e.value[0] = asked.errorPx;
  e.triangles[0] = given.triangles[0];
  for (std::size_t i = e.first; i < e.size; ++i) {
    e.value[i] = above.errors.value[i];
    e.triangles[i] = above.on[i](given.triangles);
    e.loss[i] = p.lossError.value() * above.errors.loss[i];
  }
  c.scale.addSteps(asked.renderScale, p.renderScaleMinimum.value(), kScaleStep, [&](double scale) {
    return p.lossRenderScale.value() * scaleLoss(scale, asked.renderScale);
  });
  const double leastShare = given.particles > 0 ? p.particlesMinimum.value() : asked.particleShare;
  c.particles.addSteps(asked.particleShare, leastShare, kParticleStep,
                       [&](double share) { return p.lossParticles.value() * (asked.particleShare - share); });
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

/// Returns the steps of the image before, as far as the levers still have them.
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
  /// `kept` is the place of the allowed error in the image before; kNoPlace if it cannot stay there.
  Search(const HoldGiven& given, const Choice& choice, std::size_t kept)
      : given_(given), choice_(choice), kept_(kept) {
    const auto last = [](std::size_t size) { return static_cast<std::uint8_t>(size - 1); };
    choice_.error.forEach([&](std::uint8_t error) {
      quickestMs_[error] =
          timeAt({error, last(choice_.scale.size), last(choice_.particles.size), last(choice_.blur.size)});
      leastMs_ = std::min(leastMs_, quickestMs_[error]);
    });
  }

  double timeAt(const HoldSteps& s) const { return predictAt(s).total(); }
  StageTimes predictAt(const HoldSteps& s) const {
    return predict(given_.cost, loadOf(given_, leversAt(choice_, s), choice_.error.triangles[s.error]));
  }
  /// Returns the time of the quickest setting.
  double leastMs() const { return leastMs_; }
  /// Returns what is asked for if it takes at most `limitMs`; else, of all settings that do and lose less
  /// than `lost`, the one that loses least, and of those that lose the same the quickest. A setting that
  /// exchanges levels counts as losing more. It is unset if there is none.
  std::optional<HoldSteps> best(double limitMs, double lost) const {
    if (timeAt({}) <= limitMs) return HoldSteps{};
    std::optional<HoldSteps> best;
    double bestLoss = lost, bestMs = 0;
    choice_.error.forEach([&](std::uint8_t error) {
      // No cost is below 0, so that no setting of a place is quicker than its last.
      if (quickestMs_[error] > limitMs) return;
      HoldSteps s{error};
      // Losses rise from step to step of each lever: where one loses too much, those after it do as well.
      const auto losesTooMuch = [&] {
        const double loss = lossOf(s);
        return best ? loss > bestLoss : !(loss < lost);
      };
      for (s.renderScale = 0; s.renderScale < choice_.scale.size; ++s.renderScale) {
        s.particles = s.blur = 0;
        if (losesTooMuch()) break;
        for (; s.particles < choice_.particles.size; ++s.particles)
          for (s.blur = 0; s.blur < choice_.blur.size; ++s.blur) {
            if (losesTooMuch()) break;
            const double loss = lossOf(s), ms = timeAt(s);
            if (!(ms <= limitMs) || (best && loss == bestLoss && ms >= bestMs)) continue;
            best = s, bestLoss = loss, bestMs = ms;
          }
      }
    });
    return best;
  }

 private:
  double lossOf(const HoldSteps& s) const { return (s.error != kept_ ? kExchange : 1) * lossAt(choice_, s); }

  const HoldGiven& given_;
  const Choice& choice_;
  std::size_t kept_;
  std::array<double, kErrorPlaces + 1> quickestMs_{};
  double leastMs_ = kInfinity;
};

/// Returns the time since the last image, milliseconds; 0 if the clock stands, goes back or is not a number.
double passed(const HoldGiven& given, HoldMemory& memory) {
  const double ms = memory.begun ? (given.timeS - memory.timeS) * 1e3 : 0;
  if (std::isfinite(given.timeS)) memory.timeS = given.timeS;
  return ms > 0 ? ms : 0;
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

/// Returns what a prediction may reach: the budget without its margin, and less if the model is so uncertain
/// that an image which is late by hold.caution bands would take more than 1.1 of the budget. Of a normal
/// distribution one image in a hundred is later than 1.41 of its 90 % bands (2.326 / 1.645).
double limitOf(double budgetMs, double halfBandMs, const HoldParameters& p) {
  constexpr double kOver = 1.1, kLeast = 0.75;
  const double most = budgetMs * (1 - p.margin.value());
  const double sure = kOver * budgetMs - p.caution.value() * halfBandMs;
  return std::min(most, std::isfinite(sure) ? std::max(sure, kLeast * budgetMs) : most);
}

bool isNumber(const HoldGiven& g) {
  double sum = g.asked.errorPx + g.asked.renderScale + g.asked.particleShare + g.asked.blurShare +
               g.particles + g.imageMpx + g.groundMpx;
  for (const double triangles : g.triangles) sum += triangles;
  return std::isfinite(sum + predict(g.cost, {1, 1, 1, 1, true}).total());
}

}  // namespace

double rememberedMs(const HoldParameters& p) {
  return p.calm.value() + kMostBuildingMs;
}

double errorLoss(double errorPx, double freePx) {
  const auto power = [](double px) { return px * std::sqrt(px); };
  return std::max(power(errorPx) - power(freePx), 0.0) / (power(16) - power(1));
}

double scaleLoss(double scale, double fullScale) {
  return std::sqrt(std::max(fullScale / scale - 1, 0.0));
}

double errorAtPlace(std::uint8_t place, double askedPx) {
  return place == 0 ? askedPx : kFirstErrorPx * std::exp2((place - 1) / double{kPlacesPerOctave});
}

double trianglesAt(const TriangleLadder& ladder, double askedPx, double errorPx) {
  return onLadder(askedPx, errorPx)(ladder);
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
  const double ms = passed(given, memory);
  const bool budget = given.budgetMs > 0 && std::isfinite(given.budgetMs);
  if (!p.enabled || !budget || !given.cost.known || !isNumber(given)) {
    d.reason = !p.enabled ? HoldReason::off : !budget ? HoldReason::no_budget : HoldReason::cost_unknown;
    memory = {.steps = {}, .timeS = memory.timeS};
    return d;
  }
  d.halfBandMs = given.cost.halfBandMs;
  d.limitMs = limitOf(given.budgetMs, d.halfBandMs, p);

  const Choice choice = choiceOf(given, p);
  const HoldSteps before = within(choice, memory.steps);
  const Search search(given, choice, memory.begun ? before.error : kNoPlace);
  d.askedMs = d.heldMs = search.predictAt({});
  const double askedMs = d.askedMs.total(), leastMs = search.leastMs();
  const double mostOffMs = kMostOff * std::max(given.budgetMs, leastMs);
  memory.distrusts = given.cost.offMs > mostOffMs / (memory.distrusts ? 2 : 1);
  if (memory.distrusts) {
    memory = {.steps = {}, .timeS = memory.timeS, .distrusts = true};
    d.reason = HoldReason::not_trusted;
    return d;
  }

  const bool reaches = leastMs <= d.limitMs;
  // Where nothing fits, lowering serves those images that it makes shorter by more than the reserve.
  const double nearlyMs = askedMs * (1 - kReserve) <= leastMs ? askedMs : kAlike * leastMs;
  const double limitMs = reaches ? d.limitMs : nearlyMs / (1 - kReserve);
  const double aimMs = std::max(limitMs * (1 - kReserve), std::min(nearlyMs, limitMs));
  const bool lowers = !memory.begun || search.timeAt(before) > limitMs;
  // The first image has no setting to keep, so it needs no reserve.
  const double mostMs = memory.begun || !reaches ? aimMs : limitMs;
  HoldSteps now = search.best(mostMs, lowers ? kInfinity : lossAt(choice, before)).value_or(before);
  memory.calmMs = lowers || now == before ? 0 : memory.calmMs + std::min(ms, kMostOfCalm * p.calm.value());
  // A finer cut waits for its meshes, also where it is the quicker one because fewer of its nodes reach into
  // a view that sees little ground.
  if (!meshesReady(given, before.error, now.error, ms, memory) && memory.begun) now.error = before.error;
  const bool waits = !lowers && memory.calmMs < p.calm.value();
  if (waits || search.timeAt(now) > std::max(limitMs, search.timeAt(before))) now = before;
  d.reason = lowers ? HoldReason::lowered : now == before ? HoldReason::held : HoldReason::restored;
  memory.begun = true;
  memory.steps = now;
  d.held = leversAt(choice, now);
  d.heldMs = search.predictAt(now);
  if (now == HoldSteps{} && d.reason != HoldReason::restored) d.reason = HoldReason::fits;
  if (d.heldMs.total() > d.limitMs) d.reason = HoldReason::out_of_reach;
  return d;
}

HoldGains gainsOf(const HoldGiven& given, const HoldDecision& d, const HoldParameters& p) {
  if (d.held == d.asked || !isNumber(given)) return {};
  const auto msWith = [&](const HeldLevers& levers) {
    const double triangles = trianglesAt(given.triangles, d.asked.errorPx, levers.errorPx);
    return predict(given.cost, loadOf(given, levers, triangles)).total();
  };
  const auto alone = [&](double HeldLevers::*lever) {
    HeldLevers levers = d.asked;
    levers.*lever = d.held.*lever;
    return msWith(d.asked) - msWith(levers);
  };
  HoldGains gains{
      {alone(&HeldLevers::errorPx), p.lossError.value() * errorLoss(d.held.errorPx, d.asked.errorPx)},
      {alone(&HeldLevers::renderScale),
       p.lossRenderScale.value() * scaleLoss(d.held.renderScale, d.asked.renderScale)},
      {alone(&HeldLevers::particleShare),
       p.lossParticles.value() * (d.asked.particleShare - d.held.particleShare)},
      {alone(&HeldLevers::blurShare), p.lossBlur.value() * (d.asked.blurShare - d.held.blurShare)}};
  const double sum = gains.error.ms + gains.renderScale.ms + gains.particles.ms + gains.blur.ms;
  const double part = sum > 0 ? (msWith(d.asked) - msWith(d.held)) / sum : 0;
  for (LeverGain* gain : {&gains.error, &gains.renderScale, &gains.particles, &gains.blur}) gain->ms *= part;
  return gains;
}

std::string explain(const HoldDecision& d) {
  constexpr std::array<const char*, kHoldReasons> kWords{
      "the budget is not held",
      "no budget: it is not a number above 0",
      "the cost of an image is not known yet",
      "what is asked for fits",
      "lowered to ",
      "held at ",
      "restored to ",
      "out of reach at ",
      "left as asked for, because the last predictions were too far off"};
  const auto reason = static_cast<std::size_t>(d.reason);
  if (reason >= kWords.size()) return "";
  if (d.reason < HoldReason::fits) return kWords[reason];
  char levers[120] = "", times[120] = "";
  if (d.reason != HoldReason::fits && d.reason != HoldReason::not_trusted)
    std::snprintf(levers, sizeof levers, "%.3g px, render scale %.2f, particles %.2f, blur %.2f",
                  d.held.errorPx, d.held.renderScale, d.held.particleShare, d.held.blurShare);
  std::snprintf(times, sizeof times, ": %.1f ms predicted for %.1f ms, %.1f ms as asked", d.heldMs.total(),
                d.limitMs, d.askedMs.total());
  return std::string(kWords[reason]) + levers + times;
}

}  // namespace trimtab
