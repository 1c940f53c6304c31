#include "skips.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/experiment/stage.h"

namespace trimtab::harness {
namespace {

using Counter = std::uint64_t FrameCounters::*;

template <Counter counter>
bool unchanged(const FrameResult& before, const FrameResult& after) {
  return after.counters.*counter == before.counters.*counter;
}

FrameRequest itself(const FrameRequest& request) {
  return request;
}

template <bool Skips::*skip>
FrameRequest without(const FrameRequest& request) {
  FrameRequest changed = request;
  changed.skips.*skip = false;
  return changed;
}

FrameRequest inCase(const FrameRequest& request, CullingCase method) {
  FrameRequest changed = request;
  changed.cullingCase = method;
  return changed;
}

double millisecondsOf(const DrawFrame& draw, const FrameRequest& request) {
  const auto start = std::chrono::steady_clock::now();
  draw(request);
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Returns at most `most` of the values, evenly spread.
std::vector<std::size_t> spread(const std::vector<std::size_t>& values, std::size_t most) {
  if (values.size() <= most) return values;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(values[i * values.size() / most]);
  return chosen;
}

}  // namespace

const std::vector<Skip>& skips() {
  static const std::vector<Skip> kSkips{
      {"tiles outside the frustum",
       [](const FrameRequest& r, const FrameResult&, const FrameResult& after) {
         return r.cullingCase != CullingCase::none && after.visible.outsideFrustum > 0;
       },
       [](const FrameRequest& r) { return inCase(r, CullingCase::none); },
       [](const FrameRequest& r) { return inCase(r, CullingCase::view_frustum); }},
      {"tiles that others hide",
       [](const FrameRequest&, const FrameResult&, const FrameResult& after) {
         return after.visible.occluded > 0;
       },
       [](const FrameRequest& r) { return inCase(r, CullingCase::view_frustum); }, itself},
      {"tiles beyond visibility",
       [](const FrameRequest&, const FrameResult&, const FrameResult& after) {
         return after.visible.beyondVisibility > 0;
       },
       without<&Skips::beyondVisibility>, itself},
      {"occlusion test in scheme frustum",
       [](const FrameRequest& r, const FrameResult&, const FrameResult& after) {
         return r.cullingCase == CullingCase::proposed && !r.levers.drawn.occlusion &&
                !after.visible.tiles.empty();
       },
       without<&Skips::schemeFrustum>, itself},
      {"levels chosen again for an eye that stands",
       [](const FrameRequest&, const FrameResult& before, const FrameResult& after) {
         return unchanged<&FrameCounters::cutsSelected>(before, after) && after.tilesInCut > 0;
       },
       without<&Skips::sameCut>, itself, true},
      {"tiles in view chosen again for a view that stands",
       [](const FrameRequest&, const FrameResult& before, const FrameResult& after) {
         return unchanged<&FrameCounters::visibleSelected>(before, after) && after.tilesInCut > 0;
       },
       without<&Skips::sameVisible>, itself, true},
      {"horizon built again for an eye that stands",
       [](const FrameRequest&, const FrameResult& before, const FrameResult& after) {
         return after.horizon && unchanged<&FrameCounters::horizonsBuilt>(before, after) &&
                unchanged<&FrameCounters::horizonsLeftOut>(before, after);
       },
       without<&Skips::sameHorizon>, itself, true},
      {"horizon where it hid next to nothing",
       [](const FrameRequest&, const FrameResult& before, const FrameResult& after) {
         return !unchanged<&FrameCounters::horizonsLeftOut>(before, after);
       },
       without<&Skips::littleHidden>, itself, true},
      {"tiles that the GPU holds already",
       [](const FrameRequest&, const FrameResult& before, const FrameResult& after) {
         return after.counters.tilesBuilt - before.counters.tilesBuilt < after.visible.tiles.size();
       },
       without<&Skips::tilesOnGpu>, itself},
      {"blur at rest",
       [](const FrameRequest&, const FrameResult& before, const FrameResult& after) {
         return unchanged<&FrameCounters::blurPasses>(before, after);
       },
       without<&Skips::blurAtRest>, itself},
      {"precipitation in clear air",
       [](const FrameRequest&, const FrameResult& before, const FrameResult& after) {
         return unchanged<&FrameCounters::precipitationPasses>(before, after);
       },
       without<&Skips::clearAir>, itself},
      {"symbols that have not changed",
       [](const FrameRequest&, const FrameResult& before, const FrameResult& after) {
         return unchanged<&FrameCounters::symbologyRedraws>(before, after) &&
                !unchanged<&FrameCounters::symbologyDraws>(before, after);
       },
       without<&Skips::sameSymbols>, itself, true},
  };
  return kSkips;
}

std::vector<SkipSaving> measureSkips(const DrawFrame& draw, std::span<const FrameRequest> frames,
                                     std::size_t repeats, const std::function<bool()>& goOn, bool pairs) {
  const auto stopped = [&goOn] { return goOn && !goOn(); };
  std::vector<SkipSaving> savings(skips().size());
  std::vector<std::vector<std::size_t>> left(skips().size());
  for (std::size_t s = 0; s < savings.size(); ++s) {
    savings[s].name = skips()[s].name;
    savings[s].ratio = pairedRatio({}, {});
  }
  if (frames.empty()) return savings;

  FrameResult before = draw(frames[0]);
  for (std::size_t i = 0; i < frames.size() && !stopped(); ++i) {
    FrameResult after = draw(frames[i]);
    if (pairs && i % 2 == 0) {
      before = std::move(after);
      continue;
    }
    for (std::size_t s = 0; s < savings.size(); ++s) {
      // The first frame has none before it: it was drawn twice.
      if (i == 0 && skips()[s].needsFrameBefore) continue;
      ++savings[s].frames;
      if (!skips()[s].left(frames[i], before, after)) continue;
      ++savings[s].skipped;
      left[s].push_back(i);
    }
    before = std::move(after);
  }

  for (std::size_t s = 0; s < savings.size(); ++s) {
    const Skip& skip = skips()[s];
    std::vector<double> with, without, saved;
    for (const std::size_t i : spread(left[s], kMostMeasured)) {
      const FrameRequest kept = skip.leftOut(frames[i]), done = skip.done(frames[i]);
      const auto timed = [&](const FrameRequest& request) {
        if (skip.needsFrameBefore) draw(frames[i - 1]);
        return millisecondsOf(draw, request);
      };
      draw(done);  // makes the tiles that only it needs
      for (std::size_t repeat = 0; repeat < repeats; ++repeat) {
        if (stopped()) return savings;
        // Each goes first in turn, so that what warms up or drifts favours neither.
        const bool doneFirst = repeat % 2 == 0;
        const double first = timed(doneFirst ? done : kept), second = timed(doneFirst ? kept : done);
        without.push_back(doneFirst ? first : second);
        with.push_back(doneFirst ? second : first);
        saved.push_back(without.back() - with.back());
      }
    }
    if (saved.empty()) continue;
    savings[s].savedMs = experiment::quantileOf(saved, 0.5);
    savings[s].ratio = pairedRatio(with, without);
  }
  return savings;
}

}  // namespace trimtab::harness
