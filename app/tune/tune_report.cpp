#include <algorithm>
#include <cmath>

#include "trimtab/measure/machine_watch.h"
#include "trimtab/units/number.h"
#include "tune.h"
#include "verdict.h"

namespace trimtab::tune {
namespace {

using experiment::Cell;

std::string_view toText(Role role) {
  constexpr std::array<std::string_view, 5> kNames{"start", "default", "best change of one parameter",
                                                   "best of 200 random", "found"};
  return kNames[static_cast<std::size_t>(role)];
}

Cell cellOf(double value) {
  return std::isfinite(value) ? Cell(value) : Cell();
}

/// Returns an end of an estimate's band, a part of it away from it.
Cell bandEnd(double estimate, double part) {
  return cellOf(std::max(estimate * (1 + part), 0.0));
}

}  // namespace

experiment::Report toReport(const Plan& plan, const Outcome& outcome) {
  const ErrorKindRow& error = rowOf(plan.error);
  experiment::Report report;
  report.name = "tune";
  report.source = "Search for presets";
  report.machine = outcome.machine;
  report.notes.push_back(outcome.answer);
  for (const Tuned& preset : outcome.presets)
    for (std::size_t i = 0; i < preset.measured.size(); ++i) {
      const bool seen = i < plan.flights.size();
      const auto& flight = seen ? plan.flights[i] : plan.heldOut[i - plan.flights.size()];
      const harness::AnswerRow& row = preset.measured[i];
      const Estimate& estimate = preset.estimates[i];
      report.measured.add({{"preset", preset.name},
                           {"is", std::string(toText(preset.role))},
                           {"on_front", std::string(preset.onFront ? "yes" : "no")},
                           {"flight", flight.name},
                           {"held_out", std::string(seen ? "no" : "yes")},
                           {"median_ms", cellOf(row.medianMs)},
                           {"p95_ms", cellOf(row.p95Ms)},
                           {"p95_low_ms", cellOf(row.p95BoundsMs.low)},
                           {"p95_high_ms", cellOf(row.p95BoundsMs.high)},
                           {"flip", cellOf(row.flip)},
                           {"geometric_px", cellOf(row.geometricPx)},
                           {"pop", cellOf(row.pop)},
                           {"estimated_p95_ms", cellOf(estimate.p95Ms)},
                           {"estimated_p95_low_ms", bandEnd(estimate.p95Ms, -estimate.timeBand)},
                           {"estimated_p95_high_ms", bandEnd(estimate.p95Ms, estimate.timeBand)},
                           {error.estimate, cellOf(estimate.error)},
                           {error.estimateLow, bandEnd(estimate.error, -estimate.errorBand)},
                           {error.estimateHigh, bandEnd(estimate.error, estimate.errorBand)}});
    }
  for (const Tuned& preset : outcome.presets) {
    if (preset.role == Role::start || preset.role == Role::standard) continue;
    std::string text = preset.name + " moves " + (preset.moved.empty() ? "nothing" : "");
    for (std::size_t i = 0; i < preset.moved.size(); ++i) text += (i > 0 ? "; " : "") + preset.moved[i];
    report.notes.push_back(text + '.');
  }
  if (!outcome.idle.empty()) {
    std::string text = "No found preset had to move: ";
    for (std::size_t i = 0; i < outcome.idle.size(); ++i) text += (i > 0 ? ", " : "") + outcome.idle[i];
    report.notes.push_back(text + '.');
  }
  report.notes.insert(report.notes.end(), outcome.notes.begin(), outcome.notes.end());
  report.notes.push_back(
      "Times and errors are drawn as flown, the presets in turns, " + std::to_string(plan.frames) +
      " frames of each flight at " + std::to_string(plan.widthPx) + " x " + std::to_string(plan.heightPx) +
      ". Estimates come from " + std::to_string(plan.drawnRows) +
      " drawn rows of a flight. Their bands are fitted: nine of ten images of those rows lie "
      "within them, in time and, with several levers moved, in error. They are no bounds.");
  if (const std::string busy = busyText(outcome.othersShare); !busy.empty()) report.notes.push_back(busy);
  experiment::Plot plot;
  plot.file = "front";
  plot.title = "Run time against error";
  plot.xLabel = "p95 of the frame time, ms";
  plot.yLabel = error.words;
  for (const bool seen : {true, false})
    for (std::size_t role = 0; role < 5; ++role) {
      experiment::Series series;
      series.name = std::string(toText(static_cast<Role>(role))) + (seen ? "" : ", held out");
      series.draw = experiment::Series::Draw::points;
      for (const Tuned& preset : outcome.presets) {
        if (preset.role != static_cast<Role>(role)) continue;
        for (std::size_t i = 0; i < preset.measured.size(); ++i) {
          const harness::AnswerRow& row = preset.measured[i];
          if (seen != (i < plan.flights.size()) || !std::isfinite(row.p95Ms)) continue;
          series.x.push_back(row.p95Ms);
          series.y.push_back(measuredError(plan, row));
          series.xLow.push_back(row.p95BoundsMs.low);
          series.xHigh.push_back(row.p95BoundsMs.high);
        }
      }
      if (!series.x.empty()) plot.series.push_back(std::move(series));
    }
  report.plots.push_back(std::move(plot));
  return report;
}

}  // namespace trimtab::tune
