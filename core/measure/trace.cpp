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

/// Whether a cell may be empty; cells of the frame are all empty where no frame showed the decision.
enum class Cell { required, optional, frame };

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

/// Calls `visit(name, cell, value)` for each column in the file's order: the one list that header, writer
/// and reader share.
template <class F, class Visit>
void forEachColumn(F& f, const Visit& visit) {
  auto& state = f.row.input.state;
  visit("time_s", Cell::required, state.time);
  visit("latitude_deg", Cell::required, state.position.latitude);
  visit("longitude_deg", Cell::required, state.position.longitude);
  visit("altitude_ft", Cell::optional, f.altitude);
  visit("pitch_deg", Cell::required, state.attitude.pitch);
  visit("roll_deg", Cell::required, state.attitude.roll);
  visit("heading_deg", Cell::required, state.attitude.heading);
  visit("head_heading_deg", Cell::optional, f.headHeading);
  visit("head_pitch_deg", Cell::optional, f.headPitch);

  visit("packet", Cell::required, state.packet);
  visit("height_m", Cell::required, f.height);
  visit("above_ground_m", Cell::optional, f.row.input.aboveGround);
  visit("head_roll_deg", Cell::optional, f.headRoll);
  visit("visibility_m", Cell::optional, state.visibility);
  visit("view_near_m", Cell::optional, f.view.nearDistance);
  visit("view_left_deg", Cell::optional, f.view.left);
  visit("view_right_deg", Cell::optional, f.view.right);
  visit("view_bottom_deg", Cell::optional, f.view.bottom);
  visit("view_top_deg", Cell::optional, f.view.top);
  visit("band_before", Cell::optional, f.row.before.band);
  auto& last = f.row.input.lastCost;
  visit("last_decide_ms", Cell::optional, last.decide);
  visit("last_select_ms", Cell::optional, last.select);
  visit("last_occlusion_ms", Cell::optional, last.occlusion);
  visit("last_cull_ms", Cell::optional, last.cull);
  visit("last_draw_ms", Cell::optional, last.draw);
  visit("last_gpu_ms", Cell::optional, last.gpu);
  visit("last_total_ms", Cell::optional, last.total);

  auto& d = f.row.decision;
  visit("decision_altitude_ft", Cell::required, d.altitudeFt);
  visit("decision_pitch_deg", Cell::required, d.pitchDeg);
  visit("altitude_membership", Cell::required, d.altitudeMembership);
  visit("pitch_membership", Cell::required, d.pitchMembership);
  visit("total_membership", Cell::required, d.totalMembership);
  visit("rule_low_down", Cell::required, d.ruleFiring[0]);
  visit("rule_low_up", Cell::required, d.ruleFiring[1]);
  visit("rule_high_down", Cell::required, d.ruleFiring[2]);
  visit("rule_high_up", Cell::required, d.ruleFiring[3]);
  visit("scheme", Cell::required, d.scheme);
  visit("band", Cell::required, d.band);
  visit("depth_map_width_px", Cell::optional, f.depthMapWidth);
  visit("depth_map_height_px", Cell::optional, f.depthMapHeight);
  visit("reason", Cell::required, d.reason);
  visit("lod_scale", Cell::required, d.lodScale);

  visit("triangles", Cell::frame, f.frame.counts.triangles);
  visit("vertices", Cell::frame, f.frame.counts.vertices);
  visit("tiles_drawn", Cell::frame, f.frame.counts.tilesDrawn);
  visit("culled_frustum", Cell::frame, f.frame.counts.culledFrustum);
  visit("culled_occluded", Cell::frame, f.frame.counts.culledOccluded);
  auto& cost = f.frame.cost;
  visit("decide_ms", Cell::frame, cost.decide);
  visit("select_ms", Cell::frame, cost.select);
  visit("occlusion_ms", Cell::frame, cost.occlusion);
  visit("cull_ms", Cell::frame, cost.cull);
  visit("draw_ms", Cell::frame, cost.draw);
  visit("gpu_ms", Cell::frame, cost.gpu);
  visit("total_ms", Cell::frame, cost.total);
}

Flat flatten(const TraceRow& row) {
  Flat f;
  f.row = row;
  const AircraftState& state = row.input.state;
  f.height = state.position.height;
  f.altitude = Feet{f.height.value() / unit::Foot::size};
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
  forEachColumn(none, [&](const char* name, Cell kind, const auto&) {
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
  forEachColumn(flat, [&](const char* name, Cell kind, auto& value) {
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
  forEachColumn(none, [&header](const char* name, Cell, const auto&) {
    if (!header.empty()) header += ',';
    header += name;
  });
  return header;
}

void appendTraceRow(std::string& text, const TraceRow& row) {
  const Flat flat = flatten(row);
  bool first = true;
  forEachColumn(flat, [&](const char*, Cell kind, const auto& value) {
    if (!first) text += ',';
    first = false;
    if (!flat.hasFrame && kind == Cell::frame) return;
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
