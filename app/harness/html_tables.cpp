#include <algorithm>
#include <cmath>

#include "answer.h"
#include "html_sections.h"
#include "html_text.h"
#include "trimtab/frame/frame_request.h"

namespace trimtab::harness {
namespace {

using Kind = Quantity::Kind;

std::vector<const Quantity*> measuredOf(const ReportModel& model, Kind kind) {
  std::vector<const Quantity*> list;
  for (const Quantity& q : quantities())
    if (q.kind == kind && model.measured(q)) list.push_back(&q);
  return list;
}

std::string absentText(const ReportModel& model, Kind kind) {
  std::vector<std::string> absent;
  for (const Quantity& q : quantities())
    if (q.kind == kind && !model.measured(q)) absent.emplace_back(q.label);
  return absent.empty() ? std::string() : "Not run, or not measured here: " + enumerated(absent) + ".";
}

std::vector<HtmlColumn> nameColumns(const ReportModel& model) {
  std::vector<HtmlColumn> columns;
  if (model.flights.size() > 1) columns.push_back({"flight", "", "", false});
  columns.push_back({"preset", "", "", false});
  columns.push_back({"case", "", "", false});
  return columns;
}
void nameCells(HtmlTable& table, const ReportModel& model, const UnitName& name) {
  table.row();
  if (model.flights.size() > 1) table.text(name.flight);
  table.text(name.preset);
  table.text(caseText(name.method));
}

/// Pixels that must not be: any other number than 0 is a defect.
void defectCell(HtmlTable& table, const Unit& unit, const Quantity& quantity) {
  double sum = 0;
  std::size_t frames = 0;
  for (const MeasuredFrame& frame : unit.frames)
    if (const double value = quantity.of(frame); value > 0) sum += value, ++frames;
  if (frames == 0) return table.number(0, "0", "none", "good");
  table.number(sum, "\xe2\x9a\xa0 " + wholeText(sum),
               "in " + std::to_string(frames) + " of " + std::to_string(unit.frames.size()) + " frames",
               "bad");
}

/// A percentile, or why there is none.
void percentileCell(HtmlTable& table, double value, std::size_t frames, std::string_view more = {}) {
  if (std::isnan(value) && frames > 0) return table.text("- (too few frames)");
  table.number(value, roundedText(value), more);
}

std::string timeTable(const ReportModel& model) {
  auto columns = nameColumns(model);
  const Quantity& ms = *quantityOf("frame_ms");
  columns.push_back({"median", "ms", "of the frame times of this row"});
  columns.push_back(
      {"p95", "ms",
       "of the frame times of this row, from 20 frames on; beneath, where that of the flight lies: "
       "each bound with 95 % confidence"});
  columns.push_back({"p99", "ms", "of the frame times of this row, from 100 frames on"});
  columns.push_back({"over budget", "%", "share of the frames that are longer than the budget"});
  columns.push_back({"verdict", "", "whether 95 % of the frames are surely within the budget", false});
  const auto counts = measuredOf(model, Kind::count);
  for (const Quantity* q : counts)
    columns.push_back({std::string(q->label), "", "median of the frames; beneath, the largest"});
  HtmlTable table("Frame time, and what a frame draws and leaves out (median; beneath, the largest)",
                  columns);
  for (const Answer& answer : answersOf(model.results)) {
    const auto units = model.unitsOf(answer.flight);
    for (std::size_t u = 0; u < units.size(); ++u) {
      const Unit& unit = *units[u];
      const AnswerRow& row = answer.rows[u];
      nameCells(table, model, unit.name);
      table.number(row.medianMs, roundedText(row.medianMs));
      const std::size_t timed = finiteOf(unit, ms).size();
      percentileCell(table, row.p95Ms, timed, boundsText(row.p95BoundsMs));
      percentileCell(table, row.p99Ms, timed);
      table.number(row.overShare * 100, roundedText(row.overShare * 100));
      table.text(verdictText(answer, u));
      for (const Quantity* q : counts) {
        const auto values = finiteOf(unit, *q);
        const double median = model.summary(unit, *q).median;
        table.number(median, wholeText(median),
                     values.empty() ? "" : wholeText(*std::max_element(values.begin(), values.end())));
      }
    }
  }
  return table.take();
}

/// The levers with which frames were drawn, after policy and budget.
std::string leverTable(const ReportModel& model) {
  auto columns = nameColumns(model);
  const auto levers = measuredOf(model, Kind::lever);
  for (const Quantity* q : levers)
    columns.push_back(
        {std::string(q->label), std::string(q->unit), "median of the frames; beneath, from least to most"});
  HtmlTable table("Levers as drawn (median; beneath, from least to most)", columns);
  for (const Answer& answer : answersOf(model.results))
    for (const Unit* unit : model.unitsOf(answer.flight)) {
      nameCells(table, model, unit->name);
      for (const Quantity* q : levers) {
        const auto values = finiteOf(*unit, *q);
        if (values.empty()) {
          table.text("-");
          continue;
        }
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        const double median = model.summary(*unit, *q).median;
        table.number(median, roundedText(median),
                     *least == *most ? std::string() : roundedText(*least) + " to " + roundedText(*most));
      }
    }
  return table.take();
}

std::string errorTable(const ReportModel& model) {
  auto columns = nameColumns(model);
  const auto errors = measuredOf(model, Kind::error);
  for (const Quantity* q : errors)
    columns.push_back({std::string(q->label), std::string(q->unit),
                       q->whole ? "sum over all frames: anything but 0 is a defect"
                                : std::string(q->largerIsWorse ? "smaller" : "larger") +
                                      " is better; the mean of the frames, beneath the worst"});
  HtmlTable table("What the pictures lost against their reference (mean; beneath, the worst frame)", columns);
  for (const Unit& unit : model.results.units) {
    nameCells(table, model, unit.name);
    for (const Quantity* q : errors) {
      if (q->whole) {
        defectCell(table, unit, *q);
        continue;
      }
      const double centre = model.centre(unit, *q);
      table.number(centre, numberText(centre, *q), numberText(model.summary(unit, *q).worst, *q));
    }
  }
  return table.take();
}

const char* classOf(const PairedRatio& ratio) {
  const MeasuredDifference difference = differenceOf(ratio);
  return difference == MeasuredDifference::less   ? "good"
         : difference == MeasuredDifference::more ? "slow"
                                                  : "";
}

constexpr const char* kHowToRead =
    "Both were drawn in turn, frame by frame, so that what disturbs the machine disturbs both. An interval "
    "holds the true ratio with 95 % confidence: where it does not contain 1 the difference is real, where it "
    "does there is none to tell from noise.";

/// What the two have in common is named once.
std::string comparisonText(const Comparison& c) {
  if (c.a.preset == c.b.preset)
    return caseText(c.b.method) + " over " + caseText(c.a.method) + '\n' + c.b.preset;
  if (c.a.method == c.b.method) return c.b.preset + "\nover " + c.a.preset + ", " + caseText(c.b.method);
  return unitText(c.b) + "\nover " + unitText(c.a);
}

/// Shape and colour say what the interval says.
struct Verdict {
  const char* name;
  int look, shape;
};
constexpr Verdict kVerdicts[]{{"faster", 2, 4}, {"slower", 1, 2}, {"no difference, or too few pairs", 0, 0}};

std::string forest(const ReportModel& model, const std::string& flight) {
  plot::Plot plot{"ratios", flight, "frame time, ratio (below 1: faster)", "", {}, {}};
  plot.kind = plot::Plot::Kind::rows;
  plot.logX = true;
  plot.legend = false;
  plot.widthPx = 980;
  plot.guides = {{plot::Guide::Axis::x, 1, "equal"}};
  for (const Verdict& verdict : kVerdicts) {
    plot::Series series{verdict.name, {}, {}, plot::Series::Draw::points};
    series.look = verdict.look;
    for (const Comparison& c : model.results.comparisons) {
      if (c.b.flight != flight) continue;
      const PairedRatio& r = c.frameTime;
      const MeasuredDifference difference = differenceOf(r);
      const int look = difference == MeasuredDifference::less   ? 2
                       : difference == MeasuredDifference::more ? 1
                                                                : 0;
      const double kNone = std::nan("");
      const bool mine = look == verdict.look && r.median > 0;
      series.y.push_back(mine ? r.median : kNone);
      series.xLow.push_back(mine ? r.low > 0 ? r.low : -HUGE_VAL : kNone);
      series.xHigh.push_back(mine ? r.high : kNone);
      series.shapes.push_back(verdict.shape);
      series.hints.push_back(unitText(c.b) + " over " + unitText(c.a) + ": " + roundedText(r.median) + " (" +
                             intervalText(r) + "), " + std::to_string(r.pairs) + " pairs");
    }
    plot.series.push_back(std::move(series));
  }
  for (const Comparison& c : model.results.comparisons)
    if (c.b.flight == flight) plot.categories.push_back(comparisonText(c));
  return plot.categories.empty() ? std::string() : "<figure>" + plot::toInlineSvg(plot) + "</figure>\n";
}

}  // namespace

std::string summarySection(const ReportModel& model) {
  if (model.results.units.empty())
    return section("summary", "Summary", paragraph("Nothing was measured.", "none"));
  std::string body;
  for (const Answer& answer : answersOf(model.results))
    body += paragraph((model.flights.size() > 1 ? answer.flight + ": " : std::string()) + answer.why);
  body += timeTable(model) + errorTable(model) + leverTable(model);
  if (const std::string absent = absentText(model, Kind::error); !absent.empty())
    body += paragraph(absent, "none");
  return section("summary", "Summary", body);
}

std::string skipsSection(const ReportModel& model) {
  auto columns = nameColumns(model);
  columns.push_back({"skipped work", "", "", false});
  columns.push_back({"frames", "skipped"});
  columns.push_back({"saved", "ms a frame"});
  columns.push_back({"without over with", "ratio"});
  columns.push_back({"95 % interval", "", "", false});
  columns.push_back({"pairs", ""});
  HtmlTable table("Work that frames left out because its result was known, and what leaving it out saved",
                  columns);
  std::vector<std::string> never;
  std::size_t measured = 0;
  for (const Unit& unit : model.results.units)
    for (const SkipSaving& skip : unit.skips) {
      ++measured;
      if (skip.skipped == 0) {
        if (std::find(never.begin(), never.end(), skip.name) == never.end()) never.push_back(skip.name);
        continue;
      }
      nameCells(table, model, unit.name);
      table.text(skip.name);
      table.number(static_cast<double>(skip.skipped), wholeText(static_cast<double>(skip.skipped)) + " of " +
                                                          wholeText(static_cast<double>(skip.frames)));
      table.number(skip.savedMs, msText(skip.savedMs));
      const bool known = skip.ratio.pairs > 0;
      table.number(known ? skip.ratio.median : std::nan(""), ratioText(skip.ratio.median), "",
                   differenceOf(skip.ratio) == MeasuredDifference::more ? "good" : "");
      table.text(intervalText(skip.ratio));
      table.number(static_cast<double>(skip.ratio.pairs), std::to_string(skip.ratio.pairs));
    }
  if (measured == 0) return section("skips", "Skips", paragraph("No skip was measured.", "none"));
  std::string body;
  if (!table.empty())
    body = paragraph(
               "Measured by switching each skip off, in pairs: a ratio above 1 is what the frame would cost "
               "without it.") +
           table.take();
  if (!never.empty())
    body += paragraph(
        "Units that are not listed beside a skip never had it to make: " + enumerated(never) + ".", "none");
  return section("skips", "Skips", body);
}

std::string comparisonSection(const ReportModel& model) {
  if (model.results.comparisons.empty())
    return section("ratios", "Paired comparisons",
                   paragraph("Only one unit a flight: nothing to compare.", "none"));
  std::vector<plot::Key> keys;
  for (const Verdict& verdict : kVerdicts) keys.push_back({verdict.name, verdict.look, verdict.shape});
  std::string body = paragraph(kHowToRead) + legend(keys);
  for (const std::string& flight : model.flights) body += forest(model, flight);
  std::vector<HtmlColumn> columns;
  if (model.flights.size() > 1) columns.push_back({"flight", "", "", false});
  for (const char* name : {"this", "over that"}) columns.push_back({name, "", "", false});
  columns.push_back({"ratio", ""});
  columns.push_back({"95 % interval", "", "", false});
  columns.push_back({"pairs", ""});
  columns.push_back({"so it is", "", "", false});
  HtmlTable table("Frame time, this over that", columns);
  for (const Comparison& c : model.results.comparisons) {
    table.row();
    if (model.flights.size() > 1) table.text(c.b.flight);
    table.text(unitText(c.b));
    table.text(unitText(c.a));
    table.number(c.frameTime.median, ratioText(c.frameTime.median), "", classOf(c.frameTime));
    table.text(intervalText(c.frameTime));
    table.number(static_cast<double>(c.frameTime.pairs), std::to_string(c.frameTime.pairs));
    table.text(inWords(c.frameTime));
  }
  return section("ratios", "Paired comparisons", body + table.take());
}

}  // namespace trimtab::harness
