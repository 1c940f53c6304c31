#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "flight_notes.h"
#include "limits.h"
#include "trimtab/host/flight.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

enum Column : std::size_t {
  kTime,
  kLatitude,
  kLongitude,
  kAltitudeFt,
  kHeightM,
  kPitch,
  kRoll,
  kHeading,
  kPacket,
  kHeadHeading,
  kHeadPitch,
  kHeadRoll,
  kAboveGround,
  kVisibility,
  kPrecipitation,
  kSeverity,
  kLayerVisibility,
  kWindSpeed,
  kWindFrom,
  kWindUp,
  kViewNear,
  kViewLeft,
  kViewRight,
  kViewBottom,
  kViewTop,
  kColumns
};

struct ColumnRule {
  const char* name;
  double lowest, highest;
  bool required;
};

constexpr double kAny = 1e15;
constexpr double kHalf = 89.9;  // half-angles of a view; a quarter turn has no picture plane
constexpr std::array<ColumnRule, kColumns> kRules{{
    {"time_s", -kAny, kAny, false},
    {"latitude_deg", -90, 90, true},
    {"longitude_deg", -180, 180, true},
    {"altitude_ft", -66000, 3.3e6, true},
    {"height_m", limits::kLowest, limits::kHighest, false},
    {"pitch_deg", -90, 90, true},
    {"roll_deg", -360, 360, true},
    {"heading_deg", -360, 360, true},
    {"packet", 0, 9007199254740992.0, false},
    {"head_heading_deg", -360, 360, false},
    {"head_pitch_deg", -90, 90, false},
    {"head_roll_deg", -360, 360, false},
    {"above_ground_m", -limits::kHighest, limits::kHighest, false},
    {"visibility_m", 0, limits::kVisibility, false},
    {"precipitation", 0, 0, false},  // none, rain or snow
    {"precipitation_severity", 0, HostWeather::kMostSevere, false},
    {"precipitation_visibility_m", 0, limits::kVisibility, false},
    {"wind_speed_mps", 0, 200, false},
    {"wind_from_deg", -360, 360, false},
    {"wind_up_mps", -200, 200, false},
    {"view_near_m", 1e-6, limits::kHighest, false},
    {"view_left_deg", -kHalf, kHalf, false},
    {"view_right_deg", -kHalf, kHalf, false},
    {"view_bottom_deg", -kHalf, kHalf, false},
    {"view_top_deg", -kHalf, kHalf, false},
}};

/// Cells of a line; quotes hold commas together and are taken off.
void split(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  bool quoted = false;
  std::size_t from = 0;
  const auto add = [&](std::size_t to) {
    std::string_view cell = trimmed(line.substr(from, to - from));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    cells.push_back(cell);
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] != ',' || quoted) continue;
    add(i);
    from = i + 1;
  }
  add(line.size());
}

/// FlightGear writes latitude-deg where we write latitude_deg.
std::string columnName(std::string_view cell) {
  std::string name(cell);
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (c == '-') c = '_';
  }
  return name;
}

class Parser {
 public:
  Parser(std::string_view text, std::string where, double stepS)
      : text_(text), where_(std::move(where)), step_(stepS) {}

  Result<Flight> parse();

 private:
  bool nextLine(std::string_view& line);
  bool readHeader();
  void readRow(std::string_view line);
  std::optional<double> cell(Column column);
  std::optional<HostWeather> weather();
  void refuse(std::string key, std::string expected, std::string found);
  std::string place() const { return where_ + ':' + std::to_string(line_); }
  bool has(Column column) const { return at_[column].has_value(); }

  std::string_view text_;
  std::string where_;
  double step_;
  std::size_t line_ = 0, columns_ = 0, errors_ = 0, row_ = 0;
  std::array<std::optional<std::size_t>, kColumns> at_;
  std::vector<std::string_view> cells_;
  Flight flight_;
  Findings findings_;
  std::size_t dropped_ = 0, firstDropped_ = 0, lastDropped_ = 0;
  std::size_t lastLine_ = 0;
  bool lastLineEnds_ = true;
};

void Parser::refuse(std::string key, std::string expected, std::string found) {
  constexpr std::size_t kMost = 50;
  if (++errors_ <= kMost)
    findings_.push_back({Severity::error, place(), std::move(key), std::move(expected), std::move(found)});
}

bool Parser::nextLine(std::string_view& line) {
  while (!text_.empty()) {
    ++line_;
    const std::size_t end = text_.find('\n');
    line = trimmed(text_.substr(0, end));
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    if (line.empty() || line.front() == '#') continue;
    lastLine_ = line_;
    lastLineEnds_ = end != std::string_view::npos;
    return true;
  }
  return false;
}

