#include "trimtab/terrain/grid/post_plane.h"

namespace trimtab::terrain {

PostPlane::PostPlane(const PostGeometry& geometry, std::uint32_t column, std::uint32_t row)
    : geometry_(geometry) {
  const PostGeometry::Row& r = geometry.rows_[row];
  out_ = r.cosine;
  north_ = r.sine;
  cosine_ = geometry.columns_[column].cosine;
  sine_ = geometry.columns_[column].sine;
  base_ = 0;
  base_ = at(column, row, 0);
}

void PostPlane::row(std::uint32_t column, std::uint32_t row, std::uint32_t stride,
                    std::span<const float> heights, float* out) {
  if (firstColumn_ != column || stride_ != stride || across_.size() < heights.size()) {
    firstColumn_ = column;
    stride_ = stride;
    across_.resize(heights.size());
    for (std::size_t i = 0; i < heights.size(); ++i)
      across_[i] = across(column + stride * static_cast<std::uint32_t>(i));
  }
  const PostGeometry::Row& r = geometry_.rows_[row];
  // This computes as `along` does, to the bit: the same post has the same height.
  for (std::size_t i = 0; i < heights.size(); ++i)
    out[i] = static_cast<float>(along(r, heights[i], across_[i]));
}

}  // namespace trimtab::terrain
