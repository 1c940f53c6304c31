#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "bars.h"
#include "published.h"
#include "stage.h"
#include "trimtab/scene/weather_cut_error.h"
#include "trimtab/terrain/grid/progress.h"
#include "weather_view.h"

namespace trimtab::experiment {
namespace {

constexpr std::array<double, 3> kVertices{100000, 120000, 140000};
constexpr int kMostTrials = 6;
/// The budget of the arbiter, over the clear frame's time. The arbiter predicts what most images take, which
/// is above the median by some 2 % where some are late, and stays below its budget by some 3 %.
constexpr double kHeld = 1.05;

std::size_t countOneSettings(const Table& table) {
  std::size_t count = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) count += table.text(row, "one_setting") == "yes";
  return count;
}

Plot plotOf(const Table& table, const char* fall) {
  Plot plot{std::string("weather-") + fall,
            std::string("Frame rate in ") + fall + ", fixed ratio against adaptive",
            "vertices in view, density",
            "frame rate (1/s)",
            {},
            {barsOf("fixed ratio", table, "fps_fixed_ratio", "precipitation", fall),
             barsOf("adaptive", table, "fps_adaptive", "precipitation", fall)}};
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (table.text(row, "precipitation") != fall) continue;
    char text[48];
    std::snprintf(text, sizeof text, "%.0fk %s", table.number(row, "vertices") / 1000,
                  table.text(row, "density").c_str());
    plot.categories.push_back(text);
  }
  return plot;
}

}  // namespace

