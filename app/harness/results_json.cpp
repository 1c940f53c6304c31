#include "results_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "answer.h"
#include "trimtab/preset/json_text.h"
#include "trimtab/units/not_finite.h"
#include "trimtab/units/number.h"

namespace trimtab::harness {
namespace {

constexpr const char* kFormat = "trimtab-bench";
constexpr int kVersion = 1;
/// In the order of MeasuredDifference.
constexpr std::array kDifferences{"unknown", "none", "less", "more"};
/// Doubles count exactly up to here.
constexpr double kLargestWhole = 9007199254740992.0;

Json nameJson(const UnitName& name) {
  return {{"flight", name.flight}, {"preset", name.preset}, {"case", name.method}};
}

Json ratioJson(const PairedRatio& ratio) {
  const auto difference = ratio.pairs == 0 ? MeasuredDifference::unknown : differenceOf(ratio);
  return {{"median", numberJson(ratio.median)},
          {"low", numberJson(ratio.low)},
          {"high", numberJson(ratio.high)},
          {"pairs", ratio.pairs},
          {"difference", kDifferences[static_cast<std::size_t>(difference)]}};
}

/// Returns null if the frames do not say.
Json fitJson(Fit fit) {
  return fit == Fit::unsure ? Json() : Json(fit == Fit::yes);
}

/// Returns what tables of results show. It is derived from the frames, and not read again.
Json summaryJson(const AnswerRow& row) {
  return {{"median_ms", numberJson(row.medianMs)},
          {"p95_ms", numberJson(row.p95Ms)},
          {"p95_low_ms", numberJson(row.p95BoundsMs.low)},
          {"p95_high_ms", numberJson(row.p95BoundsMs.high)},
          {"p99_ms", numberJson(row.p99Ms)},
          {"over_budget_share", numberJson(row.overShare)},
          {"flip_mean", numberJson(row.flip)},
          {"geometric_max_px", numberJson(row.geometricPx)},
          {"pop_p95", numberJson(row.pop)},
          {"fits", fitJson(row.fit)}};
}

/// `equal` are those that do not differ from the best.
Json answerJson(const Answer& answer) {
  Json equal = Json::array();
  for (std::size_t i = 1; i < answer.best.size(); ++i)
    equal.push_back(nameJson(answer.rows[answer.best[i]].name));
  return {{"flight", answer.flight},
          {"budget_ms", numberJson(answer.budgetMs)},
          {"best", answer.best.empty() ? Json() : nameJson(answer.rows[answer.best.front()].name)},
          {"equal", std::move(equal)},
          {"why", answer.why}};
}

/// Returns the list of a frame's cells: row, time, quantities, repeats. Names once a unit, not once a frame.
Json columnsJson() {
  Json columns = {"row", "time_s"};
  for (const Quantity& quantity : quantities()) columns.push_back(std::string(quantity.key));
  columns.push_back("repeats_ms");
  return columns;
}

Json frameJson(const MeasuredFrame& frame) {
  Json cells = {frame.row, numberJson(frame.timeS)};
  for (const Quantity& quantity : quantities())
    cells.push_back(quantity.whole ? Json(static_cast<std::uint64_t>(quantity.of(frame)))
                                   : numberJson(quantity.of(frame)));
  Json repeats = Json::array();
  for (const double ms : frame.repeatsMs) repeats.push_back(numberJson(ms));
  cells.push_back(std::move(repeats));
  return cells;
}

Json unitJson(const Unit& unit, double budgetMs, const std::string& verdict) {
  Json json = nameJson(unit.name);
  json["verdict"] = verdict;
  json["summary"] = summaryJson(answerRow(unit, budgetMs));
  json["frames_decided"] = unit.framesDecided;
  json["unknown_signals"] = unit.unknownSignals;
  json["worst"] = Json::array();
  for (const WorstFrame& w : unit.worst)
    json["worst"].push_back({{"frame", w.frame},
                             {"why", w.why},
                             {"reference", w.reference},
                             {"ours", w.ours},
                             {"difference", w.difference}});
  json["skips"] = Json::array();
  for (const SkipSaving& s : unit.skips)
    json["skips"].push_back({{"name", s.name},
                             {"skipped", s.skipped},
                             {"frames", s.frames},
                             {"saved_ms", numberJson(s.savedMs)},
                             {"ratio", ratioJson(s.ratio)}});
  json["columns"] = columnsJson();
  json["frames"] = Json::array();
  for (const MeasuredFrame& frame : unit.frames) json["frames"].push_back(frameJson(frame));
  return json;
}

/// Reads values and keeps what is wrong with them; every read yields something, so that reading goes on.
class Reader {
 public:
  explicit Reader(std::string where) : where_(std::move(where)) {}
  Findings findings;

