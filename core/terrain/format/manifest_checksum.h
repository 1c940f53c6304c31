#pragma once

#include <cstddef>
#include <string>

namespace trimtab::terrain {

/// Where a manifest's own checksum stands in its text, or npos: it is over every byte but these sixteen.
std::size_t manifestChecksumPlace(const std::string& text);
std::string manifestChecksum(const std::string& text, std::size_t place);

}  // namespace trimtab::terrain
