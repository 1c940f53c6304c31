#include "trimtab/host/log_look.h"

#include <algorithm>
#include <fstream>

#include "delimited_text.h"
#include "flight_columns.h"
#include "head_columns.h"
#include "track_file.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

constexpr std::size_t kMostRows = 8;

/// Leaves whole rows of a text that was cut.
void cutToRows(std::string& text) {
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff")) {
    const std::string_view mark =
        text[0] == '\xff' ? std::string_view("\n\0", 2) : std::string_view("\0\n", 2);
    std::size_t end = text.rfind(mark);
    while (end != std::string::npos && end % 2 != 0) end = text.rfind(mark, end - 1);
    if (end != std::string::npos) text.resize(end + 2);
    return;
  }
  std::size_t end = text.rfind('\n');
  if (end == std::string::npos) end = text.rfind('\r');
  if (end != std::string::npos) text.resize(end + 1);
}

std::string suffixOf(Unit unit) {
  switch (unit) {
    case Unit::degrees:
      return "_deg";
    case Unit::radians:
      return "_rad";
    case Unit::seconds:
      return "_s";
    case Unit::milliseconds:
      return "_ms";
    case Unit::microseconds:
      return "_us";
    case Unit::nanoseconds:
      return "_ns";
    case Unit::feet:
      return "_ft";
    case Unit::metres:
      return "_m";
    case Unit::none:
      break;
  }
  return "";
}

/// Puts what a search of columns found into a map.
class FoundColumns {
 public:
  FoundColumns(const DelimitedText& table, LogKind kind) : table_(table), kind_(kind) {}

  ColumnMap map() {
    kind_ == LogKind::flight ? addFlight() : addHead();
    return std::move(found_);
  }

 private:
  void addFlight() {
    const FlightColumns columns =
        flightColumns(table_, {}, [](const std::string&, const std::string&, const std::string&) {});
    const auto named = [&](FlightQuantity quantity, const std::string& base, bool degrees) {
      if (const auto& column = columns.at[quantity])
        add(base + (degrees && column->unit == Unit::none ? "_deg" : suffixOf(column->unit)), *column);
    };
    named(kTime, "time", false);
    named(kLatitude, "latitude", true);
    named(kLongitude, "longitude", true);
    named(kPitch, "pitch", false);
    named(kRoll, "roll", false);
    named(kHeading, "heading", false);
    if (columns.has(kHeightM))
      add("altitude_m", *columns.at[kHeightM]);
    else if (columns.has(kAltitudeFt))
      add("altitude_ft", *columns.at[kAltitudeFt]);
    for (const FlightQuantity quantity : {kAboveGround, kHeadHeading, kHeadPitch, kHeadRoll})
      if (columns.has(quantity)) add(flightQuantity(quantity).name, *columns.at[quantity]);
  }

  void addHead() {
    Findings ignored;
    const HeadColumns columns = headColumns(table_, {}, ignored);
    if (columns.time)
      add(columns.timeIsStep ? "time_step_s" : "time" + suffixOf(columns.time->unit), *columns.time);
    for (std::size_t i = 0; i < HeadColumns::kAngles; ++i)
      if (const auto& column = columns.angles[i])
        add(std::string(HeadColumns::kAngleNames[i]) + suffixOf(column->unit), *column);
    for (std::size_t i = 0; i < columns.quaternion.size(); ++i)
      if (const auto& column = columns.quaternion[i])
        add(std::string(HeadColumns::kQuaternionNames[i]), *column);
  }

  void add(const std::string& key, const LogColumn& column) {
    ColumnSource source = sourceOf(table_.header(), column.place, column.scale, column.offset);
    if (column.part != 0) source.column += '[' + std::to_string(column.part) + ']';
    found_[key] = std::move(source);
  }

  const DelimitedText& table_;
  LogKind kind_;
  ColumnMap found_;
};

Result<std::string> bytesOf(const std::filesystem::path& file, std::size_t mostBytes, bool& whole) {
  if (const auto data = checkIsData(file); !data) return data.findings();
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  std::ifstream in(file, std::ios::binary);
  if (error || !in) return Finding{Severity::error, file.string(), "", "a file that can be read", "none"};
  whole = size <= mostBytes;
  std::string text(whole ? static_cast<std::size_t>(size) : mostBytes, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (!whole) cutToRows(text);
  return text;
}

}  // namespace

