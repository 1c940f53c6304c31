#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "page.h"

namespace trimtab::terrain {

/// Turns errors along the normal of the page's plane into bounds of errors along the vertical.
///
/// Let a triangle have the corners P_i, and let S be a post in it with weights w_i over columns and rows. D =
/// S - sum w_i P_i would be vertical if rows and columns were straight; its sideways part is D_h. The plane
/// of the page, whose normal leans by at most `lean`, shows an error of (t + slope * D_h) cos(lean) + D_h
/// sin(lean), where t is the error along the vertical of S. So |t| <= shown / cos(lean) + (slope + tan(lean))
/// |D_h|. resources/docs/levels-of-detail.md derives it ("The error that a patch states"). If the vertical of
/// S meets the triangle beside, the slope of that one counts; callers pass the steepest triangle around a
/// vertex.
class VerticalBound {
 public:
  /// Columns meet at a pole. Posts closer together than this are not told apart.
  static constexpr double kShortestM = 0.01;
  /// The size of a triangle in columns, rows and metres of height.
  struct Extent {
    double columns, rows, rise;
  };

  VerticalBound(const PostGrid& posts, const PostGeometry& geometry, const PostWindow& window)
      : stepLongitude_(posts.stepLongitude * kRadian),
        stepLatitude_(posts.stepLatitude * kRadian),
        firstRow_(window.row) {
    for (const std::uint32_t r : {window.row, window.row + window.rows - 1}) {
      const double latitude = posts.latitude(r) * kRadian;
      sine_ = std::max(sine_, std::abs(std::sin(latitude)));
      cosine_ = std::max(cosine_, std::cos(latitude));
    }
    if (posts.latitude(window.row) < 0 && posts.latitude(window.row + window.rows - 1) > 0) cosine_ = 1;
    const double wide = window.columns * stepLongitude_ * cosine_, high = window.rows * stepLatitude_;
    const double lean = std::min(1.5, 0.51 * std::hypot(wide, high) + 1e-6);
    cosLean_ = std::cos(lean);
    tanLean_ = std::tan(lean);
    const double equator = std::clamp(-posts.south / posts.stepLatitude, 0.0, posts.rows - 1.0);
    equator_ = static_cast<std::uint32_t>(std::lround(equator));
    perMetre_.reserve(window.rows);
    for (std::uint32_t r = window.row; r < window.row + window.rows; ++r) {
      cosines_.push_back(std::cos(posts.latitude(r) * kRadian));
      const double column = 1 / std::max(kShortestM, geometry.columnM(r)), row = 1 / geometry.rowM(r);
      perMetre_.push_back({column * column, row * row});
    }
  }
  double cosLean() const { return cosLean_; }

  /// Returns the square of the slope of the triangle with corners `c` of a draft, rise over run.
  double steepness(const PatchDraft& draft, const std::uint32_t* c) const {
    const PatchPoint &p = draft.vertices[c[0]], &q = draft.vertices[c[1]], &r = draft.vertices[c[2]];
    const auto apart = [](std::uint32_t to, std::uint32_t from) {
      return static_cast<double>(static_cast<std::int32_t>(to - from));
    };
    const double bx = apart(q.column, p.column), by = apart(q.row, p.row), cx = apart(r.column, p.column),
                 cy = apart(r.row, p.row);
    const double z = draft.z[c[0]], bz = draft.z[c[1]] - z, cz = draft.z[c[2]] - z;
    const double perArea = 1 / (bx * cy - by * cx);
    const double byColumn = (bz * cy - cz * by) * perArea, byRow = (bx * cz - cx * bz) * perArea;
    // Both steps are shortest at an end of the triangle's rows.
    const PerMetre &first = perMetre_[std::min({p.row, q.row, r.row}) - firstRow_],
                   &last = perMetre_[std::max({p.row, q.row, r.row}) - firstRow_];
    return byColumn * byColumn * std::max(first.column, last.column) +
           byRow * byRow * std::max(first.row, last.row);
  }
  double slope(double steepness) const { return (std::sqrt(steepness) + tanLean_) * 1.02; }
  double leaning(double steepness) const { return slope(steepness) + tanLean_; }

  static Extent extent(const PatchDraft& draft, const std::uint32_t* c) {
    const auto of = [&](const auto& p, const auto& q, const auto& r) {
      return static_cast<double>(std::max({p, q, r}) - std::min({p, q, r}));
    };
    const PatchPoint &p = draft.vertices[c[0]], &q = draft.vertices[c[1]], &r = draft.vertices[c[2]];
    return {of(p.column, q.column, r.column), of(p.row, q.row, r.row),
            of(draft.heights[c[0]], draft.heights[c[1]], draft.heights[c[2]])};
  }
  /// Returns a bound on |D_h| in a triangle, metres.
  double sideways(const Extent& of) const {
    const double lon = of.columns * stepLongitude_, lat = of.rows * stepLatitude_;
    return sideways(lon, lat, of.rise, std::sqrt(lon * cosine_ * (lon * cosine_) + lat * lat));
  }
  /// Returns a larger bound that is quicker to compute.
  double atMostSideways(const Extent& of) const {
    const double lon = of.columns * stepLongitude_, lat = of.rows * stepLatitude_;
    return sideways(lon, lat, of.rise, lon * cosine_ + lat);
  }
  /// Returns how far a triangle's plane may lie below the curved earth through its corners, metres. On a
  /// sphere of radius R the point Q = sum w_i P_i has |Q|^2 = R^2 - sum w_i w_j |P_i - P_j|^2 over pairs i <
  /// j, and that sum is at most R^2 x / 4, where x is the square of the extent.
  double sagM(const PatchDraft& draft, const std::uint32_t* c, const Extent& of) const {
    const auto [south, north] =
        std::minmax({draft.vertices[c[0]].row, draft.vertices[c[1]].row, draft.vertices[c[2]].row});
    const double cosine = cosines_[std::clamp(equator_, south, north) - firstRow_];
    const double wide = of.columns * stepLongitude_ * cosine, high = of.rows * stepLatitude_;
    const double eighth = std::min(0.5, (wide * wide + high * high) / 8);
    return kFarthestM * eighth / (1 - eighth);
  }

 private:
  static constexpr double kRadian = std::numbers::pi / 180;
  /// No post is farther from the centre of the earth, and no radius of curvature is longer.
  static constexpr double kFarthestM = 6.42e6;

  double sideways(double lon, double lat, double rise, double angle) const {
    return kFarthestM / 8 *
               (cosine_ * (sine_ + angle) * lon * lon + 2 * sine_ * lon * lat + (0.011 + angle) * lat * lat) +
           rise * angle / 2;
  }

  /// Columns and rows per metre, squared.
  struct PerMetre {
    double column, row;
  };
  double stepLongitude_, stepLatitude_;
  std::uint32_t firstRow_;
  std::uint32_t equator_ = 0;  ///< the row nearest to it
  double sine_ = 0, cosine_ = 0, cosLean_ = 0, tanLean_ = 0;
  std::vector<PerMetre> perMetre_;  ///< by row of the window
  std::vector<double> cosines_;     ///< of the latitude, by row of the window
};

}  // namespace trimtab::terrain
