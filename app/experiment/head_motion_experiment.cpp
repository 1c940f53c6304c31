#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "head_motion_run.h"
#include "published.h"
#include "stage.h"

namespace trimtab::experiment {
namespace {

constexpr int kStill = 60, kSweep = 200, kRest = 200, kImages = kStill + kSweep + kRest;
constexpr double kSweepDeg = 180;
/// Pictures are compared at every so many images of the sweep.
constexpr int kCompared = 25;

HeadProfile sweep() {
  return {double(kImages) / kImagesPerS, [](double seconds) {
            const double part = (seconds * kImagesPerS - kStill) / kSweep;
            return Attitude{Degrees{kSweepDeg * std::clamp(part, 0.0, 1.0)}, {}, {}};
          }};
}

std::vector<double> part(const std::vector<double>& values, int from, int to) {
  return {values.begin() + from, values.begin() + to};
}

/// Returns the mean difference of a channel, of 255.
double meanDifference(const MotionRun& a, const MotionRun& b) {
  double sum = 0, count = 0;
  for (std::size_t p = 0; p < a.pictures.size() && p < b.pictures.size(); ++p)
    for (std::size_t i = 0; i < a.pictures[p].size() && i < b.pictures[p].size(); ++i) {
      if (i % 4 == 3) continue;
      sum += std::abs(int{a.pictures[p][i]} - int{b.pictures[p][i]});
      ++count;
    }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

/// Returns the first image with a coarser level; the sweep's end if there is none.
int dwellEnds(const MotionRun& run) {
  const auto coarse = std::find_if(run.lodScale.begin(), run.lodScale.end(), [](double s) { return s > 1; });
  return std::min(int(coarse - run.lodScale.begin()), kStill + kSweep);
}

/// Adds the rows of one form of the terrain. Returns from which image on the modes are compared: the same
/// stretch of the sweep for all, after the dwell of the mode that has one.
int addRows(Table& table, const std::string& form, const MotionRuns& runs) {
  const int from = std::min(dwellEnds(runs[1]), kStill + kSweep - 1), to = kStill + kSweep;
  const auto row = [&](const char* quantity, const auto& valueOf) {
    addRow(table, form, quantity, runs, valueOf);
  };
  const auto slowest = [&](const MotionRun& r) { return 1000 / quantileOf(part(r.medians(), from, to), 1); };
  row("fps_max", [](const MotionRun& r) { return 1000 / quantileOf(r.medians(), 0); });
  row("fps_min", slowest);
  row("fps_min_gain", [&](const MotionRun& r) { return gainOf(runs[0], r, from, to, 1).median; });
  row("fps_min_gain_low", [&](const MotionRun& r) { return gainOf(runs[0], r, from, to, 1).low; });
  row("fps_min_gain_high", [&](const MotionRun& r) { return gainOf(runs[0], r, from, to, 1).high; });
  row("fps_median", [&](const MotionRun& r) { return 1000 / quantileOf(part(r.medians(), from, to), 0.5); });
  row("frame_ms_median", [&](const MotionRun& r) { return quantileOf(part(r.medians(), from, to), 0.5); });
  row("frame_ms_p95", [&](const MotionRun& r) { return quantileOf(part(r.medians(), from, to), 0.95); });
  row("vertices_in_view",
      [&](const MotionRun& r) { return std::round(meanOf(part(r.vertices, from, kImages))); });
  row("vertices_in_sweep",
      [&](const MotionRun& r) { return std::round(meanOf(part(r.vertices, from, to))); });
  row("lod_scale_max",
      [](const MotionRun& r) { return *std::max_element(r.lodScale.begin(), r.lodScale.end()); });
  row("lod_scale_end", [](const MotionRun& r) { return r.lodScale.back(); });
  row("images_blurred", [&](const MotionRun& r) {
    const std::vector<double> blur = part(r.blur, from, to);
    return double(std::count_if(blur.begin(), blur.end(), [](double strength) { return strength > 0; }));
  });
  row("mean_difference_of_255", [&](const MotionRun& r) { return meanDifference(r, runs[0]); });
  return from;
}

}  // namespace

Result<Report> runHeadMotion(const Setup& setup) {
  auto stage = Stage::open(setup);
  if (!stage) return stage.findings();
  Report report{"head-motion", "C: results", (*stage)->machine(), publishedHeadMotion(), {}, {}, {}};
  report.measured.columns = motionColumns();
  const auto kept = [](int i) { return i >= kStill && i < kStill + kSweep && (i - kStill) % kCompared == 0; };
  for (const TerrainForm form : formsOf(setup)) {
    const std::string name = nameOf(form);
    Setup over = setup;
    over.parameters.terrain.form = form;
    const auto runs = flyHead(**stage, over, sweep(), kept, "sweep over " + name);
    if (!runs) return runs.findings();
    const int from = addRows(report.measured, name, *runs);
    char text[480];
    std::snprintf(
        text, sizeof text,
        "%s, %s, preset %s, %d x %d, 2000 ft above the highest ground within 2 km: after %.1f s the head "
        "turns 180 degrees in 1 s, then rests for 1 s; %d images and %g host states a second; %d passes, "
        "median by image. Minimum, median and p95 are of the sweep after the dwell, from %.3f s on; "
        "fps_min_gain is the median of the passes' gains with its 95 %% interval; vertices_in_view is the "
        "mean to the end of the rest.",
        setup.terrainName.c_str(), name.c_str(), setup.presetName.c_str(), setup.widthPx, setup.heightPx,
        double(kStill) / kImagesPerS, kImagesPerS, setup.hostRateHz, std::max(setup.repeats, 1),
        double(from) / kImagesPerS);
    report.notes.push_back(text);
    report.notes.push_back(gainText(name, (*runs)[0], (*runs)[2], from, kStill + kSweep));
    const std::string file = report.plots.empty() ? "head-motion" : "head-motion-" + name;
    report.plots.push_back(motionPlot(file + "-frame-ms", "Frame time through the sweep, " + name,
                                      "frame time (ms)", *runs, &MotionRun::medians));
    report.plots.push_back(motionPlot(file + "-vertices", "Vertices in view through the sweep, " + name,
                                      "vertices", *runs, [](const MotionRun& r) { return r.vertices; }));
    report.plots.push_back(motionPlot(file + "-lod-scale", "LOD scale through the sweep, " + name,
                                      "LOD scale (1 is full detail)", *runs,
                                      [](const MotionRun& r) { return r.lodScale; }));
  }
  report.notes.push_back(
      "The published rates are a graphics card's at a steady 100 to 450 a second; compare ratios to the "
      "column "
      "before.");
  report.notes.push_back(
      "hold is document C with restoration under the arbiter, which may leave out its blur; images_blurred "
      "counts those of the sweep that have any.");
  report.notes.push_back(
      "mean_difference_of_255 is what LOD scale and blur change in the picture, averaged over the sweep's "
      "pictures: their price.");
  return report;
}

}  // namespace trimtab::experiment
