#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace trimtab::terrain {

/// Estimates the peak memory, in bytes, of baking static trees from these scenery files with all of them in
/// memory, from their unzipped sizes.
std::uint64_t sceneryBytes(std::span<const std::filesystem::path> files);
/// Estimates what made tiles (makeTiles) with so many triangles add to it, bytes.
std::uint64_t madeTilesBytes(std::uint64_t triangles);

}  // namespace trimtab::terrain