const std::vector<LogQuantity>& logQuantities(LogKind kind) {
  const LogKey byValues{"time", "by the values"};
  const std::vector<LogKey> times{
      byValues, {"time_s", "s"}, {"time_ms", "ms"}, {"time_us", "us"}, {"time_ns", "ns"}};
  const auto angle = [](const std::string& base) {
    return std::vector<LogKey>{{base, "by the values"}, {base + "_deg", "deg"}, {base + "_rad", "rad"}};
  };
  const auto degrees = [](const std::string& base) {
    return std::vector<LogKey>{{base + "_deg", "deg"}, {base + "_rad", "rad"}};
  };
  static const std::vector<LogQuantity> kFlight{
      {"Time", times},
      {"Latitude", degrees("latitude")},
      {"Longitude", degrees("longitude")},
      {"Altitude above sea level", {{"", "feet or metres?"}, {"altitude_ft", "ft"}, {"altitude_m", "m"}}},
      {"Pitch", angle("pitch")},
      {"Roll", angle("roll")},
      {"Heading", angle("heading")},
      {"Height above ground", {{"above_ground_m", "m"}}},
      {"Heading of the head", {{"head_heading_deg", "deg"}}},
      {"Pitch of the head", {{"head_pitch_deg", "deg"}}},
      {"Roll of the head", {{"head_roll_deg", "deg"}}}};
  static const std::vector<LogQuantity> kHead = [&] {
    std::vector<LogKey> headTimes = times;
    headTimes.push_back({"time_step_s", "s since the row above"});
    return std::vector<LogQuantity>{{"Time", headTimes},
                                    {"Heading, to the right", angle("head_heading")},
                                    {"Pitch, up", angle("head_pitch")},
                                    {"Roll, right wing down", angle("head_roll")},
                                    {"Quaternion, w", {{"head_qw", ""}}},
                                    {"Quaternion, forward", {{"head_qx", ""}}},
                                    {"Quaternion, right", {{"head_qy", ""}}},
                                    {"Quaternion, down", {{"head_qz", ""}}}};
  }();
  return kind == LogKind::flight ? kFlight : kHead;
}

std::size_t likelyKey(const LogQuantity& quantity, std::string_view column) {
  const Unit unit = columnName(column).unit;
  for (std::size_t i = 0; unit != Unit::none && i < quantity.keys.size(); ++i)
    if (columnName(quantity.keys[i].key).unit == unit) return i;
  return 0;
}

ColumnSource sourceOf(const std::vector<std::string>& header, std::size_t place, double scale,
                      double offset) {
  const std::string name(trimmed(header[place]));
  ColumnSource source{'#' + std::to_string(place + 1), scale, offset, ""};
  const bool once = std::count_if(header.begin(), header.end(),
                                  [&](const std::string& each) { return trimmed(each) == name; }) == 1;
  if (once && !name.empty() && !name.starts_with('#') && name.find('"') == std::string::npos)
    source.column = name;
  source.written = columnMapText({{"", source}}).substr(1);
  return source;
}

Result<LogBeginning> beginningOfLog(const std::filesystem::path& file, LogKind kind, std::size_t mostBytes) {
  LogBeginning beginning;
  Result<std::string> text = bytesOf(file, mostBytes, beginning.whole);
  if (!text) return text.findings();
  if (tableOfTrack(*text, file.string()))
    return Finding{Severity::error, file.string(), "", "a table of text with columns",
                   "a track, whose quantities are known"};
  DelimitedText table(*text, file.string());
  Findings findings;
  if (!table.open(findings)) return findings;
  beginning.header = table.header();
  beginning.hasHeader = table.hasHeader();
  beginning.found = FoundColumns(table, kind).map();
  while (beginning.rows.size() < kMostRows && table.nextRow())
    beginning.rows.emplace_back(table.cells().begin(), table.cells().end());
  beginning.text = std::move(*text);
  return beginning;
}

}  // namespace trimtab
