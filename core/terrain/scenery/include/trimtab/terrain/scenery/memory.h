#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

namespace trimtab::terrain {

/// Bytes that scenery's files take at their highest where all of them are in memory and trees are made of
/// them: by their sizes as unzipped.
std::uint64_t sceneryBytes(std::span<const std::filesystem::path> files);
/// And what tiles made between them add, by their triangles.
std::uint64_t madeTilesBytes(std::uint64_t triangles);

}  // namespace trimtab::terrain