bool Parser::readHeader() {
  text_ = withoutByteOrderMark(text_);
  std::string_view line;
  if (!nextLine(line)) {
    refuse("", "a header that names the columns", "an empty file");
    return false;
  }
  split(line, cells_);
  columns_ = cells_.size();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const std::string name = columnName(cells_[i]);
    for (std::size_t c = 0; c < kColumns; ++c) {
      if (name != kRules[c].name) continue;
      if (at_[c]) refuse(name, "one column of this name", "two");
      at_[c] = i;
    }
  }
  for (std::size_t c = 0; c < kColumns; ++c) {
    const bool elsewhere = c == kAltitudeFt && has(kHeightM);
    if (kRules[c].required && !at_[c] && !elsewhere)
      refuse(kRules[c].name, "a column of this name", "none in the header");
  }
  if (has(kHeadHeading) != has(kHeadPitch))
    refuse(has(kHeadHeading) ? "head_pitch_deg" : "head_heading_deg", "both head columns", "one alone");
  return errors_ == 0;
}

std::optional<double> Parser::cell(Column column) {
  if (!at_[column]) return std::nullopt;
  const ColumnRule& rule = kRules[column];
  const std::string_view text = cells_[*at_[column]];
  const bool mayBeEmpty = !rule.required && column != kTime && column != kHeightM;
  if (text.empty() && mayBeEmpty) return std::nullopt;
  const auto value = readNumber(text);
  if (value && *value >= rule.lowest && *value <= rule.highest) return value;
  const std::string found = text.empty() ? "nothing" : std::string(text.substr(0, 40));
  refuse(rule.name, "a number in " + numberText(rule.lowest) + ".." + numberText(rule.highest), found);
  return std::nullopt;
}

std::optional<HostWeather> Parser::weather() {
  const auto severity = cell(kSeverity), visibility = cell(kLayerVisibility);
  const std::string_view name = at_[kPrecipitation] ? cells_[*at_[kPrecipitation]] : std::string_view();
  if (name.empty()) {
    if (severity || visibility) refuse("precipitation", "none, rain or snow beside a severity", "nothing");
    return std::nullopt;
  }
  for (const Precipitation kind : {Precipitation::none, Precipitation::rain, Precipitation::snow}) {
    if (name != toText(kind)) continue;
    HostWeather weather{kind, static_cast<int>(severity.value_or(0)), std::nullopt};
    if (kind != Precipitation::none && !severity)
      refuse("precipitation_severity", "a severity of 0..5 beside rain or snow", "nothing");
    else if (severity && *severity != weather.severity)
      refuse("precipitation_severity", "a whole number", numberText(*severity));
    if (visibility) weather.visibility = Metres{*visibility};
    return weather;
  }
  refuse("precipitation", "none, rain or snow", std::string(name.substr(0, 40)));
  return std::nullopt;
}

void Parser::readRow(std::string_view line) {
  split(line, cells_);
  if (cells_.size() != columns_) {
    refuse("", std::to_string(columns_) + " cells, as the header", std::to_string(cells_.size()));
    return;
  }
  const std::size_t row = row_++;
  const std::size_t errorsBefore = errors_;
  const auto altitude = cell(kAltitudeFt), exact = cell(kHeightM);
  AircraftState state;
  if (exact)
    state.position.height = Metres{*exact};
  else if (altitude)
    state.position.height = Feet{*altitude}.as<Metres>();
  if (state.position.height.value() < limits::kReady) {
    if (dropped_++ == 0) firstDropped_ = line_;
    lastDropped_ = line_;
    return;
  }
  const auto degrees = [this](Column c) { return Degrees{cell(c).value_or(0)}; };
  const auto optional = [this]<class Q>(Column c, std::optional<Q>& value) {
    if (const auto number = cell(c)) value = Q{*number};
  };
  state.time = cell(kTime).value_or(static_cast<double>(row));
  state.packet =
      static_cast<std::uint64_t>(cell(kPacket).value_or(static_cast<double>(flight_.states.size())));
  state.position.latitude = degrees(kLatitude);
  state.position.longitude = degrees(kLongitude);
  state.attitude = {degrees(kHeading), degrees(kPitch), degrees(kRoll)};
  const auto headHeading = cell(kHeadHeading), headPitch = cell(kHeadPitch), headRoll = cell(kHeadRoll);
  if (headHeading && headPitch)
    state.head = {Degrees{*headHeading}, Degrees{*headPitch}, Degrees{headRoll.value_or(0)}};
  optional(kAboveGround, state.aboveGround);
  optional(kVisibility, state.visibility);
  state.weather = weather();
  if (const auto speed = cell(kWindSpeed)) {
    const double from = cell(kWindFrom).value_or(0), up = cell(kWindUp).value_or(0);
    state.wind = Wind{MetresPerSecond{*speed}, wrapped360(Degrees{from}), MetresPerSecond{up}};
  }
  HostView view;
  optional(kViewNear, view.nearDistance);
  optional(kViewLeft, view.left);
  optional(kViewRight, view.right);
  optional(kViewBottom, view.bottom);
  optional(kViewTop, view.top);
  if (view != HostView{}) state.view = view;
  if (!flight_.states.empty() && has(kTime) && state.time < flight_.states.back().time)
    refuse("time_s", "not before the row above, at " + numberText(flight_.states.back().time),
           numberText(state.time));
  if (errors_ == errorsBefore) flight_.states.push_back(state);
}