  void refuse(const std::string& place, std::string expected, const Json& found) {
    constexpr std::size_t kMost = 50, kShown = 60;
    if (findings.size() >= kMost) return;
    std::string text = found.is_discarded() ? "nothing" : found.dump(-1, ' ', true);
    if (text.size() > kShown) text = text.substr(0, kShown) + "...";
    findings.push_back({Severity::error, where_, place, std::move(expected), std::move(text)});
  }
  /// Returns the member, or a discarded value if there is none.
  static const Json& member(const Json& object, const std::string& key) {
    static const Json kNothing = Json(Json::value_t::discarded);
    const auto at = object.is_object() ? object.find(key) : object.end();
    return object.is_object() && at != object.end() ? *at : kNothing;
  }
  double number(const Json& value, const std::string& place) {
    if (value.is_number()) return value.get<double>();
    const std::string text = value.is_string() ? value.get<std::string>() : std::string();
    if (text == "nan") return kNan;
    if (text == "inf" || text == "-inf")
      return std::copysign(std::numeric_limits<double>::infinity(), text[0] == '-' ? -1 : 1);
    refuse(place, "a number, \"nan\", \"inf\" or \"-inf\"", value);
    return kNan;
  }
  std::uint64_t whole(const Json& value, const std::string& place) {
    const double number = value.is_number() ? value.get<double>() : -1;
    if (number >= 0 && number <= kLargestWhole && number == std::floor(number))
      return static_cast<std::uint64_t>(number);
    refuse(place, "a whole number, 0 or more", value);
    return 0;
  }
  std::string text(const Json& value, const std::string& place) {
    if (value.is_string()) return value.get<std::string>();
    refuse(place, "a text", value);
    return {};
  }
  /// Calls `each(element, place)` for an array's elements.
  template <class Each>
  void list(const Json& value, const std::string& place, const Each& each) {
    if (!value.is_array()) return refuse(place, "a list", value);
    for (std::size_t i = 0; i < value.size(); ++i) each(value[i], place + '[' + std::to_string(i) + ']');
  }

