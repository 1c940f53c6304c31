#pragma once

#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_geometry.h"

namespace trimtab::terrain {

/// Heights of posts above the plane that touches the ellipsoid at one of them.
///
/// They are linear in place, so that a triangle of posts in space is, but for the bend of rows and columns
/// sideways, the triangle of their heights over columns and rows: what a mesher measures with them has the
/// earth's curvature in it.
class PostPlane {
 public:
  PostPlane(const PostGeometry& geometry, std::uint32_t column, std::uint32_t row);

  double at(std::uint32_t column, std::uint32_t row, double height) const {
    const PostGeometry::Row& r = geometry_.rows_[row];
    return along(r, height, across(column));
  }
  /// Of `heights` at every `stride`-th column from `column`, of one row.
  void row(std::uint32_t column, std::uint32_t row, std::uint32_t stride, std::span<const float> heights,
           float* out);

 private:
  double across(std::uint32_t column) const {
    const PostGeometry::Column& c = geometry_.columns_[column];
    return out_ * (c.cosine * cosine_ + c.sine * sine_);
  }
  double along(const PostGeometry::Row& r, double height, double across) const {
    return (r.normalRadius + height) * r.cosine * across + (r.polarRadius + height) * r.sine * north_ - base_;
  }
  const PostGeometry& geometry_;
  double out_, north_, cosine_,
      sine_;  ///< the plane's normal: from the axis, along it; where its meridian is
  double base_;
  std::vector<double> across_;  ///< of the columns asked for last
  std::uint32_t firstColumn_ = 0, stride_ = 0;
};

}  // namespace trimtab::terrain
