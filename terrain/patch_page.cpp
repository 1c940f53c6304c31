#include "trimtab/terrain/patch_page.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trimtab::terrain {

namespace {

/// Whether no vertex of a polygon lies in the closed triangle of three of them.
bool isEar(const std::vector<PatchPoint>& polygon, std::size_t i) {
  const std::size_t n = polygon.size(), before = (i + n - 1) % n, after = (i + 1) % n;
  const auto side = [](PatchPoint a, PatchPoint b, PatchPoint p) {
    return (std::int64_t{b.column} - a.column) * (std::int64_t{p.row} - a.row) -
           (std::int64_t{b.row} - a.row) * (std::int64_t{p.column} - a.column);
  };
  const PatchPoint a = polygon[before], b = polygon[i], c = polygon[after];
  if (side(a, b, c) <= 0) return false;
  for (std::size_t k = 0; k < n; ++k) {
    if (k == before || k == i || k == after) continue;
    if (side(a, b, polygon[k]) >= 0 && side(b, c, polygon[k]) >= 0 && side(c, a, polygon[k]) >= 0)
      return false;
  }
  return true;
}

PatchDraft drafted(const PatchIndex& index, const PatchPlace& place) {
  PatchDraft draft{place, patchEdges(index, place), {}, {}};
  for (const PatchEdge& edge : draft.edges) {
    const std::int64_t dc = std::int64_t{edge.to.column} - edge.from.column,
                       dr = std::int64_t{edge.to.row} - edge.from.row;
    const std::int64_t length = std::max(std::abs(dc), std::abs(dr));
    const std::int64_t step = std::max<std::int64_t>(1, index.squareCells(place.pair) / 16);
    // From the lesser end, so that both patches at it find the same posts.
    const bool forward =
        edge.from.row != edge.to.row ? edge.from.row < edge.to.row : edge.from.column < edge.to.column;
    for (std::int64_t at = 0; at < length; at += 1) {
      const std::int64_t fromLesser = forward ? at : length - at;
      if (at == 0 || fromLesser % step == 0)
        draft.vertices.push_back({static_cast<std::uint32_t>(edge.from.column + dc / length * at),
                                  static_cast<std::uint32_t>(edge.from.row + dr / length * at)});
    }
  }
  std::vector<std::uint32_t> left(draft.vertices.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<PatchPoint> polygon = draft.vertices;
  std::vector<std::uint32_t> triangles;
  while (polygon.size() >= 3) {
    std::size_t ear = 0;
    while (!isEar(polygon, ear)) ++ear;
    const std::size_t n = polygon.size();
    triangles.insert(triangles.end(), {left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(ear));
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  draft.triangles.fill(triangles);
  return draft;
}

}  // namespace

std::uint32_t meshStride(const PatchIndex& index, int pair) {
  return std::max(1u, index.squareCells(pair) * PatchIndex::kPageSquares / (kMostPostsASide - 1));
}

PostWindow pageWindow(const PatchIndex& index, const PatchIndex::Page& page) {
  const std::uint32_t side = index.squareCells(page.pair) * PatchIndex::kPageSquares;
  const std::uint32_t column = page.column * side, row = page.row * side;
  return {column, row, std::min(side, index.columns - 1 - column) + 1,
          std::min(side, index.rows - 1 - row) + 1};
}

std::size_t PatchPage::bytes() const {
  std::size_t sum = 0;
  for (const PatchMesh& patch : patches)
    sum += patch.vertices.size() * sizeof(PatchVertex) + patch.indices.size() * sizeof(std::uint16_t);
  return sum;
}

BuiltPage buildPage(const PatchIndex& index, std::uint32_t page, const HeightSource& heights,
                    const PostGeometry& geometry, const std::vector<double>& tolerances) {
  static_cast<void>(tolerances);
  BuiltPage built;
  built.meshes.page = page;
  const PatchIndex::Page& at = index.pages[page];
  std::vector<PatchDraft> drafts;
  for (const PatchPlace& place : placesOfPage(index, at)) drafts.push_back(drafted(index, place));
  measurePage(index, at, heights, geometry, drafts, built);
  return built;
}

}  // namespace trimtab::terrain
