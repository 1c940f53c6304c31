#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "head_motion_run.h"
#include "stage.h"

namespace trimtab::experiment {
namespace {

/// A stretch of the motion: so long at these rates.
struct Stretch {
  double seconds, headingDegPerS, pitchDegPerS;
};
/// Document C, Figure 9 (b), varies the speed of the motion within 180 degrees of heading and 90 of pitch but
/// prints no numbers. This is ours: fast and slow turns, sudden stops, and a nod from the zenith to the
/// nadir.
constexpr std::array<Stretch, 14> kStretches{{{0.3, 0, 0},
                                              {0.5, 180, 0},
                                              {0.3, 30, 0},
                                              {0.25, 300, 0},
                                              {0.4, 0, 0},
                                              {0.5, -120, 0},
                                              {0.5, -45, 0},
                                              {0.5, -203, 0},
                                              {0.3, 0, 0},
                                              {0.5, 0, 180},
                                              {0.3, 0, 0},
                                              {1.0, 0, -180},
                                              {0.75, 0, 120},
                                              {0.9, 0, 0}}};

HeadProfile varying() {
  HeadProfile profile;
  for (const Stretch& s : kStretches) profile.seconds += s.seconds;
  profile.at = [](double seconds) {
    double heading = 0, pitch = 0;
    for (const Stretch& s : kStretches) {
      const double in = std::clamp(seconds, 0.0, s.seconds);
      heading += s.headingDegPerS * in;
      pitch += s.pitchDegPerS * in;
      seconds -= s.seconds;
    }
    return Attitude{Degrees{heading}, Degrees{std::clamp(pitch, -90.0, 90.0)}, {}};
  };
  return profile;
}

double changes(const std::vector<double>& values) {
  int count = 0;
  for (std::size_t i = 1; i < values.size(); ++i) count += values[i] != values[i - 1];
  return count;
}

void addVaryingRows(Table& table, const std::string& form, const MotionRuns& runs) {
  const auto row = [&](const char* quantity, const auto& valueOf) {
    addRow(table, form, quantity, runs, valueOf);
  };
  row("fps_max", [](const MotionRun& r) { return 1000 / quantileOf(r.medians(), 0); });
  row("fps_min", [](const MotionRun& r) { return 1000 / quantileOf(r.medians(), 1); });
  row("fps_p5", [](const MotionRun& r) { return 1000 / quantileOf(r.medians(), 0.95); });
  row("fps_median", [](const MotionRun& r) { return 1000 / quantileOf(r.medians(), 0.5); });
  row("rapid_drops", [](const MotionRun& r) { return quantileOf(rapidDrops(r), 0.5); });
  row("vertices_mean", [](const MotionRun& r) { return std::round(meanOf(r.vertices)); });
  row("vertices_max",
      [](const MotionRun& r) { return *std::max_element(r.vertices.begin(), r.vertices.end()); });
  row("level_changes", [](const MotionRun& r) { return changes(r.lodScale); });
  row("lod_scale_end", [](const MotionRun& r) { return r.lodScale.back(); });
}

Plot motionOf(const HeadProfile& profile) {
  Plot plot{
      "head-motion-varying-field-of-view",     "Motion of the field of view", "time (s)", "angle (deg)", {},
      {{"heading", {}, {}}, {"pitch", {}, {}}}};
  for (int i = 0; i < profile.images(); ++i) {
    const double seconds = double(i) / kImagesPerS;
    const Attitude head = profile.at(seconds);
    plot.series[0].x.push_back(seconds);
    plot.series[1].x.push_back(seconds);
    plot.series[0].y.push_back(head.heading.value());
    plot.series[1].y.push_back(head.pitch.value());
  }
  return plot;
}

}  // namespace

Result<Report> runHeadMotionVarying(const Setup& setup) {
  auto stage = Stage::open(setup);
  if (!stage) return stage.findings();
  const HeadProfile profile = varying();
  Report report{"head-motion-varying", "C: Figures 9 and 10", (*stage)->machine(), {}, {}, {}, {}};
  // Figure 10's counts are printed in the text; Figure 9 has no numbers.
  report.published = {{"quantity", "before", "lod_scale_and_blur", "with_restoration"},
                      {{"vertices_mean", 44000.0, 31000.0, 36000.0}}};
  report.measured.columns = motionColumns();
  report.plots.push_back(motionOf(profile));
  for (const TerrainForm form : formsOf(setup)) {
    const std::string name = nameOf(form);
    Setup over = setup;
    over.parameters.terrain.form = form;
    const auto runs = flyHead(
        **stage, over, profile, [](int) { return false; }, "varying motion over " + name);
    if (!runs) return runs.findings();
    addVaryingRows(report.measured, name, *runs);
    report.notes.push_back(rapidDropsText(name, *runs));
    report.plots.push_back(motionPlot("head-motion-varying-fps-" + name, "Frame rate, " + name,
                                      "frame rate (1/s)", *runs, [](const MotionRun& r) {
                                        std::vector<double> fps = r.medians();
                                        for (double& ms : fps) ms = 1000 / ms;
                                        return fps;
                                      }));
    report.plots.push_back(motionPlot("head-motion-varying-vertices-" + name, "Vertices in view, " + name,
                                      "vertices", *runs, [](const MotionRun& r) { return r.vertices; }));
  }
  char text[240];
  std::snprintf(
      text, sizeof text,
      "%s, preset %s, %d x %d, 2000 ft above the highest ground within 2 km; %d images and %g host states "
      "a second; %d passes, median by image.",
      setup.terrainName.c_str(), setup.presetName.c_str(), setup.widthPx, setup.heightPx, kImagesPerS,
      setup.hostRateHz, std::max(setup.repeats, 1));
  report.notes.insert(report.notes.begin(), text);
  return report;
}

}  // namespace trimtab::experiment
