#include "trace.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <type_traits>

namespace trimtab {
namespace {

constexpr std::size_t kMostFindings = 50;

// Cells as text. Numbers are written in the shortest form that reads back to the same bits.

template <class T>
void print(std::string& text, T number) {
  std::array<char, 32> cell;
  const auto end = std::to_chars(cell.data(), cell.data() + cell.size(), number).ptr;
  text.append(cell.data(), end);
}
template <class U>
void print(std::string& text, Quantity<U> quantity) {
  print(text, quantity.value());
}
void print(std::string& text, Scheme scheme) {
  text += toText(scheme);
}
void print(std::string& text, SchemeReason reason) {
  text += toText(reason);
}

/// What a cell may hold, for findings.
struct Expected {
  const char* what = "";
};

template <class T>
requires std::is_arithmetic_v<T>
bool parse(std::string_view cell, T& number, Expected& expected) {
  expected.what = std::is_floating_point_v<T> ? "a number" : "a whole number";
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
  return error == std::errc{} && end == cell.data() + cell.size();
}
template <class U>
bool parse(std::string_view cell, Quantity<U>& quantity, Expected& expected) {
  double number = 0;
  if (!parse(cell, number, expected)) return false;
  quantity = Quantity<U>{number};
  return true;
}

template <class Name>
bool parseName(std::string_view cell, Name& name, Name last) {
  for (int i = 0; i <= static_cast<int>(last); ++i) {
    if (toText(static_cast<Name>(i)) != cell) continue;
    name = static_cast<Name>(i);
    return true;
  }
  return false;
}
bool parse(std::string_view cell, Scheme& scheme, Expected& expected) {
  expected.what = "frustum or dynamic";
  return parseName(cell, scheme, Scheme::dynamic);
}
bool parse(std::string_view cell, SchemeReason& reason, Expected& expected) {
  expected.what = "the name of a reason";
  return parseName(cell, reason, SchemeReason::altitude_unknown);
}

/// A row as a flat list of cells. Groups that may be absent as a whole have a flag that their first cell
/// decides.
struct Flat {
  TraceRow row;
  Metres height;
  Feet altitude;  ///< for people and other programs; `height` is the number that counts
  std::optional<double> headHeading, headPitch, headRoll;
  HostView view;
  DepthMapSize depthMap;
  std::optional<int> depthMapWidth, depthMapHeight;
  TraceFrame frame;
  bool hasFrame = false;
};

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

/// Calls `visit(name, required, cell)` for each column in the file's order: the one list that header, writer
/// and reader share.
template <class F, class Visit>
void forEachColumn(F& f, const Visit& visit) {
  auto& state = f.row.input.state;
  visit("time_s", true, state.time);
  visit("latitude_deg", true, state.position.latitude);
  visit("longitude_deg", true, state.position.longitude);
  visit("altitude_ft", false, f.altitude);
  visit("pitch_deg", true, state.attitude.pitch);
  visit("roll_deg", true, state.attitude.roll);
  visit("heading_deg", true, state.attitude.heading);
  visit("head_heading_deg", false, f.headHeading);
  visit("head_pitch_deg", false, f.headPitch);

  visit("packet", true, state.packet);
  visit("height_m", true, f.height);
  visit("above_ground_m", false, f.row.input.aboveGround);
  visit("head_roll_deg", false, f.headRoll);
  visit("visibility_m", false, state.visibility);
  visit("view_near_m", false, f.view.nearDistance);
  visit("view_left_deg", false, f.view.left);
  visit("view_right_deg", false, f.view.right);
  visit("view_bottom_deg", false, f.view.bottom);
  visit("view_top_deg", false, f.view.top);
  visit("band_before", false, f.row.before.band);
  auto& last = f.row.input.lastCost;
  visit("last_decide_ms", false, last.decide);
  visit("last_select_ms", false, last.select);
  visit("last_occlusion_ms", false, last.occlusion);
  visit("last_cull_ms", false, last.cull);
  visit("last_draw_ms", false, last.draw);
  visit("last_gpu_ms", false, last.gpu);
  visit("last_total_ms", false, last.total);

  auto& d = f.row.decision;
  visit("decision_altitude_ft", true, d.altitudeFt);
  visit("decision_pitch_deg", true, d.pitchDeg);
  visit("altitude_membership", true, d.altitudeMembership);
  visit("pitch_membership", true, d.pitchMembership);
  visit("total_membership", true, d.totalMembership);
  visit("rule_low_down", true, d.ruleFiring[0]);
  visit("rule_low_up", true, d.ruleFiring[1]);
  visit("rule_high_down", true, d.ruleFiring[2]);
  visit("rule_high_up", true, d.ruleFiring[3]);
  visit("scheme", true, d.scheme);
  visit("band", true, d.band);
  visit("depth_map_width_px", false, f.depthMapWidth);
  visit("depth_map_height_px", false, f.depthMapHeight);
  visit("reason", true, d.reason);
  visit("lod_scale", true, d.lodScale);

  visit("triangles", false, f.frame.counts.triangles);
  visit("vertices", false, f.frame.counts.vertices);
  visit("tiles_drawn", false, f.frame.counts.tilesDrawn);
  visit("culled_frustum", false, f.frame.counts.culledFrustum);
  visit("culled_occluded", false, f.frame.counts.culledOccluded);
  auto& cost = f.frame.cost;
  visit("decide_ms", false, cost.decide);
  visit("select_ms", false, cost.select);
  visit("occlusion_ms", false, cost.occlusion);
  visit("cull_ms", false, cost.cull);
  visit("draw_ms", false, cost.draw);
  visit("gpu_ms", false, cost.gpu);
  visit("total_ms", false, cost.total);
}

bool isFrameColumn(const void* cell, const Flat& flat) {
  const auto* begin = reinterpret_cast<const char*>(&flat.frame);
  const auto* at = static_cast<const char*>(cell);
  return at >= begin && at < begin + sizeof flat.frame;
}

Flat flatten(const TraceRow& row) {
  Flat f;
  f.row = row;
  const AircraftState& state = row.input.state;
  f.height = state.position.height;
  f.altitude = f.height.as<Feet>();
  if (!f.row.input.aboveGround) f.row.input.aboveGround = state.aboveGround;
  if (state.head) {
    f.headHeading = state.head->heading.value();
    f.headPitch = state.head->pitch.value();
    f.headRoll = state.head->roll.value();
  }
  if (state.view) f.view = *state.view;
  if (row.decision.depthMap) {
    f.depthMapWidth = row.decision.depthMap->widthPx;
    f.depthMapHeight = row.decision.depthMap->heightPx;
  }
  f.hasFrame = row.frame.has_value();
  if (row.frame) f.frame = *row.frame;
  return f;
}

TraceRow unflatten(Flat& f) {
  AircraftState& state = f.row.input.state;
  state.position.height = f.height;
  state.aboveGround = f.row.input.aboveGround;
  if (f.headHeading || f.headPitch || f.headRoll)
    state.head = Attitude{Degrees{f.headHeading.value_or(0)}, Degrees{f.headPitch.value_or(0)},
                          Degrees{f.headRoll.value_or(0)}};
  if (f.view != HostView{}) state.view = f.view;
  if (f.depthMapWidth && f.depthMapHeight)
    f.row.decision.depthMap = DepthMapSize{*f.depthMapWidth, *f.depthMapHeight};
  if (f.hasFrame) f.row.frame = f.frame;
  return f.row;
}

std::vector<std::string_view> cellsOf(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

/// Takes one line off `text`, without its line end (either kind).
std::string_view takeLine(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

/// Where in a line each known column stands, in the order of forEachColumn; kAbsent where the file lacks it.
std::vector<std::size_t> placesOf(std::string_view header, const std::string& where, Findings& findings) {
  const std::vector<std::string_view> names = cellsOf(header);
  std::vector<std::size_t> places;
  Flat none;
  forEachColumn(none, [&](const char* name, bool required, const auto&) {
    std::size_t place = kAbsent;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (names[i] == name) place = i;
    if (place == kAbsent && required)
      findings.push_back({Severity::error, where + ":1", name, "this column", "no such column"});
    places.push_back(place);
  });
  return places;
}

/// Reads one line into `flat`; bad cells become findings.
void readCells(const std::vector<std::string_view>& cells, const std::vector<std::size_t>& places,
               const std::string& where, Flat& flat, Findings& findings) {
  std::size_t column = 0;
  forEachColumn(flat, [&](const char* name, bool required, auto& value) {
    const std::size_t place = places[column++];
    const std::string_view cell = place < cells.size() ? cells[place] : std::string_view{};
    Expected expected;
    bool good = true;
    if (cell.empty()) {
      good = !required;
      expected.what = "a value";
    } else if constexpr (IsOptional<std::remove_reference_t<decltype(value)>>::value) {
      good = parse(cell, value.emplace(), expected);
    } else {
      good = parse(cell, value, expected);
    }
    if (!cell.empty() && isFrameColumn(&value, flat)) flat.hasFrame = true;
    if (!good && findings.size() < kMostFindings)
      findings.push_back({Severity::error, where, name, expected.what,
                          cell.empty() ? "nothing" : '"' + std::string(cell.substr(0, 40)) + '"'});
  });
}

}  // namespace

std::string_view toText(Scheme scheme) {
  return scheme == Scheme::dynamic ? "dynamic" : "frustum";
}

std::string_view toText(SchemeReason reason) {
  switch (reason) {
    case SchemeReason::below_first_band:
      return "below_first_band";
    case SchemeReason::in_band:
      return "in_band";
    case SchemeReason::held_by_hysteresis:
      return "held_by_hysteresis";
    case SchemeReason::no_rule_fires:
      return "no_rule_fires";
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
  forEachColumn(none, [&header](const char* name, bool, const auto&) {
    if (!header.empty()) header += ',';
    header += name;
  });
  return header;
}

void appendTraceRow(std::string& text, const TraceRow& row) {
  const Flat flat = flatten(row);
  bool first = true;
  forEachColumn(flat, [&](const char*, bool, const auto& value) {
    if (!first) text += ',';
    first = false;
    if (!flat.hasFrame && isFrameColumn(&value, flat)) return;
    if constexpr (IsOptional<std::remove_cvref_t<decltype(value)>>::value) {
      if (value) print(text, *value);
    } else {
      print(text, value);
    }
  });
  text += '\n';
}

TraceWriter::TraceWriter(std::filesystem::path file, std::ofstream stream)
    : file_(std::move(file)), stream_(std::move(stream)) {}

Result<TraceWriter> TraceWriter::open(const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  if (!stream)
    return Finding{Severity::error, file.string(), "", "a file that can be written", "it cannot be opened"};
  stream << traceHeader() << '\n';
  return TraceWriter(file, std::move(stream));
}

void TraceWriter::write(const TraceRow& row) {
  line_.clear();
  appendTraceRow(line_, row);
  stream_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
  stream_.flush();
}

Result<Done> TraceWriter::close() {
  stream_.close();
  if (stream_) return Done{};
  return Finding{Severity::error, file_.string(), "", "room for the whole trace", "writing failed"};
}

bool isTrace(std::string_view text) {
  const std::vector<std::string_view> names = cellsOf(takeLine(text));
  const auto has = [&names](std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return has("packet") && has("total_membership");
}

Result<std::vector<TraceRow>> parseTrace(std::string_view text, const std::string& where) {
  Findings findings;
  const std::string_view header = takeLine(text);
  const std::vector<std::size_t> places = placesOf(header, where, findings);
  if (!findings.empty()) return findings;
  const std::size_t columns = cellsOf(header).size();

  std::vector<TraceRow> rows;
  for (std::size_t line = 2; !text.empty(); ++line) {
    const std::string_view content = takeLine(text);
    if (content.empty()) continue;
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
    rows.push_back(unflatten(flat));
  }
  if (!findings.empty()) return findings;
  return rows;
}

Result<std::vector<TraceRow>> readTrace(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (!in.is_open() || in.bad())
    return Finding{Severity::error, file.string(), "", "a trace that can be read", "it cannot be opened"};
  return parseTrace(text, file.string());
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
