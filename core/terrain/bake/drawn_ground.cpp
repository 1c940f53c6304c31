#include "drawn_ground.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "trimtab/terrain/format/patch_shape.h"

namespace trimtab::terrain {

namespace {

/// A place counted in posts, and whose it is.
struct PostedPlacement {
  double column, row;
  std::uint32_t number;
};

/// Returns the point of a mesh's finest triangles at a place; none if no triangle is there. Between posts,
/// the local frame is a linear map of columns and rows, to a centimetre.
std::optional<Vec3> pointOf(const PatchMesh& mesh, double column, double row) {
  const double c = column - mesh.firstColumn, r = row - mesh.firstRow;
  constexpr double kOnSide = -1e-9;
  for (std::uint32_t k = mesh.firstIndex[0]; k + 2 < mesh.firstIndex[1]; k += 3) {
    const PatchVertex* const t[3] = {&mesh.vertices[mesh.indices[k]], &mesh.vertices[mesh.indices[k + 1]],
                                     &mesh.vertices[mesh.indices[k + 2]]};
    const double c1 = t[1]->column - t[0]->column, r1 = t[1]->row - t[0]->row,
                 c2 = t[2]->column - t[0]->column, r2 = t[2]->row - t[0]->row;
    const double area = c1 * r2 - c2 * r1;
    if (area == 0) continue;
    const double dc = c - t[0]->column, dr = r - t[0]->row;
    const double second = (dc * r2 - c2 * dr) / area, third = (c1 * dr - dc * r1) / area,
                 first = 1 - second - third;
    if (first < kOnSide || second < kOnSide || third < kOnSide) continue;
    Vec3 point{mesh.origin[0] * 16.0, mesh.origin[1] * 16.0, mesh.origin[2] * 16.0};
    const double share[3] = {first, second, third};
    for (std::size_t i = 0; i < 3; ++i)
      point = point + Vec3{double{t[i]->x}, double{t[i]->y}, double{t[i]->z}} * share[i];
    return point;
  }
  return {};
}

/// The smallest patches of one page, by square.
class LeafPage {
 public:
  LeafPage(const PatchIndex& index, std::uint32_t number, PatchPage page)
      : page_(std::move(page)), cells_(index.squareCells(index.pages[number].pair)) {
    const std::vector<PatchPlace> places = placesOfPage(index, index.pages[number]);
    for (std::uint32_t i = 0; i < places.size() && i < page_.patches.size(); ++i)
      if (places[i].part >= 2) squares_[{places[i].row, places[i].column}].push_back(i);
  }
  std::optional<Vec3> pointAt(double column, double row) const {
    // A place on the line between two squares may be in the last one before it alone.
    for (const double c : {column, column - 1e-6})
      for (const double r : {row, row - 1e-6}) {
        const auto square = squares_.find({static_cast<std::uint32_t>(std::max(r, 0.0) / cells_),
                                           static_cast<std::uint32_t>(std::max(c, 0.0) / cells_)});
        if (square == squares_.end()) continue;
        for (const std::uint32_t i : square->second)
          if (const auto point = pointOf(page_.patches[i], column, row)) return point;
      }
    return {};
  }

 private:
  PatchPage page_;
  double cells_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> squares_;
};

}  // namespace

Result<Done> standOnDrawnGround(PlacementList& list, const PatchTerrain& patches, const PostGrid& posts) {
  const PatchIndex& index = patches.index();
  using Block = std::pair<std::uint32_t, std::uint32_t>;
  std::uint8_t finest = 0;
  for (const PatchIndex::Page& page : index.pages) finest = std::max(finest, page.pair);
  const double cells = double{static_cast<double>(index.squareCells(finest))} * index.pageSquares();
  std::map<Block, std::vector<PostedPlacement>> blocks;
  for (std::uint32_t i = 0; i < list.placements.size(); ++i) {
    const ListedPlacement& p = list.placements[i];
    const double column = posts.columnOf(p.longitude.value()), row = posts.rowOf(p.latitude.value());
    if (p.height || !(column >= 0 && row >= 0 && column <= posts.columns - 1.0 && row <= posts.rows - 1.0))
      continue;
    // The last posts belong to the last squares.
    const auto blockOf = [cells](double along, std::uint32_t count) {
      return static_cast<std::uint32_t>(std::min(along, count - 1 - 1e-6) / cells);
    };
    blocks[{blockOf(row, posts.rows), blockOf(column, posts.columns)}].push_back({column, row, i});
  }
  for (std::uint32_t number = 0; number < index.pages.size(); ++number) {
    const PatchIndex::Page& page = index.pages[number];
    if (page.pair != finest) continue;
    const auto block = blocks.find({page.row, page.column});
    if (block == blocks.end()) continue;
    auto read = patches.readPage(number);
    if (!read) return read.findings();
    const LeafPage leaf(index, number, std::move(read).value());
    for (const PostedPlacement& p : block->second)
      if (const auto point = leaf.pointAt(p.column, p.row))
        list.placements[p.number].height =
            index.frame.toGeodetic(*point).height + list.placements[p.number].aboveGround;
  }
  return Done{};
}

}  // namespace trimtab::terrain
