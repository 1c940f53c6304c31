#pragma once

#include <string>
#include <vector>

#include "trimtab/host/column_map.h"

namespace trimtab {

/// How a program writes its logs, recognised by the names of columns.
struct LogProfile {
  const char* name;                ///< "an X-Plane Data.txt"
  std::vector<const char*> signs;  ///< columns that all of its files have
  const char* columns;             ///< as parseColumnMap reads them; one that a file lacks is passed over
  const char* remark;              ///< what is worth knowing of them; may be empty
};

/// Returns the profile of a flight or of a head log whose header this is; null if it is none of those known.
const LogProfile* flightProfile(const std::vector<std::string>& header);
const LogProfile* headProfile(const std::vector<std::string>& header);

/// Says that the columns are those of a profile.
std::string profileText(const LogProfile& profile);

}  // namespace trimtab
