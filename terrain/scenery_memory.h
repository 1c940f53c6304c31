#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "trimtab/units/quantity.h"

namespace trimtab::terrain {

// Told before any file is read.

/// Bytes that scenery's files take at their highest where all of them are in memory and trees are made of
/// them: by their sizes as unzipped.
std::uint64_t sceneryBytes(std::span<const std::filesystem::path> files);
/// And those of the posts over their buckets, where those are in memory too.
std::uint64_t sceneryPostsBytes(std::span<const std::filesystem::path> files, std::optional<Metres> post);

}  // namespace trimtab::terrain
