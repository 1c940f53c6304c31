#include "trimtab/terrain/grid/post_geometry.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace trimtab::terrain {

namespace {

constexpr double kA = 6378137.0, kF = 1 / 298.257223563, kE2 = kF * (2 - kF);  // WGS84
constexpr double kRadian = std::numbers::pi / 180;

/// Rounds to a whole number without a call: exact below 2^51.
double rounded(double x) {
  constexpr double kBig = 6755399441055744.0;  // 1.5 * 2^52
  return (x + kBig) - kBig;
}

}  // namespace

PostGeometry::PostGeometry(const PostGrid& posts)
    : stepLongitudeRad_(posts.stepLongitude * kRadian), stepLatitudeRad_(posts.stepLatitude * kRadian) {
  rows_.reserve(posts.rows);
  for (std::uint32_t r = 0; r < posts.rows; ++r) {
    const double latitude = posts.latitude(r) * kRadian;
    const double sine = std::sin(latitude), cosine = std::cos(latitude);
    const double w2 = 1 - kE2 * sine * sine, n = kA / std::sqrt(w2);
    rows_.push_back({sine, cosine, n, n * (1 - kE2), n * cosine, n * (1 - kE2) / w2});
  }
  columns_.reserve(posts.columns);
  for (std::uint32_t c = 0; c < posts.columns; ++c) {
    const double longitude = posts.longitude(c) * kRadian;
    columns_.push_back({std::sin(longitude), std::cos(longitude)});
  }
  frame_ = LocalFrame(GeodeticPosition{Degrees{posts.latitude((posts.rows - 1) / 2.0)},
                                       wrapped180(Degrees{posts.longitude((posts.columns - 1) / 2.0)}),
                                       Metres{0}});
  localOriginEcef_ = trimtab::toEcef(frame_.origin());

  const auto levels = makeLevels(posts).levels.size();
  const double widest = std::max_element(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) {
                          return a.radius < b.radius;
                        })->radius;
  for (std::size_t level = 0; level < levels; ++level) {
    const double cells = static_cast<double>(std::uint64_t{TerrainIndex::kTileCells} << level);
    const double wide = std::min(cells, posts.columns - 1.0) * widest * stepLongitudeRad_;
    const double high = std::min(cells, posts.rows - 1.0) * kA * stepLatitudeRad_;
    // The reach is half of the tile from its middle, and 20 km for heights.
    const double reach = std::hypot(wide, high) / 2 + 20000;
    std::uint8_t shift = 0;
    while (reach > kReachM * std::ldexp(1.0, shift)) ++shift;
    shiftOfLevel_.push_back(shift);
    if (shift == 0) unshifted_ = 2 * unshifted_ + 1;
  }
}

/// The coarsest level that has the post decides; the last row and column are in all levels.
int PostGeometry::shiftOf(std::uint32_t row, std::uint32_t column) const {
  const bool lastRow = row + 1 == rows_.size(), lastColumn = column + 1 == columns_.size();
  if ((!lastRow && (row & unshifted_) != 0) || (!lastColumn && (column & unshifted_) != 0)) return 0;
  const int top = static_cast<int>(shiftOfLevel_.size()) - 1;
  const int byRow = lastRow ? top : std::countr_zero(row);
  const int byColumn = lastColumn ? top : std::countr_zero(column);
  return shiftOfLevel_[static_cast<std::size_t>(std::min({byRow, byColumn, top}))];
}

PostGeometry::Lattice PostGeometry::lattice(std::uint32_t row, std::uint32_t column, double height) const {
  const Row& r = rows_[row];
  const Column& c = columns_[column];
  const double out = (r.normalRadius + height) * r.cosine;
  const Vec3 local =
      frame_.ecefToLocal() *
      (Vec3{out * c.cosine, out * c.sine, (r.polarRadius + height) * r.sine} - localOriginEcef_);
  const int shift = shiftOf(row, column);
  const double steps = static_cast<double>(kStepsPerMetre) *
                       (shift == 0 ? 1.0 : 1 / static_cast<double>(std::int64_t{1} << shift));
  const auto whole = [&](double metres) {
    return static_cast<std::int64_t>(rounded(metres * steps)) << shift;
  };
  return {whole(local.x), whole(local.y), whole(local.z)};
}

Vec3 PostGeometry::onEllipsoid(std::uint32_t row, std::uint32_t column) const {
  const Row& r = rows_[row];
  return {r.radius * columns_[column].cosine, r.radius * columns_[column].sine, r.polarRadius * r.sine};
}

Vec3 PostGeometry::normal(std::uint32_t row, std::uint32_t column, double east, double north) const {
  const Row& r = rows_[row];
  const Column& c = columns_[column];
  // up - east * E - north * N, E, N and up written in ECEF.
  const double out = r.cosine + north * r.sine;
  const Vec3 n{out * c.cosine + east * c.sine, out * c.sine - east * c.cosine, r.sine - north * r.cosine};
  return frame_.ecefToLocal() * (n * (1 / std::sqrt(1 + east * east + north * north)));
}

double PostGeometry::sagM(std::uint32_t level) const {
  // Linear interpolation of position over a right triangle is off by at most 1/8 of the second derivatives
  // across its hypotenuse; those of a point on the ellipsoid by longitude and latitude are R cos, R sin and
  // R.
  const double lon = std::ldexp(stepLongitudeRad_, static_cast<int>(level)),
               lat = std::ldexp(stepLatitudeRad_, static_cast<int>(level));
  double cosine = 0, sine = 0;
  for (const Row& row : rows_)
    cosine = std::max(cosine, row.cosine), sine = std::max(sine, std::abs(row.sine));
  return 6.42e6 / 8 * (cosine * lon * lon + 2 * sine * lon * lat + lat * lat);
}

double PostGeometry::roundingM() const {
  return std::ldexp(std::sqrt(3.0) / 2 / static_cast<double>(kStepsPerMetre), shiftOfLevel_.back());
}

}  // namespace trimtab::terrain
