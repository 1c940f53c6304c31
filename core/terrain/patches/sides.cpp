#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "page.h"

namespace trimtab::terrain {

namespace {

bool lesser(PatchPoint a, PatchPoint b) {
  return a.row != b.row ? a.row < b.row : a.column < b.column;
}

std::uint32_t length(PatchPoint a, PatchPoint b) {
  const auto apart = [](std::uint32_t p, std::uint32_t q) { return p < q ? q - p : p - q; };
  return std::max(apart(a.column, b.column), apart(a.row, b.row));
}

/// Returns the post that is so many steps along a row, a column or a diagonal.
PatchPoint between(PatchPoint a, PatchPoint b, std::uint32_t along) {
  const auto moved = [&](std::uint32_t p, std::uint32_t q) {
    return p < q ? p + along : p > q ? p - along : p;
  };
  return {moved(a.column, b.column), moved(a.row, b.row)};
}

}  // namespace

std::uint32_t meshStride(const PatchIndex& index, int pair) {
  return std::max(1u, index.squareCells(pair) * index.pageSquares() / (kMostPostsASide - 1));
}

PostWindow pageWindow(const PatchIndex& index, const PatchIndex::Page& page) {
  const std::uint32_t side = index.squareCells(page.pair) * index.pageSquares();
  const std::uint32_t column = page.column * side, row = page.row * side;
  return {column, row, std::min(side, index.columns - 1 - column) + 1,
          std::min(side, index.rows - 1 - row) + 1};
}

PostPlane pagePlane(const PostGeometry& geometry, const PostWindow& window) {
  return PostPlane(geometry, window.column + window.columns / 2, window.row + window.rows / 2);
}

PageField::PageField(const PatchIndex& index, const PatchIndex::Page& page, const HeightSource& heights,
                     const PostGeometry& geometry, const std::vector<double>& tolerances)
    : index_(index),
      heights_(heights),
      geometry_(geometry),
      tolerances_(tolerances),
      window_(pageWindow(index, page)),
      stride_(meshStride(index, page.pair)),
      columns_(strided(window_.columns, stride_)),
      rows_(strided(window_.rows, stride_)),
      plane_(pagePlane(geometry, window_)),
      raw_(std::size_t{columns_} * rows_),
      z_(raw_.size()) {
  heights.read(window_, stride_, raw_);
  for (std::uint32_t r = 0; r < rows_; ++r)
    plane_.row(window_.column, window_.row + r * stride_, stride_,
               std::span<const float>(raw_).subspan(std::size_t{r} * columns_, columns_),
               &z_[std::size_t{r} * columns_]);
}

float PageField::height(PatchPoint p) const {
  const std::uint32_t c = p.column - window_.column, r = p.row - window_.row;
  if (c % stride_ == 0 && r % stride_ == 0) return raw_[std::size_t{r / stride_} * columns_ + c / stride_];
  float height = 0;
  heights_.read({p.column, p.row, 1, 1}, 1, std::span(&height, 1));
  return height;
}

std::vector<PatchPoint> PageField::simplified(PatchPoint from, PatchPoint to, std::uint32_t step,
                                              double tolerance) {
  // Where the posts end, an end need not be at a step; those parts have no posts between to choose from.
  const std::uint32_t all = length(from, to);
  const bool byRow = from.row != to.row;
  const std::uint32_t start = byRow ? from.row : from.column;
  const bool rising = byRow ? from.row < to.row : from.column < to.column;
  const std::uint32_t head = std::min(all, rising ? (step - start % step) % step : start % step);
  const std::uint32_t steps = (all - head) / step, tail = head + steps * step;

  std::vector<PatchPoint> line;
  if (head != 0) line.push_back(from);
  const PatchPoint middle = between(from, to, all / 2);
  const PostPlane plane(geometry_, middle.column, middle.row);
  strip_.clear();
  for (std::uint32_t i = 0; i <= steps; ++i) {
    const PatchPoint p = between(from, to, head + i * step);
    strip_.push_back(static_cast<float>(plane.at(p.column, p.row, height(p))));
  }
  std::vector<PatchPoint> kept;
  simplifySide({strip_.data(), steps + 1, 1, steps + 1}, {0, 0}, {steps, 0}, tolerance, kept);
  for (const PatchPoint& k : kept) line.push_back(between(from, to, head + k.column * step));
  if (tail != all) line.push_back(to);
  return line;
}

std::vector<PatchPoint> PageField::side(const PatchEdge& edge, int depth) {
  const bool turned = lesser(edge.to, edge.from);
  const PatchPoint from = turned ? edge.to : edge.from, to = turned ? edge.from : edge.to;
  const auto make = [&](int side, int pair) {
    const auto last = tolerances_.size() - 1;
    return simplified(from, to, meshStride(index_, pair),
                      tolerances_[std::min(static_cast<std::size_t>(side), last)]);
  };
  std::vector<PatchPoint> line;
  if (edge.side == PatchEdge::kDataEdge) {
    line = make(depth, depth / 2);
  } else {
    auto& known = sides_[{static_cast<std::uint32_t>(edge.side), from.column, from.row, to.column, to.row}];
    // A diagonal is a leg of the patches in the page of larger squares, so it is simplified at that page's
    // posts.
    const int side = edge.side;
    if (known.empty()) known = make(side, side % 2 == 0 && side > 0 ? side / 2 - 1 : side / 2);
    line = known;
  }
  if (turned) std::reverse(line.begin(), line.end());
  return line;
}

}  // namespace trimtab::terrain
