#include <algorithm>
#include <cmath>
#include <optional>

#include "core/host/flight_notes.h"
#include "core/host/limits.h"
#include "flight_columns.h"
#include "log_angles.h"
#include "log_time.h"
#include "track.h"
#include "track_file.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/motion.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

/// Flights have 500 rows a second to one in ten minutes, and move at 10 to 1,500 m/s unless they rest.
constexpr LogMotion kFlightMotion{0.002, 600, 10, 1500};

/// Counts rows, and remembers on which lines the first and the last of them are.
struct RowCount {
  std::size_t rows = 0, first = 0, last = 0;

  void add(std::size_t line) {
    if (rows++ == 0) first = line;
    last = line;
  }
  std::string text() const { return std::to_string(rows) + (rows == 1 ? " row" : " rows"); }
  std::string lines() const {
    return " (lines " + std::to_string(first) + " to " + std::to_string(last) + ')';
  }
};

class Parser {
 public:
  Parser(std::string_view text, const std::string& where, double stepS, const ColumnMap& map)
      : table_(text, where), where_(where), step_(stepS), map_(map) {}

  Result<Flight> parse();

 private:
  void readRow();
  double readTime(std::size_t row);
  bool positionUnknown() const;
  std::optional<double> cell(FlightQuantity quantity);
  std::optional<HostWeather> weather();
  std::optional<HostView> view();
  void refuseAt(std::string place, std::string key, std::string expected, std::string found);
  void refuse(std::string key, std::string expected, std::string found) {
    refuseAt(table_.place(), std::move(key), std::move(expected), std::move(found));
  }
  void note(std::string key, std::string text) {
    findings_.push_back({Severity::note, where_, std::move(key), "", std::move(text)});
  }
  bool has(FlightQuantity quantity) const { return columns_.has(quantity); }
  std::string_view cellText(FlightQuantity quantity) const {
    return has(quantity) ? columns_.at[quantity]->cell(table_.cells()) : std::string_view();
  }
  void wrapLongitudes();
  void findAngleUnit();
  void findTimes();
  Findings refused();

  DelimitedText table_;
  std::string where_;
  double step_;
  const ColumnMap& map_;
  FlightColumns columns_;
  std::size_t errors_ = 0, row_ = 0;
  Flight flight_;
  Findings findings_, eastOf180_;
  RowCount notReady_, unknown_;
  double lowestLongitude_ = 0, days_ = 0;
  bool clock_ = false;
};

void Parser::refuseAt(std::string place, std::string key, std::string expected, std::string found) {
  constexpr std::size_t kMost = 50;
  if (++errors_ <= kMost)
    findings_.push_back(
        {Severity::error, std::move(place), std::move(key), std::move(expected), std::move(found)});
}

std::optional<double> Parser::cell(FlightQuantity quantity) {
  if (!has(quantity)) return std::nullopt;
  const FlightQuantityRow& rule = flightQuantity(quantity);
  const LogColumn& column = *columns_.at[quantity];
  const std::string_view text = cellText(quantity);
  const bool mayBeEmpty = !rule.required && quantity != kHeightM;
  if (text.empty() && mayBeEmpty) return std::nullopt;
  auto value = table_.number(text);
  if (value) value = column.quantity(*value);
  if (value && column.unit == Unit::radians) value = Radians{*value}.in<Degrees>();
  const double highest = quantity == kLongitude ? 360 : rule.highest;
  if (value && *value >= rule.lowest && *value <= highest) return value;
  refuse(rule.name, "a number in " + numberText(rule.lowest) + ".." + numberText(rule.highest),
         text.empty() ? "nothing" : std::string(text.substr(0, 40)));
  return std::nullopt;
}

