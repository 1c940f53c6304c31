#include <algorithm>
#include <cmath>
#include <numeric>

#include "app/experiment/stage.h"
#include "app/plot/svg.h"
#include "html_sections.h"
#include "html_text.h"
#include "report.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::harness {
namespace {

constexpr const char* kFrameMs = "frame_ms";
constexpr std::size_t kLabelledOneByOne = 5;  ///< so few points are named by preset and case

struct Spread {
  double low = kNan, high = kNan;
};
Spread spreadOf(const Unit& unit, const Quantity& quantity) {
  const std::vector<double> values = finiteOf(unit, quantity);
  return {experiment::quantileOf(values, 0.05), experiment::quantileOf(values, 0.95)};
}

std::string hintOf(const ReportModel& model, const Unit& unit, const Quantity& ms, const Quantity& error) {
  const Summary& s = model.summary(unit, ms);
  const double value = model.centre(unit, error);
  return unitText(unit.name) + ": " + roundedText(s.median) + " ms (p95 " +
         (std::isnan(s.p95) ? "-" : roundedText(s.p95)) + "), " + std::string(error.label) + ' ' +
         numberText(value, error) + ' ' + std::string(error.unit);
}

/// Where points fall in both, and what of a unit is no number.
struct Points {
  std::vector<const Unit*> units;
  std::vector<double> error, ms;
};
Points pointsOf(const ReportModel& model, const std::string& flight, const Quantity& error) {
  Points points;
  const Quantity& ms = *quantityOf(kFrameMs);
  for (const Unit* unit : model.unitsOf(flight)) {
    const double x = model.centre(*unit, error), y = model.summary(*unit, ms).median;
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    points.units.push_back(unit);
    points.error.push_back(x);
    points.ms.push_back(y);
  }
  return points;
}

/// The points on the front, by ascending error; none if the frames are too few to tell.
std::vector<std::size_t> frontOf(const Points& points, const Quantity& error) {
  if (points.units.empty() || medianIntervalRank(points.units.front()->frames.size()) == 0) return {};
  std::vector<std::vector<double>> errors;
  for (const Unit* unit : points.units) {
    errors.emplace_back();
    for (const MeasuredFrame& frame : unit->frames) errors.back().push_back(error.of(frame));
  }
  return trimtab::frontOf(points.error, points.ms, [&](std::size_t i, std::size_t j) {
    return isBetterInBoth(trimtab::differenceOf(frameTimeRatio(*points.units[i], *points.units[j])),
                          errorDifference(errors[i], errors[j]));
  });
}

std::string frontSentence(const ReportModel& model, const std::string& flight, const Quantity& error) {
  const Points points = pointsOf(model, flight, error);
  if (points.units.empty()) return {};
  const std::vector<std::size_t> front = frontOf(points, error);
  if (front.empty()) return "The frames are too few to tell what is on the front.";
  std::string text;
  for (const std::size_t i : front) {
    text += (text.empty() ? "" : "; ") + unitText(points.units[i]->name) + " (" + roundedText(points.ms[i]) +
            " ms, " + numberText(points.error[i], error) + ')';
  }
  return "On the front of frame time and " + std::string(error.label) + ": " + text + ".";
}

}  // namespace

std::vector<const Quantity*> paretoErrors(const ReportModel& model) {
  std::vector<const Quantity*> errors;
  for (const char* key : {"flip", "geometric_mean_px", "geometric_max_px"})
    if (const Quantity* error = quantityOf(key); error && model.measured(*error)) errors.push_back(error);
  if (!errors.empty()) return errors;
  for (const Quantity& error : quantities())
    if (error.kind == Quantity::Kind::error && !error.whole && error.largerIsWorse && model.measured(error))
      errors.push_back(&error);
  return errors;
}

