#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/host/column_map.h"
#include "trimtab/units/result.h"

/// What a program shows a person who has to say which column of a log is which quantity. The log itself is
/// read by readFlight() and openHead(), with the map that the person made.
namespace trimtab {

enum class LogKind { flight, head };

/// A name by which a map reads a quantity, and the unit that it stands for.
struct LogKey {
  std::string key;   ///< "altitude_ft"; empty: the unit has to be chosen, since nothing else tells it
  std::string unit;  ///< "ft", for a person
};

/// A quantity that a person may look for in a log.
struct LogQuantity {
  std::string label;
  /// One for each unit. The first is for a column whose name has no unit.
  std::vector<LogKey> keys;
};
const std::vector<LogQuantity>& logQuantities(LogKind kind);

/// Returns the index of the key to begin with for a column of this name: the one in the name's unit, else the
/// first.
std::size_t likelyKey(const LogQuantity& quantity, std::string_view column);

/// How a log begins.
struct LogBeginning {
  std::string text;                 ///< whole rows from the file's begin on, as they stand there
  bool whole = true;                ///< the text is all of the file
  std::vector<std::string> header;  ///< of a file without one, #1, #2 and so on
  bool hasHeader = true;
  std::vector<std::vector<std::string>> rows;  ///< eight at most, each with as many cells as it has
  ColumnMap found;  ///< where quantities are by the names of the columns, by keys of `logQuantities`
};

/// The part of a log that is looked at; a reader takes some 100 ms for so many bytes.
inline constexpr std::size_t kLogBeginning = std::size_t{1} << 20;

/// Reads the first `mostBytes` of a log at most. Fails if it is no file, or no table of text.
Result<LogBeginning> beginningOfLog(const std::filesystem::path& file, LogKind kind,
                                    std::size_t mostBytes = kLogBeginning);

/// Returns the source that names a column of a header by its place: by name where one column has it, else by
/// number.
ColumnSource sourceOf(const std::vector<std::string>& header, std::size_t place, double scale = 1,
                      double offset = 0);

/// Returns the text that parseColumnMap() reads as this map.
std::string columnMapText(const ColumnMap& map);

/// Returns the maps between which a refused file leaves the choice, one list for each quantity or group of
/// quantities that can be read in several ways; nothing if it was refused for other reasons.
std::vector<std::vector<ColumnMap>> readingsThatFit(const Findings& findings);

}  // namespace trimtab
