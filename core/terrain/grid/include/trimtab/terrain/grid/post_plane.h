#pragma once

#include <span>
#include <vector>

#include "trimtab/terrain/grid/post_geometry.h"

namespace trimtab::terrain {

/// Heights of posts above the plane that touches the ellipsoid at one of them.
///
/// These heights are linear in space. A triangle of posts in space is therefore also a triangle of their
/// heights over columns and rows, apart from the sideways bend of rows and columns, and an error that a
/// mesher measures with them includes the earth's curvature.
class PostPlane {
 public:
  PostPlane(const PostGeometry& geometry, std::uint32_t column, std::uint32_t row);

  double at(std::uint32_t column, std::uint32_t row, double height) const {
    const PostGeometry::Row& r = geometry_.rows_[row];
    return along(r, height, across(column));
  }
  /// Computes the heights above the plane of one row, at every `stride`-th column from `column`, into `out`.
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
  std::vector<double> across_;  ///< of the columns of the last call
  std::uint32_t firstColumn_ = 0, stride_ = 0;
};

}  // namespace trimtab::terrain