Result<Report> runWeather(const Setup& setup) {
  const auto opened = WeatherView::open(setup);
  if (!opened) return opened.findings();
  WeatherView& view = **opened;

  Report report{"weather", "D: frame rates with weather", view.machine(), publishedWeather(), {}, {}, {}};
  report.measured.columns = {"vertices",
                             "precipitation",
                             "density",
                             "fps_fixed_ratio",
                             "fps_adaptive",
                             "fps_gain",
                             "fps_gain_low",
                             "fps_gain_high",
                             "frame_ms_uncut",
                             "frame_ms",
                             "frame_ms_ratio",
                             "frame_ms_ratio_low",
                             "frame_ms_ratio_high",
                             "far_km_fixed",
                             "far_km",
                             "one_setting",
                             "visibility_km",
                             "density_that_fits",
                             "fixed_cut_changed_pixels",
                             "cut_changed_pixels",
                             "cut_largest_of_255",
                             "hold_ms_ratio",
                             "hold_particles",
                             "hold_error_px",
                             "hold_render_scale",
                             "outcome"};
  const double runs = double(kVertices.size() * kFalls.size() * kDensities.size());
  std::size_t notTrusted = 0;
  double done = 0;
  for (const double wanted : kVertices) {
    if (setup.progress && !setup.progress(done / runs, "finding the view")) return cancelled();
    double reached = 0;
    const double error = view.reach(wanted, reached);
    if (std::abs(reached / wanted - 1) > WeatherView::kWithin) {
      char note[160];
      std::snprintf(note, sizeof note,
                    "%.0f vertices could not be reached: the terrain gives %.0f at %.2g px.", wanted, reached,
                    error);
      report.notes.push_back(note);
    }
    for (const Fall& fall : kFalls)
      for (std::size_t d = 0; d < kDensities.size(); ++d, ++done) {
        char what[96];
        std::snprintf(what, sizeof what, "%.0f vertices, %s, %s", reached, fall.name, kDensities[d]);
        if (setup.progress && !setup.progress(done / runs, what)) return cancelled();
        const WeatherStep step = fall.steps[d];
        const WeatherDecision fixed = weatherOf(view.preset(), step, RatioMode::fixed);
        const double lostToFixed = double(view.cutError(fixed).changed);
        if (d == 0) {
          const auto ms = view.inTurns(std::array{WeatherDecision{}, fixed});
          const PairedRatio gain = pairedRatio(ms[0], ms[1]);
          const double clearMs = quantileOf(ms[0], 0.5);
          const WeatherView::Held held = view.held({}, kHeld);
          notTrusted += held.reason == HoldReason::not_trusted;
          report.measured.rows.push_back({reached,
                                          fall.name,
                                          "clear",
                                          1000 / quantileOf(ms[1], 0.5),
                                          1000 / clearMs,
                                          gain.median,
                                          gain.low,
                                          gain.high,
                                          clearMs,
                                          clearMs,
                                          1.0,
                                          1.0,
                                          1.0,
                                          fixed.farM / 1000,
                                          Cell(),
                                          "no",
                                          Cell(),
                                          Cell(),
                                          lostToFixed,
                                          0.0,
                                          0.0,
                                          held.ofClear.median,
                                          Cell(),
                                          held.levers.errorPx,
                                          held.levers.renderScale,
                                          "nothing falls; the fixed ratio alone cuts"});
          continue;
        }
        const auto found = calibrateOn(view, setup, view.preset(), step, kMostTrials,
                                       [&] { return !setup.progress || setup.progress(done / runs, what); });
        if (!found) return cancelled();
        // Where no cut wins back what falls, this is the strongest cut at the preset's density.
        const WeatherDecision weather = weatherOf(tunedBy(*found, view.preset()), step, RatioMode::adaptive);
        const WeatherDecision uncut = weatherOf(view.preset(), step, RatioMode::off);
        const auto ms = view.inTurns(std::array{WeatherDecision{}, fixed, uncut, weather});
        const PairedRatio gain = pairedRatio(ms[3], ms[1]), ofClear = pairedRatio(ms[0], ms[3]);
        const scene::CutError lost = view.cutError(weather);
        const WeatherView::Held held = view.held(uncut, kHeld);
        notTrusted += held.reason == HoldReason::not_trusted;
        report.measured.rows.push_back({reached,
                                        fall.name,
                                        kDensities[d],
                                        1000 / quantileOf(ms[1], 0.5),
                                        1000 / quantileOf(ms[3], 0.5),
                                        gain.median,
                                        gain.low,
                                        gain.high,
                                        quantileOf(ms[2], 0.5),
                                        quantileOf(ms[3], 0.5),
                                        ofClear.median,
                                        ofClear.low,
                                        ofClear.high,
                                        fixed.farM / 1000,
                                        weather.farM / 1000,
                                        isOneSetting(fixed, weather) ? "yes" : "no",
                                        weather.visibilityM / 1000,
                                        found->density,
                                        lostToFixed,
                                        double(lost.changed),
                                        double(lost.largest),
                                        held.ofClear.median,
                                        held.levers.particleShare,
                                        held.levers.errorPx,
                                        held.levers.renderScale,
                                        std::string(toText(found->outcome))});
      }
  }
  char text[420];
  std::snprintf(
      text, sizeof text,
      "%s, preset %s, %d x %d, %.0f ft above the highest ground within 2 km; the vertices are reached by the "
      "screen-space error. Fixed ratio: %.3g, in all weather and in clear air. Adaptive: calibrated for each "
      "row to the clear frame's time, within %.0f %%; clear air is not cut.",
      setup.terrainName.c_str(), setup.presetName.c_str(), setup.widthPx, setup.heightPx, WeatherView::kEyeFt,
      view.preset().weather.fixedRatio.value(), view.preset().weather.tolerance.value() * 100);
  report.notes.insert(report.notes.begin(), text);
  const std::size_t same = countOneSettings(report.measured);
  if (same > 0) {
    std::snprintf(
        text, sizeof text,
        "%zu of %zu rows in weather compare one setting with itself (one_setting): the adaptive far "
        "plane lies where the fixed one does. Their two rates differ by noise alone.",
        same, report.measured.rows.size() - kVertices.size() * kFalls.size());
    report.notes.push_back(text);
  }
  report.notes.push_back(
      "Clear, fixed, uncut and adaptive frames are drawn in turns. fps_gain is the adaptive rate over the "
      "fixed one, frame_ms_ratio the adaptive time over the clear one; _low and _high are the ends of the "
      "95 % interval. Where the outcome says that the cut is not enough, what falls costs more than the "
      "whole terrain: density_that_fits is what this machine can show.");
  report.notes.push_back(
      "cut_changed_pixels counts pixels that the adaptive far cut changed in the fogged picture, and "
      "cut_largest_of_255 is by how much; fixed_cut_changed_pixels counts those of the fixed ratio, whose "
      "cut "
      "no fog hides in clear air.");
  report.notes.push_back(
      "hold_ms_ratio is the median frame that the arbiter holds, without document D's cut, over the clear "
      "frame, drawn in turns; its budget is 1.05 of the clear frame, without margin and caution. "
      "hold_particles is the share of the preset's density that it keeps.");
  if (notTrusted > 0)
    report.notes.push_back("In " + std::to_string(notTrusted) + " of " +
                           std::to_string(report.measured.rows.size()) +
                           " rows times on this machine vary too much for the arbiter to trust its "
                           "predictions, so it lowers nothing there.");
  for (const Fall& fall : kFalls) report.plots.push_back(plotOf(report.measured, fall.name));
  return report;
}

}  // namespace trimtab::experiment