/// Reads a number or a clock, as the first row has it. A clock that begins again at midnight goes on.
double Parser::readTime(std::size_t row) {
  if (!has(kTime)) return static_cast<double>(row);
  const LogColumn& column = *columns_.at[kTime];
  const std::string_view text = cellText(kTime);
  auto value = table_.number(text);
  if (!value && flight_.states.empty()) clock_ = readClock(text).has_value();
  if (clock_)
    value = readClock(text);
  else if (value)
    value = column.quantity(*value);
  const double most = column.unit == Unit::seconds ? flightQuantity(kTime).highest : kLargestTime;
  if (!value || !(std::abs(*value) <= most)) {
    refuse("time_s",
           clock_ ? "a time of a clock, as in the rows above" : "a number, a date with a time or hh:mm:ss",
           text.empty() ? "nothing" : std::string(text.substr(0, 40)));
    return 0;
  }
  double time = *value + days_;
  if (flight_.states.empty() || time >= flight_.states.back().time) return time;
  const double last = flight_.states.back().time;
  const bool seconds = clock_ || column.unit == Unit::seconds || column.unit == Unit::none;
  const double day = seconds ? dayAfter(last, time) : 0;
  if (day > 0 && days_ == 0)
    note("time_s", "line " + std::to_string(table_.line()) + " comes after midnight: times go on from there");
  if (day == 0) refuse("time_s", "not before the row above, at " + numberText(last), numberText(time));
  days_ += day;
  return time + day;
}

/// Loggers write nothing, or nan, until they know where they are.
bool Parser::positionUnknown() const {
  const auto unknown = [this](FlightQuantity quantity) {
    if (!has(quantity)) return true;
    const std::string_view text = cellText(quantity);
    const auto value = table_.number(text);
    return text.empty() || (value && std::isnan(*value));
  };
  return unknown(kLatitude) && unknown(kLongitude) && unknown(kAltitudeFt) && unknown(kHeightM);
}

