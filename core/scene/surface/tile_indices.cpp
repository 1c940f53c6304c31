#include "tile_indices.h"

#include "trimtab/frame/terrain_index.h"

namespace trimtab::scene {
namespace {

constexpr int kCells = TerrainIndex::kTileCells;
/// Cells are drawn in strips so wide: two rows of a strip's vertices nearly fit the 32 that a GPU may keep,
/// and a tile of 1,089 vertices costs 1,218 there; in whole rows it cost 2,112. On llvmpipe, which keeps 256
/// by their numbers, 1,204 instead of 1,265: 3 % less for a frame of 600,000 triangles. Narrower strips cost
/// its setup of triangles a tenth more.
constexpr int kStrip = 16;

std::uint16_t vertex(int column, int row) {
  return static_cast<std::uint16_t>(row * (kCells + 1) + column);
}

std::uint16_t foldedVertex(int column, int row, unsigned coarser) {
  if (row % 2 != 0 && ((column == 0 && (coarser & 1u)) || (column == kCells && (coarser & 2u)))) --row;
  if (column % 2 != 0 && ((row == 0 && (coarser & 4u)) || (row == kCells && (coarser & 8u)))) --column;
  return vertex(column, row);
}

void addTriangle(std::vector<std::uint16_t>& indices, std::uint16_t a, std::uint16_t b, std::uint16_t c) {
  if (a == b || b == c || c == a) return;
  indices.insert(indices.end(), {a, b, c});
}

/// Diagonals alternate, so that each 2 x 2 block of cells is a fan round its odd post: what the terrain's
/// errors and slopes are measured on.
void addCell(std::vector<std::uint16_t>& indices, bool southWestToNorthEast, std::uint16_t southWest,
             std::uint16_t southEast, std::uint16_t northWest, std::uint16_t northEast) {
  if (southWestToNorthEast) {
    addTriangle(indices, southWest, southEast, northEast);
    addTriangle(indices, southWest, northEast, northWest);
  } else {
    addTriangle(indices, southWest, southEast, northWest);
    addTriangle(indices, southEast, northEast, northWest);
  }
}

}  // namespace

TileIndices makeTileIndices() {
  TileIndices result;
  for (unsigned coarser = 0; coarser < 16; ++coarser) {
    const auto first = static_cast<std::uint32_t>(result.indices.size());
    const auto at = [coarser](int column, int row) { return foldedVertex(column, row, coarser); };
    for (int strip = 0; strip < kCells; strip += kStrip)
      for (int y = 0; y < kCells; ++y)
        for (int x = strip; x < strip + kStrip; ++x)
          addCell(result.indices, (x + y) % 2 == 0, at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1));
    result.variant[coarser] = {first, static_cast<std::uint32_t>(result.indices.size()) - first};
  }
  return result;
}

std::vector<std::uint16_t> makeCoarseIndices(int step) {
  const int cells = kCells / step;
  const auto at = [cells](int column, int row) {
    return static_cast<std::uint16_t>(row * (cells + 1) + column);
  };
  std::vector<std::uint16_t> indices;
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x)
      addCell(indices, (x + y) % 2 == 0, at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1));
  return indices;
}

}  // namespace trimtab::scene
