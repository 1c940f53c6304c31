#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "published.h"
#include "stage.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::experiment {
namespace {

constexpr double kStepS = 1.0 / 200;
constexpr int kStill = 60, kSweep = 200, kRest = 200, kFrames = kStill + kSweep + kRest;
constexpr double kSweepDeg = 180;
constexpr double kEyeFt = 2000;
/// Frames between two questions whether to go on.
constexpr int kAsked = 40;
/// Pictures are compared at every so many frames of the sweep.
constexpr int kCompared = 25;

struct Mode {
  MotionControl control;
  const char* name;
};
constexpr std::array<Mode, 3> kModes{{{MotionControl::off, "before"},
                                      {MotionControl::lod_scale_and_blur, "lod_scale_and_blur"},
                                      {MotionControl::with_restoration, "with_restoration"}}};

struct Run {
  std::array<std::vector<double>, kFrames> ms;  ///< by frame, one a repeat
  std::array<double, kFrames> vertices{}, lodScale{}, blur{};
  std::vector<std::vector<std::uint8_t>> pictures;
  int dwellEnds =
      kStill + kSweep;  ///< first frame after the level changed; the sweep's end where it never does
};

double headingAt(int frame) {
  return kSweepDeg * std::clamp(double(frame - kStill) / kSweep, 0.0, 1.0);
}

/// One pass through all frames; the first pass also counts and keeps pictures. False: it was cancelled, which
/// `go` is asked now and then.
bool pass(Stage& stage, const Setup& setup, const ValidatedParameters& parameters,
          const GeodeticPosition& eye, bool first, Run& run, const auto& go) {
  Session session(parameters);
  session.setGround(setup.terrain);
  AircraftState state;
  state.position = eye;
  for (int i = 0; i < kFrames; ++i) {
    if (i % kAsked == 0 && !go(double(i) / kFrames)) return false;
    state.time = i * kStepS;
    state.packet = static_cast<std::uint64_t>(i);
    state.head = Attitude{Degrees{headingAt(i)}, {}, {}};
    session.fly(state);
    const std::optional<FrameRequest> request = session.request(state.time, setup.widthPx, setup.heightPx);
    const FrameResult result = stage.draw(*request);
    session.finished(result, state.time);
    const auto at = static_cast<std::size_t>(i);
    run.ms[at].push_back(result.cost.total);
    if (!first) continue;
    run.vertices[at] = double(result.visible.vertices);
    run.lodScale[at] = session.decision().motion.lodScale;
    run.blur[at] = session.decision().motion.blur.strength;
    if (run.lodScale[at] > 1) run.dwellEnds = std::min(run.dwellEnds, i);
    if (i >= kStill && i < kStill + kSweep && (i - kStill) % kCompared == 0)
      run.pictures.push_back(stage.shown());
  }
  return true;
}

std::vector<double> medians(const Run& run) {
  std::vector<double> ms;
  for (const auto& repeats : run.ms) ms.push_back(quantileOf(repeats, 0.5));
  return ms;
}

template <class Values>
std::vector<double> part(const Values& values, int from, int to) {
  return {values.begin() + from, values.begin() + to};
}

/// Mean difference of a channel, of 255.
double meanDifference(const Run& a, const Run& b) {
  double sum = 0, count = 0;
  for (std::size_t p = 0; p < a.pictures.size() && p < b.pictures.size(); ++p)
    for (std::size_t i = 0; i < a.pictures[p].size() && i < b.pictures[p].size(); ++i) {
      if (i % 4 == 3) continue;
      sum += std::abs(int{a.pictures[p][i]} - int{b.pictures[p][i]});
      ++count;
    }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

Plot overTime(const char* file, const char* title, const char* label,
              const std::array<Run, kModes.size()>& runs, const auto& valuesOf) {
  Plot plot{file, title, "time (s), sweep from 0 to 1", label, {}, {}};
  for (std::size_t m = 0; m < kModes.size(); ++m) {
    Series series{kModes[m].name, {}, {}};
    for (int i = 0; i < kFrames; ++i) series.x.push_back((i - kStill) * kStepS);
    const auto values = valuesOf(runs[m]);
    series.y.assign(values.begin(), values.end());
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace

Result<Report> runHeadMotion(const Setup& setup) {
  std::vector<ValidatedParameters> parameters;
  for (const Mode& mode : kModes) {
    TuningParameters changed = setup.parameters;
    changed.motion.control = mode.control;
    const Result<ValidatedParameters> valid = validate(changed);
    if (!valid) return valid.findings();
    parameters.push_back(*valid);
  }
  const std::vector<Place> places = placesOf(setup, 1);
  if (places.empty()) return notOverTerrain(setup);
  GeodeticPosition eye = places[0].ground;
  eye.height = eye.height + Feet{kEyeFt}.as<Metres>();
  auto stage = Stage::open(setup);
  if (!stage) return stage.findings();

  std::array<Run, kModes.size()> runs;
  const int passes = std::max(setup.repeats, 1);
  // Modes take turns, so that a slow spell of the machine meets all of them.
  for (int r = 0; r < passes; ++r)
    for (std::size_t m = 0; m < kModes.size(); ++m) {
      char what[64];
      std::snprintf(what, sizeof what, "sweep %d of %d, %s", r + 1, passes, kModes[m].name);
      const auto go = [&](double part) {
        return !setup.progress || setup.progress((r + (double(m) + part) / kModes.size()) / passes, what);
      };
      if (r == 0 && m == 0) {
        Run warm;
        if (!pass(**stage, setup, parameters[m], eye, false, warm, [&](double) { return go(0); }))
          return cancelled();
      }
      if (!pass(**stage, setup, parameters[m], eye, r == 0, runs[m], go)) return cancelled();
    }

  // What is compared is the same stretch of the sweep for all: after the dwell of the mode that has one.
  const int from = std::min(runs[1].dwellEnds, kStill + kSweep - 1), to = kStill + kSweep;
  Report report{"head-motion", "C: results", (*stage)->machine(), publishedHeadMotion(), {}, {}, {}};
  report.measured.columns = {"quantity", "before", "lod_scale_and_blur", "with_restoration"};
  const auto row = [&](const char* quantity, const auto& valueOf) {
    std::vector<Cell> cells{std::string(quantity)};
    for (const Run& run : runs) cells.emplace_back(valueOf(run));
    report.measured.rows.push_back(std::move(cells));
  };
  row("fps_max", [](const Run& r) { return 1000 / quantileOf(medians(r), 0); });
  row("fps_min", [&](const Run& r) { return 1000 / quantileOf(part(medians(r), from, to), 1); });
  row("fps_median", [&](const Run& r) { return 1000 / quantileOf(part(medians(r), from, to), 0.5); });
  row("frame_ms_median", [&](const Run& r) { return quantileOf(part(medians(r), from, to), 0.5); });
  row("frame_ms_p95", [&](const Run& r) { return quantileOf(part(medians(r), from, to), 0.95); });
  row("vertices_in_view", [&](const Run& r) { return std::round(meanOf(part(r.vertices, from, kFrames))); });
  row("vertices_in_sweep", [&](const Run& r) { return std::round(meanOf(part(r.vertices, from, to))); });
  row("lod_scale_max", [](const Run& r) { return *std::max_element(r.lodScale.begin(), r.lodScale.end()); });
  row("lod_scale_end", [](const Run& r) { return r.lodScale.back(); });
  row("mean_difference_of_255", [&](const Run& r) { return meanDifference(r, runs[0]); });

  char text[320];
  std::snprintf(
      text, sizeof text,
      "%s, preset %s, %d x %d, %.0f ft above the highest ground within 2 km: 180 degrees in 1 s in steps of "
      "1/200 s, then 1 s of rest; %d passes, median by frame. Minimum, median and p95 are of the sweep after "
      "the dwell, from %.3f s on; vertices_in_view is the mean to the end of the rest.",
      setup.terrainName.c_str(), setup.presetName.c_str(), setup.widthPx, setup.heightPx, kEyeFt, passes,
      (from - kStill) * kStepS);
  report.notes = {
      text,
      "The published rates are a graphics card's at a steady 100 to 450 a second; compare ratios to "
      "the column before.",
      "mean_difference_of_255 is what LOD scale and blur change in the picture, averaged over the sweep's "
      "pictures: their price."};
  report.plots = {
      overTime("head-motion-frame-ms", "Frame time through the sweep", "frame time (ms)", runs, medians),
      overTime("head-motion-vertices", "Vertices in view through the sweep", "vertices", runs,
               [](const Run& r) { return r.vertices; }),
      overTime("head-motion-lod-scale", "LOD scale through the sweep", "LOD scale (1 is full detail)", runs,
               [](const Run& r) { return r.lodScale; })};
  return report;
}

}  // namespace trimtab::experiment