 private:
  std::string where_;
};

UnitName readName(Reader& reader, const Json& json, const std::string& place) {
  UnitName name;
  name.flight = reader.text(Reader::member(json, "flight"), place + ".flight");
  name.preset = reader.text(Reader::member(json, "preset"), place + ".preset");
  name.method = reader.text(Reader::member(json, "case"), place + ".case");
  return name;
}

PairedRatio readRatio(Reader& reader, const Json& json, const std::string& place) {
  PairedRatio ratio;
  ratio.median = reader.number(Reader::member(json, "median"), place + ".median");
  ratio.low = reader.number(Reader::member(json, "low"), place + ".low");
  ratio.high = reader.number(Reader::member(json, "high"), place + ".high");
  ratio.pairs = reader.whole(Reader::member(json, "pairs"), place + ".pairs");
  return ratio;
}

/// A cost or an error that an older version did not have was not measured; a count is needed.
MeasuredFrame readFrame(Reader& reader, const Json& cells, const std::vector<std::string>& columns,
                        const std::string& place) {
  MeasuredFrame frame;
  for (const Quantity& quantity : quantities())
    if (!quantity.whole) quantity.set(frame, kNan);
  if (!cells.is_array() || cells.size() != columns.size()) {
    reader.refuse(place, "a list of " + std::to_string(columns.size()) + " values, one a column", cells);
    return frame;
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string cell = place + '.' + columns[i];
    if (columns[i] == "row")
      frame.row = reader.whole(cells[i], cell);
    else if (columns[i] == "time_s")
      frame.timeS = reader.number(cells[i], cell);
    else if (columns[i] == "repeats_ms")
      reader.list(cells[i], cell, [&](const Json& ms, const std::string& at) {
        frame.repeatsMs.push_back(reader.number(ms, at));
      });
    else if (const Quantity* quantity = quantityOf(columns[i]))
      quantity->set(frame, quantity->whole ? static_cast<double>(reader.whole(cells[i], cell))
                                           : reader.number(cells[i], cell));
  }
  return frame;
}

Unit readUnit(Reader& reader, const Json& json, const std::string& place) {
  Unit unit;
  unit.name = readName(reader, json, place);
  unit.framesDecided = reader.whole(Reader::member(json, "frames_decided"), place + ".frames_decided");
  // Results of before signals were fed back have no list of them.
  if (const Json& unknown = Reader::member(json, "unknown_signals"); !unknown.is_discarded())
    reader.list(unknown, place + ".unknown_signals", [&](const Json& key, const std::string& at) {
      unit.unknownSignals.push_back(reader.text(key, at));
    });
  std::vector<std::string> columns;
  reader.list(Reader::member(json, "columns"), place + ".columns",
              [&](const Json& name, const std::string& at) { columns.push_back(reader.text(name, at)); });
  const auto needed = [&](std::string_view column) {
    if (std::find(columns.begin(), columns.end(), column) == columns.end())
      reader.refuse(place + ".columns", "a column " + std::string(column), Json(columns));
  };
  needed("row");
  needed("time_s");
  for (const Quantity& quantity : quantities())
    // Results of before back faces were left out have no count of them.
    if (quantity.whole && quantity.key != "culled_back_facing") needed(quantity.key);
  reader.list(Reader::member(json, "frames"), place + ".frames",
              [&](const Json& cells, const std::string& at) {
                unit.frames.push_back(readFrame(reader, cells, columns, at));
              });
  reader.list(Reader::member(json, "worst"), place + ".worst", [&](const Json& w, const std::string& at) {
    WorstFrame worst;
    worst.frame = reader.whole(Reader::member(w, "frame"), at + ".frame");
    if (worst.frame >= unit.frames.size())
      reader.refuse(at + ".frame", "one of " + std::to_string(unit.frames.size()) + " frames",
                    Reader::member(w, "frame"));
    worst.why = reader.text(Reader::member(w, "why"), at + ".why");
    worst.reference = reader.text(Reader::member(w, "reference"), at + ".reference");
    worst.ours = reader.text(Reader::member(w, "ours"), at + ".ours");
    worst.difference = reader.text(Reader::member(w, "difference"), at + ".difference");
    unit.worst.push_back(std::move(worst));
  });
  reader.list(Reader::member(json, "skips"), place + ".skips", [&](const Json& s, const std::string& at) {
    SkipSaving skip;
    skip.name = reader.text(Reader::member(s, "name"), at + ".name");
    skip.skipped = reader.whole(Reader::member(s, "skipped"), at + ".skipped");
    skip.frames = reader.whole(Reader::member(s, "frames"), at + ".frames");
    skip.savedMs = reader.number(Reader::member(s, "saved_ms"), at + ".saved_ms");
    skip.ratio = readRatio(reader, Reader::member(s, "ratio"), at + ".ratio");
    unit.skips.push_back(std::move(skip));
  });
  return unit;
}

int readPixels(Reader& reader, const Json& value, const std::string& place) {
  const std::uint64_t px = reader.whole(value, place);
  constexpr std::uint64_t kMost = 1u << 20;
  if (px > kMost) reader.refuse(place, "at most " + std::to_string(kMost) + " px", value);
  return static_cast<int>(std::min(px, kMost));
}

}  // namespace

Json numberJson(double value) {
  return std::isfinite(value) ? Json(value) : Json(numberText(std::isnan(value) ? kNan : value));
}

Json documentOf(const Results& results) {
  Json json = {{"format", kFormat},
               {"format_version", kVersion},
               {"terrain", results.terrain},
               {"machine", results.machine},
               {"version", results.version},
               {"width_px", results.widthPx},
               {"height_px", results.heightPx},
               {"repeats", results.repeats},
               {"budget_ms", numberJson(results.budgetMs)},
               {"others_share", numberJson(results.othersShare)},
               {"notes", results.notes},
               {"answers", Json::array()},
               {"comparisons", Json::array()},
               {"units", Json::array()}};
  std::map<std::string, std::vector<std::string>> verdicts;  // of each flight's units, in their order
  for (const Answer& answer : answersOf(results)) {
    json["answers"].push_back(answerJson(answer));
    for (std::size_t row = answer.rows.size(); row-- > 0;)
      verdicts[answer.flight].push_back(verdictText(answer, row));
  }
  for (const Comparison& c : results.comparisons)
    json["comparisons"].push_back({{"a", nameJson(c.a)},
                                   {"b", nameJson(c.b)},
                                   {"frame_time", ratioJson(c.frameTime)},
                                   {"reading", inWords(c.frameTime)}});
  for (const Unit& unit : results.units) {
    std::vector<std::string>& left = verdicts[unit.name.flight];
    json["units"].push_back(unitJson(unit, results.budgetMs, left.back()));
    left.pop_back();
  }
  return json;
}

std::string toJson(const Results& results) {
  return textOf(documentOf(results));
}

std::string textOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

Result<Results> parseResults(std::string_view text, const std::string& where) {
  if (const auto syntax = json::checkSyntax(text, where); !syntax) return syntax.findings();
  const Json json = Json::parse(text);
  Reader reader(where);
  const Json& format = Reader::member(json, "format");
  if (format != kFormat) {
    reader.refuse("format", '"' + std::string(kFormat) + '"', format);
    return reader.findings;
  }
  if (const Json& version = Reader::member(json, "format_version"); version != kVersion) {
    reader.refuse("format_version", std::to_string(kVersion), version);
    return reader.findings;
  }
  Results results;
  results.terrain = reader.text(Reader::member(json, "terrain"), "terrain");
  results.machine = reader.text(Reader::member(json, "machine"), "machine");
  results.version = reader.text(Reader::member(json, "version"), "version");
  results.widthPx = readPixels(reader, Reader::member(json, "width_px"), "width_px");
  results.heightPx = readPixels(reader, Reader::member(json, "height_px"), "height_px");
  results.repeats = reader.whole(Reader::member(json, "repeats"), "repeats");
  results.budgetMs = reader.number(Reader::member(json, "budget_ms"), "budget_ms");
  // Older results do not say it.
  if (const Json& others = Reader::member(json, "others_share"); !others.is_discarded())
    results.othersShare = reader.number(others, "others_share");
  reader.list(Reader::member(json, "notes"), "notes", [&](const Json& note, const std::string& at) {
    results.notes.push_back(reader.text(note, at));
  });
  reader.list(Reader::member(json, "comparisons"), "comparisons", [&](const Json& c, const std::string& at) {
    Comparison comparison;
    comparison.a = readName(reader, Reader::member(c, "a"), at + ".a");
    comparison.b = readName(reader, Reader::member(c, "b"), at + ".b");
    comparison.frameTime = readRatio(reader, Reader::member(c, "frame_time"), at + ".frame_time");
    results.comparisons.push_back(std::move(comparison));
  });
  reader.list(Reader::member(json, "units"), "units", [&](const Json& unit, const std::string& at) {
    results.units.push_back(readUnit(reader, unit, at));
  });
  if (!reader.findings.empty()) return reader.findings;
  return results;
}

}  // namespace trimtab::harness
