#include <algorithm>
#include <cmath>

#include "app/experiment/stage.h"
#include "app/plot/svg.h"
#include "html_sections.h"
#include "html_text.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::harness {
namespace {

using Kind = Quantity::Kind;

std::vector<const Quantity*> stagesOf(const ReportModel& model) {
  std::vector<const Quantity*> stages;
  for (const Quantity& q : quantities())
    if (q.kind == Kind::cost && q.stage != StageKind::total && model.measured(q)) stages.push_back(&q);
  return stages;
}

/// Over all frames: one that leaves the stage out spends nothing on it.
double medianOfAll(const Unit& unit, const Quantity& stage) {
  std::vector<double> values;
  for (const MeasuredFrame& frame : unit.frames) {
    const double value = stage.of(frame);
    values.push_back(std::isfinite(value) ? value : 0);
  }
  return experiment::quantileOf(values, 0.5);
}

std::string stageBars(const ReportModel& model, const std::string& flight) {
  plot::Plot plot{"stages", flight, "median (ms)", "", {}, {}};
  plot.kind = plot::Plot::Kind::rows;
  plot.widthPx = 980;
  const auto units = model.unitsOf(flight);
  for (const Unit* unit : units) plot.categories.push_back(unitText(unit->name));
  int look = 0;
  for (const Quantity* q : stagesOf(model)) {
    const int own = look++;
    if (q->stage == StageKind::part) continue;  // counted in another stage already
    plot::Series series{std::string(q->label), {}, {}};
    series.look = own;
    if (q->stage == StageKind::beside) series.draw = plot::Series::Draw::points;
    bool any = false;
    for (const Unit* unit : units) {
      const double value = medianOfAll(*unit, *q);
      const bool has = !std::isnan(model.summary(*unit, *q).median);
      any = any || has;
      series.y.push_back(has ? value : std::nan(""));
      series.hints.push_back(std::string(q->label) + ' ' + roundedText(value) + " ms, " +
                             unitText(unit->name));
    }
    if (any) plot.series.push_back(std::move(series));
  }
  plot::Series total{"frame time", {}, {}, plot::Series::Draw::points};
  total.look = plot::Series::kInk;
  for (const Unit* unit : units) {
    const double value = model.summary(*unit, *quantityOf("frame_ms")).median;
    total.y.push_back(value);
    total.shapes.push_back(3);
    total.hints.push_back("frame time " + roundedText(value) + " ms, " + unitText(unit->name));
  }
  for (const plot::Series& s : plot.series)
    plot.keys.push_back({s.name, s.look, s.draw == plot::Series::Draw::points ? s.look : -1});
  plot.keys.push_back({total.name, total.look, 3});
  plot.series.push_back(std::move(total));
  if (std::isfinite(model.results.budgetMs))
    plot.guides = {{plot::Guide::Axis::x, model.results.budgetMs,
                    "budget " + roundedText(model.results.budgetMs) + " ms"}};
  return "<figure>" + plot::toInlineSvg(plot) + "</figure>\n";
}

std::string stageTable(const ReportModel& model) {
  std::vector<HtmlColumn> columns;
  if (model.flights.size() > 1) columns.push_back({"flight", "", "", false});
  columns.push_back({"preset", "", "", false});
  columns.push_back({"case", "", "", false});
  const auto stages = stagesOf(model);
  for (const Quantity* q : stages)
    columns.push_back({std::string(q->label),
                       q->stage == StageKind::part     ? "part of the drawing"
                       : q->stage == StageKind::beside ? "beside the frame"
                                                       : "ms",
                       "median, beneath p95 and p99, of the frames that ran it"});
  HtmlTable table("Stages (ms): median; beneath, p95 / p99 of the frames that ran them", columns);
  for (const Unit& unit : model.results.units) {
    table.row();
    if (model.flights.size() > 1) table.text(unit.name.flight);
    table.text(unit.name.preset);
    table.text(caseText(unit.name.method));
    for (const Quantity* q : stages) {
      const Summary& s = model.summary(unit, *q);
      const std::size_t ran = finiteOf(unit, *q).size();
      const auto orNone = [](double ms) { return std::isnan(ms) ? std::string("-") : msText(ms); };
      std::string more = orNone(s.p95) + " / " + orNone(s.p99);
      if (ran < unit.frames.size())
        more += "; in " + std::to_string(ran) + " of " + std::to_string(unit.frames.size());
      table.number(s.median, msText(s.median), more);
    }
  }
  return table.take();
}

struct Range {
  double low = kInfinity, high = -kInfinity;
  bool infinite = false, absent = false;
  bool empty() const { return high < low; }
};
Range rangeOf(const std::vector<const Unit*>& units, const Quantity& quantity) {
  Range range;
  for (const Unit* unit : units)
    for (const MeasuredFrame& frame : unit->frames) {
      const double value = quantity.of(frame);
      range.infinite = range.infinite || std::isinf(value);
      range.absent = range.absent || std::isnan(value);
      if (!std::isfinite(value)) continue;
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
    }
  return range;
}

plot::Plot alongFlight(const ReportModel& model, const std::string& flight, const std::string& preset,
                       const Quantity& quantity, const Range& range) {
  plot::Plot plot{"flight", preset, "flight time (s)", std::string(quantity.unit), {}, {}};
  plot.widthPx = 400;
  plot.heightPx = 210;
  plot.legend = false;
  const bool fromZero = quantity.largerIsWorse || quantity.kind == Kind::count;
  const double room = 0.04 * (range.high - range.low);
  plot.yFrom = fromZero ? std::min(0.0, range.low) : range.low - room;
  plot.yTo = range.high + room;
  plot.xFrom = kInfinity;
  plot.xTo = -kInfinity;
  plot::Series worst{"worst", {}, {}, plot::Series::Draw::points};
  for (const std::string& method : model.cases) {
    const Unit* unit = model.unit(flight, preset, method);
    if (!unit) continue;
    plot::Series series{caseText(method), {}, {}};
    series.look = model.caseLook(method);
    for (const MeasuredFrame& frame : unit->frames) {
      series.x.push_back(frame.timeS);
      series.y.push_back(quantity.of(frame));
      if (std::isfinite(frame.timeS)) {
        plot.xFrom = std::min(plot.xFrom, frame.timeS);
        plot.xTo = std::max(plot.xTo, frame.timeS);
      }
    }
    for (const WorstFrame& w : unit->worst) {
      if (w.frame >= unit->frames.size()) continue;
      worst.x.push_back(unit->frames[w.frame].timeS);
      worst.y.push_back(quantity.of(unit->frames[w.frame]));
      worst.hints.push_back(w.why + ", " + caseText(method));
    }
    plot.series.push_back(std::move(series));
  }
  worst.look = 3;
  plot.series.push_back(std::move(worst));
  return plot;
}

std::string alongFlight(const ReportModel& model, const std::string& flight) {
  const auto units = model.unitsOf(flight);
  std::string html, still;
  for (const Quantity& q : quantities()) {
    if (q.kind == Kind::cost && q.stage != StageKind::total) continue;
    const Range range = rangeOf(units, q);
    if (range.empty() && !range.infinite) continue;  // the summary says what was not measured
    if (range.empty() || (range.low == range.high && !range.infinite)) {
      still += (still.empty() ? "" : "; ") + std::string(q.label) + ' ' +
               (range.empty() ? roundedText(kInfinity) : numberText(range.low, q)) +
               (q.unit.empty() ? std::string() : ' ' + std::string(q.unit));
      continue;
    }
    const std::string gaps = range.infinite ? " (gaps: the picture equals its reference)" : "";
    std::string panels;
    for (const std::string& preset : model.presets) {
      if (std::none_of(units.begin(), units.end(), [&](const Unit* u) { return u->name.preset == preset; }))
        continue;
      plot::Plot plot = alongFlight(model, flight, preset, q, range);
      if (model.presets.size() == 1) plot.title = axisText(q) + gaps;
      panels += "<figure>" + plot::toInlineSvg(plot) + "</figure>\n";
    }
    if (model.presets.size() == 1)
      html += panels;
    else
      html += "<h4>" + plot::escaped(axisText(q)) + "<small>" + gaps +
              "</small></h4>\n<div class=\"small\">\n" + panels + "</div>\n";
  }
  if (model.presets.size() == 1 && !html.empty()) html = "<div class=\"small\">\n" + html + "</div>\n";
  if (!still.empty()) html += paragraph("The same in every frame: " + still + ".", "none");
  return html;
}

}  // namespace

