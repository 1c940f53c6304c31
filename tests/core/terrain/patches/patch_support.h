#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/core/terrain/elevation/read_elevation.h"
#include "tests/support.h"
#include "trimtab/terrain/format/patch_shape.h"
#include "trimtab/terrain/patches/build.h"

/// Grids and cuts for tests of patches.
namespace trimtab::test {

/// Heights of a function of column and row.
inline terrain::HeightGrid gridOf(const terrain::PostGrid& posts,
                                  const std::function<double(std::uint32_t, std::uint32_t)>& height) {
  terrain::HeightGrid grid;
  grid.posts = posts;
  grid.heights.reserve(posts.size());
  for (std::uint32_t r = 0; r < posts.rows; ++r)
    for (std::uint32_t c = 0; c < posts.columns; ++c)
      grid.heights.push_back(static_cast<float>(height(c, r)));
  return grid;
}

/// Fractal ground: octaves of lattice noise, each `2^-roughness` as high as the one before.
terrain::HeightGrid fractal(const terrain::PostGrid& posts, unsigned seed, double reliefM = 3000,
                            double roughness = 0.9);

/// What a file of the shared folder holds.
terrain::HeightGrid imported(const std::string& file);

/// Twice the area of a polygon of edges, in cells.
inline std::int64_t twiceArea(const std::vector<terrain::PatchEdge>& edges) {
  std::int64_t area = 0;
  for (const terrain::PatchEdge& e : edges)
    area += std::int64_t{e.from.column} * e.to.row - std::int64_t{e.from.row} * e.to.column;
  return area;
}

/// Places of all patches, in order.
inline std::vector<terrain::PatchPlace> placesOf(const PatchIndex& index) {
  std::vector<terrain::PatchPlace> places;
  for (const PatchIndex::Page& page : index.pages)
    for (const terrain::PatchPlace& place : terrain::placesOfPage(index, page)) places.push_back(place);
  return places;
}

/// A terrain with all of its meshes at hand.
struct WholeTerrain {
  std::shared_ptr<const terrain::PatchTerrain> terrain;
  std::vector<terrain::PatchPage> pages;
  explicit WholeTerrain(std::shared_ptr<const terrain::PatchTerrain> of);
  const PatchIndex& index() const { return terrain->index(); }
  const terrain::PatchMesh& mesh(std::uint32_t patch) const {
    const std::uint32_t page = index().page[patch];
    return pages[page].patches[patch - index().pages[page].firstPatch];
  }
};
WholeTerrain built(const terrain::HeightGrid& grid, double leafToleranceM);
WholeTerrain built(const terrain::HeightGrid& grid, double leafToleranceM, std::uint32_t leafCells);

/// A vertex as everybody draws it: steps of 1/256 m in the frame, and its post.
struct DrawnVertex {
  std::int64_t x, y, z;
  std::uint32_t column, row;
  auto operator<=>(const DrawnVertex&) const = default;
};
DrawnVertex drawn(const terrain::PatchMesh& mesh, std::uint32_t vertex);

/// A patch and its variant.
struct Chosen {
  std::uint32_t patch;
  std::size_t variant;
};
/// A legal cut: diamonds whose parents are split are split themselves with this probability.
std::vector<Chosen> randomCut(const PatchIndex& index, std::mt19937& random, double share);
/// What a patch's variant shows to others: its border, found from its triangles alone.
struct Piece {
  std::vector<std::pair<DrawnVertex, DrawnVertex>> border;  ///< anticlockwise edges
  std::int64_t twiceArea = 0;                               ///< in cells
  std::string wrong;  ///< a triangle without area or turned over, an edge with more than two triangles
};
using Pieces = std::array<Piece, PatchIndex::kMostVariants>;  ///< of a patch, by variant
std::vector<Pieces> piecesOf(const WholeTerrain& terrain);
/// The first thing wrong with a cut: a wrong piece, a border edge that is not met by exactly one other the
/// other way round (but where the posts end), an area that is not that of the posts.
std::string wrongWith(const PatchIndex& index, const std::vector<Pieces>& pieces,
                      const std::vector<Chosen>& cut);

}  // namespace trimtab::test