std::optional<HostWeather> Parser::weather() {
  const auto severity = cell(kSeverity), visibility = cell(kLayerVisibility);
  const std::string_view name = cellText(kPrecipitation);
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

std::optional<HostView> Parser::view() {
  HostView view;
  const auto optional = [this]<class Q>(FlightQuantity quantity, std::optional<Q>& value) {
    if (const auto number = cell(quantity)) value = Q{*number};
  };
  optional(kViewNear, view.nearDistance);
  optional(kViewLeft, view.left);
  optional(kViewRight, view.right);
  optional(kViewBottom, view.bottom);
  optional(kViewTop, view.top);
  if (view == HostView{}) return std::nullopt;
  return view;
}

void Parser::readRow() {
  if (!table_.rowFits()) {
    refuse("", std::to_string(table_.header().size()) + " cells, as the header",
           std::to_string(table_.cells().size()));
    return;
  }
  const std::size_t row = row_++;
  if (positionUnknown()) return unknown_.add(table_.line());
  const std::size_t errorsBefore = errors_;
  const auto altitude = cell(kAltitudeFt), exact = cell(kHeightM);
  AircraftState state;
  if (exact)
    state.position.height = Metres{*exact};
  else if (altitude)
    state.position.height = Feet{*altitude}.as<Metres>();
  if (state.position.height.value() < limits::kReady) return notReady_.add(table_.line());
  const auto degrees = [this](FlightQuantity q) { return Degrees{cell(q).value_or(0)}; };
  state.time = readTime(row);
  state.packet =
      static_cast<std::uint64_t>(cell(kPacket).value_or(static_cast<double>(flight_.states.size())));
  state.position.latitude = degrees(kLatitude);
  state.position.longitude = degrees(kLongitude);
  state.attitude = {degrees(kHeading), degrees(kPitch), degrees(kRoll)};
  const auto headHeading = cell(kHeadHeading), headPitch = cell(kHeadPitch), headRoll = cell(kHeadRoll);
  if (headHeading && headPitch)
    state.head = {Degrees{*headHeading}, Degrees{*headPitch}, Degrees{headRoll.value_or(0)}};
  if (const auto ground = cell(kAboveGround)) state.aboveGround = Metres{*ground};
  if (const auto visibility = cell(kVisibility)) state.visibility = Metres{*visibility};
  state.weather = weather();
  if (const auto speed = cell(kWindSpeed)) {
    const double from = cell(kWindFrom).value_or(0), up = cell(kWindUp).value_or(0);
    state.wind = Wind{MetresPerSecond{*speed}, wrapped360(Degrees{from}), MetresPerSecond{up}};
  }
  state.view = view();
  const double longitude = state.position.longitude.value();
  lowestLongitude_ = std::min(lowestLongitude_, longitude);
  constexpr std::size_t kMost = 10;
  if (longitude > 180 && eastOf180_.size() < kMost)
    eastOf180_.push_back(
        {Severity::error, table_.place(), "longitude_deg", "a number in -180..180", numberText(longitude)});
  if (errors_ == errorsBefore) flight_.states.push_back(state);
}

/// Longitudes of 0 to 360 are as good as those of -180 to 180; a mixture is an error.
void Parser::wrapLongitudes() {
  if (eastOf180_.empty()) return;
  if (lowestLongitude_ < 0) {
    for (Finding& finding : eastOf180_) refuseAt(finding.where, finding.key, finding.expected, finding.found);
    return;
  }
  for (AircraftState& state : flight_.states) {
    Degrees& longitude = state.position.longitude;
    if (longitude.value() > 180) longitude = longitude - Degrees{360};
  }
  note("longitude_deg", "longitudes run from 0 to 360: those above 180 are read as west");
}

/// Angles of the attitude that name no unit: a heading shows it where it follows the track.
void Parser::findAngleUnit() {
  UnnamedAngles angles;
  std::vector<Degrees Attitude::*> members;
  const auto add = [&](FlightQuantity quantity, const char* name, Degrees Attitude::*member) {
    if (!has(quantity) || columns_.at[quantity]->unit != Unit::none) return;
    if (quantity == kPitch) angles.maybePitch.push_back(members.size());
    members.push_back(member);
    angles.names.push_back(columns_.at[quantity]->name);
    angles.quantities.push_back(name);
    auto& column = angles.columns.emplace_back();
    for (const AircraftState& state : flight_.states) column.push_back((state.attitude.*member).value());
  };
  add(kHeading, "heading", &Attitude::heading);
  add(kPitch, "pitch", &Attitude::pitch);
  add(kRoll, "roll", &Attitude::roll);
  if (members.empty()) return;
  constexpr double kAlongDeg = 30, kAstrayDeg = 45, kDegreesOfRadian = Radians{1}.in<Degrees>();
  Unit unit = Unit::none;
  if (members.front() == &Attitude::heading) {
    const auto inDegrees = headingErrorDeg(flight_.states, 1),
               inRadians = headingErrorDeg(flight_.states, kDegreesOfRadian);
    if (inDegrees && inRadians) {
      const double degrees = inDegrees.value(), radians = inRadians.value();
      if (degrees < kAlongDeg && radians > kAstrayDeg) unit = Unit::degrees;
      if (radians < kAlongDeg && degrees > kAstrayDeg) unit = Unit::radians;
    }
  }
  if (unit != Unit::none)
    note("", std::string("angles name no unit; headings follow the track if they are ") +
                 (unit == Unit::degrees ? "degrees" : "radians") + ": read as such");
  else
    unit = angleUnit(angles, where_, findings_);
  if (unit == Unit::none) ++errors_;
  if (unit != Unit::radians) return;
  for (AircraftState& state : flight_.states) {
    for (const auto member : members)
      state.attitude.*member = Radians{(state.attitude.*member).value()}.as<Degrees>();
    Attitude& attitude = state.attitude;
    if (std::abs(attitude.pitch.value()) > limits::kPitch)
      refuseAt(where_, "pitch_deg", "a pitch of at most a quarter turn",
               numberText(attitude.pitch.value()) + " deg");
    attitude = {wrapped360(attitude.heading), Degrees{limits::clampedPitch(attitude.pitch.value())},
                wrapped180(attitude.roll)};
  }
}

void Parser::findTimes() {
  auto& states = flight_.states;
  if (!has(kTime)) {
    // Rows that were dropped took their time before the flight began; until here, a row's number is its time.
    const double begin = states.front().time;
    for (AircraftState& state : states) state.time = (state.time - begin) * step_;
    note("time_s", "no such column: rows are taken as " + numberText(step_) + " s apart");
    return;
  }
  const LogColumn& column = *columns_.at[kTime];
  std::vector<double> times, moved;
  for (std::size_t i = 0; i < states.size(); ++i) {
    times.push_back(states[i].time);
    if (i > 0 && column.unit == Unit::none && !clock_)
      moved.push_back(distanceM(states[i - 1].position, states[i].position));
  }
  const TimeReading reading =
      timeReading({column.name, column.unit, clock_}, times, moved, kFlightMotion, where_);
  findings_.insert(findings_.end(), reading.findings.begin(), reading.findings.end());
  if (hasError(reading.findings)) ++errors_;
  const double begin = reading.fromFirst ? times.front() : 0;
  if (reading.scale != 1 || begin != 0)
    for (AircraftState& state : states) state.time = (state.time - begin) * reading.scale;
}

/// Returns all findings, with the number of errors that are not named.
Findings Parser::refused() {
  const auto named = static_cast<std::size_t>(std::count_if(
      findings_.begin(), findings_.end(), [](const Finding& f) { return f.severity == Severity::error; }));
  if (errors_ > named)
    findings_.push_back({Severity::error, where_, "", "", std::to_string(errors_ - named) + " more errors"});
  return std::move(findings_);
}

Result<Flight> Parser::parse() {
  if (!(step_ > 0))
    return Finding{Severity::error, where_, "step", "a time above 0 s between rows", numberText(step_)};
  if (!table_.open(findings_)) return std::move(findings_);
  columns_ = flightColumns(table_, map_, [this](std::string key, std::string expected, std::string found) {
    refuseAt(table_.headerPlace(), std::move(key), std::move(expected), std::move(found));
  });
  if (errors_ > 0) return refused();
  if (!columns_.profile.empty()) note("", columns_.profile);
  while (table_.nextRow()) readRow();
  wrapLongitudes();
  if (errors_ > 0) return refused();
  // A file cut inside its last number reads well, as another number.
  if (!table_.lastLineEnds())
    findings_.push_back({Severity::warning, table_.place(), "", "a line end after the last row",
                         "none: the file may be cut short in its last number"});
  if (notReady_.rows > 0)
    note("altitude_ft",
         notReady_.text() + " below -1000 ft" + notReady_.lines() + ": the simulator was not ready; dropped");
  if (unknown_.rows > 0)
    findings_.push_back({Severity::warning, where_, "latitude_deg", "a position in every row",
                         unknown_.text() + " without one" + unknown_.lines() + ": they are left out"});
  if (flight_.states.empty()) {
    findings_.push_back({Severity::error, where_, "", "at least one row of a flight", "none"});
    return std::move(findings_);
  }
  findAngleUnit();
  findTimes();
  if (errors_ > 0) return refused();
  if (columns_.attitudeFromTrack()) {
    setAttitudeFromTrack(flight_.states, !has(kHeading));
    note("pitch_deg", std::string("no such column: ") +
                          (has(kHeading) ? "pitch and roll" : "heading, pitch and roll") +
                          " are derived from the track");
  }
  appendMotionNotes(flight_, where_, findings_);
  return {std::move(flight_), std::move(findings_)};
}

}  // namespace

Result<Flight> parseFlightCsv(std::string_view text, const std::string& where, double defaultStepS,
                              const ColumnMap& columns) {
  const auto track = tableOfTrack(text, where);
  if (!track) return Parser(text, where, defaultStepS, columns).parse();
  if (!*track) return track->findings();
  Result<Flight> flight = Parser(**track, where, defaultStepS, columns).parse();
  Findings findings = track->findings();
  findings.insert(findings.end(), flight.findings().begin(), flight.findings().end());
  if (!flight) return findings;
  return {std::move(*flight), std::move(findings)};
}

}  // namespace trimtab