std::string stagesSection(const ReportModel& model) {
  if (stagesOf(model).empty())
    return section("stages", "Stages", paragraph("No stage was measured.", "none"));
  std::string absent;
  for (const Quantity& q : quantities())
    if (q.kind == Kind::cost && !model.measured(q))
      absent += (absent.empty() ? "" : ", ") + std::string(q.label);
  std::string body = paragraph(
      "Stages are stacked; the diamond is the median frame time, which need not be the sum of medians. Page "
      "is what the step from the frame before adds: it is measured apart and not in the frame time. In the "
      "bars a frame that leaves a stage out counts as 0; in the table it does not count.");
  for (const std::string& flight : model.flights) body += stageBars(model, flight);
  body += stageTable(model);
  if (!absent.empty())
    body += paragraph("Not run, or not measurable on this machine: " + absent + ".", "none");
  return section("stages", "Stages", body);
}

std::string flightSection(const ReportModel& model) {
  std::vector<plot::Key> keys;
  for (const std::string& method : model.cases)
    keys.push_back({caseText(method), model.caseLook(method), -1, true});
  keys.push_back({"worst frame, with its pictures below", 3, 3});
  std::string body = paragraph(
      "Panels of one row share their scale. Where cases give the same number the lines cover each other.");
  body += legend(keys);
  for (const std::string& flight : model.flights)
    body += "<h3>" + plot::escaped(flight) + "</h3>\n" + alongFlight(model, flight);
  if (model.flights.empty()) body = paragraph("Nothing was measured.", "none");
  return section("flight", "Along the flight", body);
}

}  // namespace trimtab::harness