Result<Flight> Parser::parse() {
  if (!(step_ > 0))
    return Finding{Severity::error, where_, "step", "a time above 0 s between rows", numberText(step_)};
  if (text_.substr(0, 4096).find('\0') != std::string_view::npos)
    return Finding{Severity::error, where_, "", "text: a CSV file with a header", "binary data"};
  if (!readHeader()) return std::move(findings_);
  std::string_view line;
  while (nextLine(line)) readRow(line);
  if (errors_ > findings_.size())
    findings_.push_back(
        {Severity::error, where_, "", "", std::to_string(errors_ - findings_.size()) + " more errors"});
  if (errors_ > 0) return std::move(findings_);
  // A file cut inside its last number reads well, as another number.
  if (!lastLineEnds_)
    findings_.push_back({Severity::warning, where_ + ':' + std::to_string(lastLine_), "",
                         "a line end after the last row",
                         "none: the file may be cut short in its last number"});
  if (dropped_ > 0)
    findings_.push_back({Severity::note, where_, "altitude_ft", "",
                         std::to_string(dropped_) + " rows below -1000 ft (lines " +
                             std::to_string(firstDropped_) + " to " + std::to_string(lastDropped_) +
                             "): the simulator was not ready; dropped"});
  if (flight_.states.empty()) {
    findings_.push_back({Severity::error, where_, "", "at least one row of a flight", "none"});
    return std::move(findings_);
  }
  if (!has(kTime)) {
    // Rows that were dropped took their time before the flight began; until here, a row's number is its time.
    const double begin = flight_.states.front().time;
    for (AircraftState& state : flight_.states) state.time = (state.time - begin) * step_;
    findings_.push_back({Severity::note, where_, "time_s", "",
                         "no such column: rows are taken as " + numberText(step_) + " s apart"});
  }
  appendMotionNotes(flight_, where_, findings_);
  return {std::move(flight_), std::move(findings_)};
}

void append(std::string& text, std::optional<double> value) {
  text += ',';
  if (value) text += numberText(*value);
}

template <class Q>
void append(std::string& text, const std::optional<Q>& quantity) {
  append(text, quantity ? std::optional(quantity->value()) : std::nullopt);
}

}  // namespace

Result<Flight> parseFlightCsv(std::string_view text, const std::string& where, double defaultStepS) {
  return Parser(text, where, defaultStepS).parse();
}

std::string flightCsv(const Flight& flight) {
  bool packets = false, heads = false, grounds = false, visibilities = false, weathers = false, views = false,
       winds = false;
  for (std::size_t i = 0; i < flight.states.size(); ++i) {
    const AircraftState& s = flight.states[i];
    packets |= s.packet != i;
    heads |= s.head.has_value();
    grounds |= s.aboveGround.has_value();
    visibilities |= s.visibility.has_value();
    weathers |= s.weather.has_value();
    winds |= s.wind.has_value();
    views |= s.view.has_value();
  }
  std::string text = "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg,height_m";
  if (packets) text += ",packet";
  if (heads) text += ",head_heading_deg,head_pitch_deg,head_roll_deg";
  if (grounds) text += ",above_ground_m";
  if (visibilities) text += ",visibility_m";
  if (weathers) text += ",precipitation,precipitation_severity,precipitation_visibility_m";
  if (winds) text += ",wind_speed_mps,wind_from_deg,wind_up_mps";
  if (views) text += ",view_near_m,view_left_deg,view_right_deg,view_bottom_deg,view_top_deg";
  text += '\n';
  text.reserve(text.size() + flight.states.size() * 160);
  for (const AircraftState& s : flight.states) {
    text += numberText(s.time);
    append(text, s.position.latitude.value());
    append(text, s.position.longitude.value());
    append(text, s.position.height.in<Feet>());
    append(text, s.attitude.pitch.value());
    append(text, s.attitude.roll.value());
    append(text, s.attitude.heading.value());
    append(text, s.position.height.value());
    if (packets) text += ',' + std::to_string(s.packet);
    if (heads) {
      append(text, s.head ? std::optional(s.head->heading) : std::nullopt);
      append(text, s.head ? std::optional(s.head->pitch) : std::nullopt);
      append(text, s.head ? std::optional(s.head->roll) : std::nullopt);
    }
    if (grounds) append(text, s.aboveGround);
    if (visibilities) append(text, s.visibility);
    if (weathers) {
      text += ',';
      if (s.weather) text += toText(s.weather->precipitation);
      append(text, s.weather ? std::optional(double(s.weather->severity)) : std::nullopt);
      append(text, s.weather ? s.weather->visibility : std::nullopt);
    }
    if (winds) {
      append(text, s.wind ? std::optional(s.wind->speed) : std::nullopt);
      append(text, s.wind ? std::optional(s.wind->from) : std::nullopt);
      append(text, s.wind ? std::optional(s.wind->up) : std::nullopt);
    }
    if (views) {
      const HostView view = s.view.value_or(HostView{});
      append(text, view.nearDistance);
      append(text, view.left);
      append(text, view.right);
      append(text, view.bottom);
      append(text, view.top);
    }
    text += '\n';
  }
  return text;
}

}  // namespace trimtab