plot::Plot paretoOf(const ReportModel& model, const std::string& flight, const Quantity& error) {
  const Quantity& ms = *quantityOf(kFrameMs);
  const Points points = pointsOf(model, flight, error);
  plot::Plot plot{"pareto", flight, axisText(error) + ", mean of the frames", "frame time, median (ms)",
                  {},       {}};
  plot.logX = plot::spansDecades(points.error);
  plot.logY = plot::spansDecades(points.ms);

  plot::Series front{"front", {}, {}, plot::Series::Draw::steps};
  for (const std::size_t i : frontOf(points, error)) {
    // Points that do not differ share the front, and its line leads along the lower ones.
    if (!front.y.empty() && points.ms[i] >= front.y.back()) continue;
    front.x.push_back(points.error[i]);
    front.y.push_back(points.ms[i]);
  }
  plot.series.push_back(front);
  for (const std::string& preset : model.presets) {
    plot::Series series{preset, {}, {}, plot::Series::Draw::joined};
    series.look = model.presetLook(preset);
    for (std::size_t i = 0; i < points.units.size(); ++i) {
      const Unit& unit = *points.units[i];
      if (unit.name.preset != preset) continue;
      const Spread time = spreadOf(unit, ms), lost = spreadOf(unit, error);
      series.x.push_back(points.error[i]);
      series.y.push_back(points.ms[i]);
      series.yLow.push_back(time.low);
      series.yHigh.push_back(time.high);
      series.xLow.push_back(lost.low);
      series.xHigh.push_back(lost.high);
      series.shapes.push_back(model.caseLook(unit.name.method));
      series.hints.push_back(hintOf(model, unit, ms, error));
      series.labels.push_back(points.units.size() <= kLabelledOneByOne && model.cases.size() > 1
                                  ? unitText(unit.name)
                                  : std::string());
    }
    if (series.x.empty()) continue;
    if (series.labels[0].empty()) {
      const auto fastest = std::min_element(series.y.begin(), series.y.end()) - series.y.begin();
      series.labels[static_cast<std::size_t>(fastest)] = preset;
    }
    plot.series.push_back(std::move(series));
  }
  if (std::isfinite(model.results.budgetMs))
    plot.guides = {{plot::Guide::Axis::y, model.results.budgetMs,
                    "budget " + roundedText(model.results.budgetMs) + " ms"}};
  plot.legend = false;
  return plot;
}

std::string legend(const std::vector<plot::Key>& keys) {
  std::string html = "<ul class=\"legend\">";
  for (const plot::Key& key : keys)
    html += "<li>" + plot::inlineMark(key) + ' ' + plot::escaped(key.name) + "</li>";
  return html + "</ul>\n";
}

std::string paretoSection(const ReportModel& model) {
  const auto errors = paretoErrors(model);
  std::string body;
  if (model.results.units.empty())
    body = paragraph("Nothing was measured.", "none");
  else if (errors.empty())
    body = paragraph("No error was measured: there is nothing to hold frame time against.", "none");
  else
    body =
        paragraph(
            "Lower left is best. A point is a preset in one case over a whole flight: the median frame time "
            "at the mean error. Whiskers run from the 5th to the 95th percentile of its frames; one without "
            "an end runs beyond the plot. The dashed "
            "line joins the front: what no other point surely beats, frame by frame, in one without losing "
            "in "
            "the other. Lines join the cases of one preset. Each preset "
            "is held against its own reference: the same view in the same air at the finest levels of the "
            "terrain that it draws, tiles or static trees, without culling and blur.") +
        legend(model.keys());
  if (!body.empty() && !errors.empty())
    for (const std::string& flight : model.flights) {
      body += "<div class=\"central\">\n";
      for (std::size_t i = 0; i < errors.size(); ++i) {
        plot::Plot plot = paretoOf(model, flight, *errors[i]);
        plot.widthPx = i == 0 ? 760 : 440;
        plot.heightPx = i == 0 ? 520 : 256;
        body += "<figure>" + plot::toInlineSvg(plot) + "</figure>\n";
      }
      body += "</div>\n" + paragraph(frontSentence(model, flight, *errors[0]));
    }
  return section("pareto", "Frame time against error", body);
}

std::string paretoPlot(const Results& results) {
  const ReportModel model(results);
  auto errors = paretoErrors(model);
  const std::size_t kept = model.flights.size() > 2 ? 1 : 2;
  if (errors.size() > kept) errors.resize(kept);
  std::vector<plot::Plot> plots;
  for (const std::string& flight : model.flights)
    for (const Quantity* error : errors) {
      plots.push_back(paretoOf(model, flight, *error));
      plots.back().widthPx = 470;
      plots.back().heightPx = 330;
    }
  return plot::toSvg(
      "Frame time against error" + (results.terrain.empty() ? std::string() : ", " + results.terrain),
      model.keys(), plots, 2);
}

}  // namespace trimtab::harness
