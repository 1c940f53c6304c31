#include "head_columns.h"

#include <algorithm>

#include "foreign_file.h"
#include "profiles.h"

namespace trimtab {
namespace {

constexpr std::array<std::string_view, 2> kNamedTimes{"time", "timestamp"};
constexpr std::array<std::string_view, 5> kTimes{"timestamp", "time", "seconds", "t", "time_stamp"};
constexpr std::array<std::string_view, 1> kTimeSteps{"time_step"};
constexpr std::array<std::string_view, 4> kHeadings{"head_heading", "head_yaw", "heading", "yaw"};
constexpr std::array<std::string_view, 2> kPitches{"head_pitch", "pitch"};
constexpr std::array<std::string_view, 2> kRolls{"head_roll", "roll"};
constexpr std::array kAngleUnits{Unit::degrees, Unit::radians, Unit::none};
constexpr std::array kTimeUnits{Unit::milliseconds, Unit::seconds, Unit::microseconds, Unit::nanoseconds};
constexpr std::array kMappedTimeUnits{Unit::milliseconds, Unit::seconds, Unit::microseconds,
                                      Unit::nanoseconds, Unit::none};
constexpr std::array kNoUnit{Unit::none};

template <class Names>
bool holds(const Names& names, const auto& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class HeadSearch {
 public:
  HeadSearch(const DelimitedText& table, Findings& findings)
      : table_(table), findings_(findings), columns_(table.header()) {}

  HeadColumns found(const ColumnMap& map) {
    if (const LogProfile* profile = headProfile(table_.header())) {
      const Result<ColumnMap> columns = parseColumnMap(profile->columns);
      takeMap(*columns, true);
      findings_.push_back({Severity::note, table_.file(), "", "", profileText(*profile)});
    }
    takeMap(map, false);
    if (!found_.time) found_.time = find(kNamedTimes, kTimeUnits);
    if (!found_.time) found_.time = find(kTimes, kNoUnit);
    const std::array<std::span<const std::string_view>, HeadColumns::kAngles> names{kHeadings, kPitches,
                                                                                    kRolls};
    for (std::size_t i = 0; i < HeadColumns::kAngles; ++i)
      if (!found_.angles[i]) found_.angles[i] = find(names[i], kAngleUnits);
    for (std::size_t i = 0; i < HeadColumns::kQuaternionNames.size(); ++i)
      if (!found_.quaternion[i])
        found_.quaternion[i] = find(std::span(HeadColumns::kQuaternionNames).subspan(i, 1), kNoUnit);
    checkComplete();
    return std::move(found_);
  }

 private:
  std::optional<LogColumn> find(std::span<const std::string_view> names, std::span<const Unit> units) {
    bool twice = false;
    auto found = columns_.find(names, units, twice);
    if (twice)
      findings_.push_back(
          {Severity::error, table_.headerPlace(), found->name, "one column of this name", "two"});
    return found;
  }

  /// Returns where a map's quantity is kept; null if no head log has one of this name.
  std::optional<LogColumn>* mapped(std::string_view name) {
    const ColumnName wanted = columnName(name);
    if (holds(kAngleUnits, wanted.unit)) {
      if (holds(kHeadings, wanted.base)) return &found_.angles[HeadColumns::kHeading];
      if (holds(kPitches, wanted.base)) return &found_.angles[HeadColumns::kPitch];
      if (holds(kRolls, wanted.base)) return &found_.angles[HeadColumns::kRoll];
    }
    for (std::size_t i = 0; i < HeadColumns::kQuaternionNames.size(); ++i)
      if (name == HeadColumns::kQuaternionNames[i]) return &found_.quaternion[i];
    const bool step = holds(kTimeSteps, wanted.base);
    if (!holds(kMappedTimeUnits, wanted.unit) || (!step && !holds(kNamedTimes, wanted.base))) return nullptr;
    found_.timeIsStep = step;
    return &found_.time;
  }

  /// Takes the columns that a map names. Those of a profile may be missing.
  void takeMap(const ColumnMap& map, bool mayMiss) {
    for (const auto& [name, source] : map) {
      const auto found = columns_.find(source);
      if (!found && mayMiss) continue;
      std::optional<LogColumn>* const place = mapped(name);
      if (place && found) {
        *place = found;
        (*place)->unit = columnName(name).unit;
        continue;
      }
      findings_.push_back(
          {Severity::error, table_.headerPlace(), name,
           place ? "one column named \"" + source.column + '"'
                 : "one of time_s, time_step_s, head_heading_deg, head_pitch_deg, head_roll_deg, head_qw, "
                   "head_qx, head_qy, head_qz",
           place ? table_.beginning() : "a quantity that no head log has"});
    }
  }

  void checkComplete() {
    bool complete = true;
    const auto missing = [&](const char* key, const char* expected) {
      complete = false;
      findings_.push_back({Severity::error, table_.headerPlace(), key, expected, "none in the header"});
    };
    if (!found_.time) missing("time", "a column time_s, timestamp or time_ms");
    const auto& parts = found_.quaternion;
    const auto there =
        std::count_if(parts.begin(), parts.end(), [](const auto& part) { return part.has_value(); });
    if (there > 0 && there < 4) missing("head_qw", "all of head_qw, head_qx, head_qy and head_qz");
    if (there == 0 && !found_.angles[HeadColumns::kHeading])
      missing("heading", "a column head_heading_deg, heading or yaw");
    if (there == 0 && !found_.angles[HeadColumns::kPitch])
      missing("pitch", "a column head_pitch_deg or pitch");
    if (!complete)
      findings_.push_back({Severity::error, table_.headerPlace(), "", "the columns of a head log",
                           seemsToBe(table_.header()) + table_.beginning()});
  }

  const DelimitedText& table_;
  Findings& findings_;
  LogColumns columns_;
  HeadColumns found_;
};

}  // namespace

HeadColumns headColumns(const DelimitedText& table, const ColumnMap& map, Findings& findings) {
  return HeadSearch(table, findings).found(map);
}

}  // namespace trimtab
