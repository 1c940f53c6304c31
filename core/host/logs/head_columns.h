#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "delimited_text.h"
#include "log_columns.h"

/// The quantities of a head log, and the columns of a table that hold them.
namespace trimtab {

struct HeadColumns {
  static constexpr std::size_t kHeading = 0, kPitch = 1, kRoll = 2, kAngles = 3;
  static constexpr std::array<std::string_view, kAngles> kAngleNames{"head_heading", "head_pitch",
                                                                     "head_roll"};
  static constexpr std::array<std::string_view, 4> kQuaternionNames{"head_qw", "head_qx", "head_qy",
                                                                    "head_qz"};

  std::optional<LogColumn> time;
  bool timeIsStep = false;  ///< the time since the row above
  std::array<std::optional<LogColumn>, kAngles> angles;
  std::array<std::optional<LogColumn>, 4> quaternion;
};

/// Finds the columns of a head log: those of a known profile, those that the map names in their place, else
/// those with names that are read. Appends errors for whatever is missing or stands twice.
HeadColumns headColumns(const DelimitedText& table, const ColumnMap& map, Findings& findings);

}  // namespace trimtab
