#include "trimtab/measure/trace.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <type_traits>

#include "trace_cells.h"
#include "trace_columns.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

using trace::Cell;
using trace::Expected;
using trace::Flat;
using trace::IsOptional;
using trace::parse;
using trace::print;

constexpr std::size_t kMostFindings = 50;

std::vector<std::string_view> cellsOf(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

/// Returns where in a line each known column is, in the order of forEachColumn; kAbsent if the file misses
/// it.
std::vector<std::size_t> placesOf(std::string_view header, const std::string& where, Findings& findings) {
  const std::vector<std::string_view> names = cellsOf(header);
  std::vector<std::size_t> places;
  Flat none;
  trace::forEachColumn(none, [&](const char* name, Cell kind, const auto&) {
    std::size_t place = kAbsent;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == name) place = i;
    if (place == kAbsent && kind == Cell::required)
      findings.push_back({Severity::error, where + ":1", name, "this column", "no such column"});
    places.push_back(place);
  });
  return places;
}

/// Reads one line into `flat`; bad cells become findings.
void readCells(const std::vector<std::string_view>& cells, const std::vector<std::size_t>& places,
               const std::string& where, Flat& flat, Findings& findings) {
  std::size_t column = 0;
  trace::forEachColumn(flat, [&](const char* name, Cell kind, auto& value) {
    const std::size_t place = places[column++];
    const std::string_view cell = place < cells.size() ? cells[place] : std::string_view{};
    Expected expected;
    bool good = true;
    if (cell.empty()) {
      good = kind != Cell::required;
      expected.what = "a value";
    } else if constexpr (IsOptional<std::remove_reference_t<decltype(value)>>::value) {
      good = parse(cell, value.emplace(), expected);
    } else {
      good = parse(cell, value, expected);
    }
    if (!cell.empty() && kind == Cell::frame) flat.hasFrame = true;
    if (!cell.empty() && kind == Cell::hold) flat.hasHold = true;
    if (!good && findings.size() < kMostFindings)
      findings.push_back({Severity::error, where, name, expected.what,
                          cell.empty() ? "nothing" : '"' + std::string(cell.substr(0, 40)) + '"'});
  });
}

}  // namespace

TraceCounts countsOf(const FrameResult& drawn) {
  const VisibleSet& visible = drawn.visible;
  return {visible.triangles,      visible.vertices,    visible.tiles.size(),
          visible.outsideFrustum, visible.occluded,    visible.beyondVisibility,
          visible.backFacing,     drawn.objects.drawn, drawn.objects.occluded};
}

std::string_view toText(Scheme scheme) {
  switch (scheme) {
    case Scheme::frustum:
      return "frustum";
    case Scheme::dynamic:
      return "dynamic";
  }
  return "";
}

std::string_view toText(SchemeReason reason) {
  switch (reason) {
    case SchemeReason::below_first_band:
      return "below_first_band";
    case SchemeReason::in_band:
      return "in_band";
    case SchemeReason::held_by_hysteresis:
      return "held_by_hysteresis";
    case SchemeReason::invalid_input:
      return "invalid_input";
    case SchemeReason::altitude_unknown:
      return "altitude_unknown";
  }
  return "";
}

std::string traceHeader() {
  std::string header;
  Flat none;
  trace::forEachColumn(none, [&header](const char* name, Cell kind, const auto&) {
    if (kind == Cell::former) return;
    if (!header.empty()) header += ',';
    header += name;
  });
  return header;
}

void appendTraceRow(std::string& text, const TraceRow& row) {
  const Flat flat = trace::flatten(row);
  bool first = true;
  trace::forEachColumn(flat, [&](const char*, Cell kind, const auto& value) {
    if (kind == Cell::former) return;
    if (!first) text += ',';
    first = false;
    if ((!flat.hasFrame && kind == Cell::frame) || (!flat.hasHold && kind == Cell::hold)) return;
    if constexpr (IsOptional<std::remove_cvref_t<decltype(value)>>::value) {
      if (value) print(text, *value);
    } else {
      print(text, value);
    }
  });
  text += '\n';
}

bool isTrace(std::string_view text) {
  const std::vector<std::string_view> names = cellsOf(takeLine(text));
  const auto has = [&names](std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return has("packet") && has("total_membership");
}

bool isTraceFile(const std::filesystem::path& file) {
  std::error_code error;
  // The content of a pipe could not be read again, and a device may have no line end.
  if (!std::filesystem::is_regular_file(file, error) || !checkIsData(file)) return false;
  constexpr std::size_t kLongestHeader = std::size_t{1} << 16;
  std::string header(kLongestHeader, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(header.data(), static_cast<std::streamsize>(header.size()));
  header.resize(static_cast<std::size_t>(in.gcount()));
  return isTrace(header);
}

Result<std::vector<TraceRow>> parseTrace(std::string_view text, const std::string& where) {
  Findings findings;
  const bool ends = text.empty() || text.back() == '\n';
  const std::string_view header = takeLine(text);
  const std::vector<std::size_t> places = placesOf(header, where, findings);
  if (!findings.empty()) return findings;
  const std::size_t columns = cellsOf(header).size();

  std::vector<TraceRow> rows;
  std::size_t lastLine = 1;
  for (std::size_t line = 2; !text.empty(); ++line) {
    const std::string_view content = takeLine(text);
    if (content.empty()) continue;
    lastLine = line;
    const std::vector<std::string_view> cells = cellsOf(content);
    const std::string place = where + ':' + std::to_string(line);
    if (cells.size() != columns) {
      if (findings.size() < kMostFindings)
        findings.push_back(
            {Severity::error, place, "", std::to_string(columns) + " columns", std::to_string(cells.size())});
      continue;
    }
    Flat flat;
    readCells(cells, places, place, flat, findings);
    rows.push_back(trace::unflatten(flat));
  }
  if (!findings.empty()) return findings;
  if (!ends)
    findings.push_back({Severity::warning, where + ':' + std::to_string(lastLine), "",
                        "a line end after the last row",
                        "none: the file may be cut short in its last number"});
  return {std::move(rows), std::move(findings)};
}

Result<std::vector<TraceRow>> readTrace(const std::filesystem::path& file) {
  return withinMemory(file, [&]() -> Result<std::vector<TraceRow>> {
    const Result<std::string> text = readWhole(file, kLargestRecording);
    if (!text) return text.findings();
    return parseTrace(*text, file.string());
  });
}

std::vector<TraceDifference> decideAgain(const std::vector<TraceRow>& trace,
                                         const ValidatedParameters& parameters) {
  std::vector<TraceDifference> differences;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    DecisionMemory memory = trace[i].before;
    const FrameDecision decided = decide(trace[i].input, parameters, memory);
    if (decided != trace[i].decision) differences.push_back({i, trace[i].decision, decided});
  }
  return differences;
}

}  // namespace trimtab
