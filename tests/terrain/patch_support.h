#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include "support.h"
#include "trimtab/terrain/import.h"
#include "trimtab/terrain/patch_build.h"
#include "trimtab/terrain/patch_shape.h"

/// Grids and cuts for tests of patches.
namespace trimtab::test {

/// Heights of a function of column and row.
template <class Height>
terrain::HeightGrid gridOf(const terrain::PostGrid& posts, const Height& height) {
  terrain::HeightGrid grid;
  grid.posts = posts;
  grid.heights.reserve(posts.size());
  for (std::uint32_t r = 0; r < posts.rows; ++r)
    for (std::uint32_t c = 0; c < posts.columns; ++c)
      grid.heights.push_back(static_cast<float>(height(c, r)));
  return grid;
}

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

}  // namespace trimtab::test
