#pragma once

#include <cstddef>
#include <string>

namespace trimtab::terrain {

/// Returns where the 16 digits of the manifest's own checksum begin in its text, or npos. The checksum covers
/// every byte except these digits.
std::size_t manifestChecksumPlace(const std::string& text);
std::string manifestChecksum(const std::string& text, std::size_t place);

}  // namespace trimtab::terrain
