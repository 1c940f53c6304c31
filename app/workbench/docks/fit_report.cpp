// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit_report.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "trimtab/units/number.h"

namespace trimtab::workbench {
namespace {

experiment::Cell cellOf(double value) {
  return std::isfinite(value) ? experiment::Cell(value) : experiment::Cell();
}

std::string intervalText(const PairedRatio& ratio) {
  return numberText(ratio.low, 3) + " to " + numberText(ratio.high, 3);
}

}  // namespace

experiment::Report fitReport(const IgFit& fit, const IgProfile& profile) {
  experiment::Report made;
  made.name = "fit";
  made.source = profile.name;
  experiment::Plot plot;
  plot.file = "times";
  plot.title = "Time beside neutral";
  plot.yLabel = "time ratio";
  experiment::Series times;
  times.name = "time";
  for (const LeverPoint& point : fit.points) {
    const auto lever = std::ranges::find(profile.levers, point.row, &IgLever::row);
    if (lever == profile.levers.end()) continue;
    const std::string setting = lever->ownKey + ' ' + numberText(lever->toOwn(point.value), 4) +
                                (lever->ownUnit.empty() ? "" : ' ' + lever->ownUnit);
    made.measured.add({{"setting", setting},
                       {"lever", std::string(lever->names().label)},
                       {"time ratio", cellOf(point.time.median)},
                       {"time interval", intervalText(point.time)},
                       {"load ratio", cellOf(point.load.median)},
                       {"FLIP", cellOf(point.flip)},
                       {"moved px", cellOf(point.shiftPx)}});
    plot.categories.push_back(setting);
    times.y.push_back(point.time.median);
    times.yLow.push_back(point.time.low);
    times.yHigh.push_back(point.time.high);
  }
  plot.series.push_back(std::move(times));
  made.plots.push_back(std::move(plot));
  std::istringstream lines(trimtab::report(fit, profile));
  for (std::string line; std::getline(lines, line);) made.notes.push_back(line);
  return made;
}

}  // namespace trimtab::workbench
