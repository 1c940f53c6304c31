#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trimtab {

/// Says what a file that is refused may be, by the names of its columns: "what seems to be a head log, with
/// ". Returns nothing if that is unknown.
std::string seemsToBe(const std::vector<std::string>& header);

/// Says what a file is that is no table, by its first bytes: "GPX", "JSON". Returns nothing if it may be one.
std::string notATable(std::string_view text);

}  // namespace trimtab
