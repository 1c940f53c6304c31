#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "trimtab/units/quantity.h"

namespace trimtab::terrain {

/// Bytes that baking scenery's files will take at its highest, told before any is read: by the sizes of the
/// files as unzipped, and by the posts over their buckets. Elevation beside them is not counted.
std::uint64_t sceneryBakeBytes(std::span<const std::filesystem::path> files, std::optional<Metres> post);

}  // namespace trimtab::terrain
