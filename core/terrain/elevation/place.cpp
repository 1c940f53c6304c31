#include <algorithm>
#include <cmath>
#include <limits>

#include "file.h"

/// Finds where posts of a grid lie in a file's raster.
namespace trimtab::terrain {

namespace {

/// Posts that coincide within a thousandth are the same.
constexpr double kSame = 1e-3;

double snapped(double x) {
  const double whole = std::round(x);
  return std::abs(x - whole) < kSame ? whole : x;
}

}  // namespace

bool ElevationFile::placeOn(const PostGrid& grid, Sampling sampling) {
  grid_ = grid;
  // A post beyond its own, so that neighbours meet; two where its posts stand askew to the grid's.
  const auto span = [](double from, double to, std::uint32_t count) {
    const double first = std::max(0.0, std::ceil(from)), last = std::min(count - 1.0, std::floor(to));
    return last < first
               ? std::pair<std::uint32_t, std::uint32_t>{0, 0}
               : std::pair{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last - first) + 1};
  };
  const double marginX = own_.stepLongitude * (direct_ ? 1 : 2),
               marginY = own_.stepLatitude * (direct_ ? 1 : 2);
  std::tie(column_, columns_) =
      span((own_.west - marginX - grid.west) / grid.stepLongitude,
           (own_.longitude(own_.columns - 1) + marginX - grid.west) / grid.stepLongitude, grid.columns);
  std::tie(row_, rows_) =
      span((own_.south - marginY - grid.south) / grid.stepLatitude,
           (own_.latitude(own_.rows - 1) + marginY - grid.south) / grid.stepLatitude, grid.rows);
  if (columns_ == 0 || rows_ == 0) return false;
  if (direct_) {
    footprintX_ = grid.stepLongitude / own_.stepLongitude;
    footprintY_ = grid.stepLatitude / own_.stepLatitude;
    stride_ = vertical_.toFile ? 16 : 1;
    if (sampling == Sampling::points) footprintX_ = footprintY_ = stride_ = 1;
    return true;
  }
  const OGRSpatialReference from = degreesOfWgs84();
  toFile_.reset(OGRCreateCoordinateTransformation(&from, &raster_.crs));
  if (!toFile_ || !GDALInvGeoTransform(raster_.transform.data(), inverse_.data())) return false;
  if (sampling == Sampling::points) {
    footprintX_ = footprintY_ = stride_ = 1;
    return true;
  }
  const std::uint32_t c = column_ + columns_ / 2, r = row_ + rows_ / 2;
  const auto here = exact(r, c, 2, 1), up = exact(r + 1, c, 1, 1);
  footprintX_ = std::max(std::abs(here[1].x - here[0].x), std::abs(up[0].x - here[0].x));
  footprintY_ = std::max(std::abs(here[1].y - here[0].y), std::abs(up[0].y - here[0].y));
  stride_ = lattice();
  return true;
}

std::vector<ElevationFile::Place> ElevationFile::exact(std::uint32_t row, std::uint32_t firstColumn,
                                                       std::uint32_t count, std::uint32_t stride) const {
  std::vector<Place> places(count);
  std::vector<double> x(count), y(count), z(count);
  const double latitude = grid_.latitude(row);
  const auto fill = [&] {
    for (std::uint32_t i = 0; i < count; ++i)
      x[i] = std::remainder(grid_.longitude(firstColumn + static_cast<double>(i) * stride), 360.0),
      y[i] = latitude, z[i] = 0;
  };
  const std::unique_ptr<int[]> good(new int[count]);
  if (direct_) {
    for (std::uint32_t i = 0; i < count; ++i)
      places[i] = {snapped((grid_.longitude(firstColumn + static_cast<double>(i) * stride) - own_.west) /
                           own_.stepLongitude),
                   snapped((latitude - own_.south) / own_.stepLatitude), 0};
  } else {
    fill();
    const GdalErrors quiet;
    toFile_->Transform(static_cast<int>(count), x.data(), y.data(), nullptr, good.get());
    const double middle = raster_.transform[0] + raster_.transform[1] * static_cast<double>(across_) / 2 +
                          raster_.transform[2] * static_cast<double>(down_) / 2;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!good[i] || !std::isfinite(x[i]) || !std::isfinite(y[i])) {
        places[i].x = places[i].y = std::nan("");
        continue;
      }
      if (turn_ > 0) x[i] = middle + std::remainder(x[i] - middle, turn_);
      places[i].x = inverse_[0] + inverse_[1] * x[i] + inverse_[2] * y[i] - 0.5;
      places[i].y = inverse_[3] + inverse_[4] * x[i] + inverse_[5] * y[i] - 0.5;
    }
  }
  if (vertical_.toFile) {
    fill();
    const GdalErrors quiet;
    vertical_.toFile->Transform(static_cast<int>(count), x.data(), y.data(), z.data(), good.get());
    for (std::uint32_t i = 0; i < count; ++i)
      places[i].lift = good[i] && std::isfinite(z[i]) ? -z[i] * *vertical_.unit : std::nan("");
  }
  return places;
}

/// Returns the widest stride of exact places whose bilinear reading is good to 1/500 of the raster's posts
/// wherever it is tried.
std::uint32_t ElevationFile::lattice() const {
  constexpr std::uint32_t kTries = 12;
  const auto reachesPole = [&](std::uint32_t stride) {
    const double up = grid_.latitude(row_ + rows_ + stride),
                 below = grid_.latitude(static_cast<double>(row_) - stride);
    return up >= 90 || below <= -90;
  };
  for (std::uint32_t stride = 16; stride > 1; stride /= 2) {
    if (reachesPole(stride)) continue;
    bool good = true;
    for (std::uint32_t j = 0; j <= kTries && good; ++j)
      for (std::uint32_t i = 0; i <= kTries && good; ++i) {
        const std::uint32_t row = (row_ + (rows_ - 1) * j / kTries) / stride * stride,
                            column = (column_ + (columns_ - 1) * i / kTries) / stride * stride;
        const auto low = exact(row, column, 2, stride), high = exact(row + stride, column, 2, stride),
                   middle = exact(row + stride / 2, column + stride / 2, 1, 1);
        const double x = (low[0].x + low[1].x + high[0].x + high[1].x) / 4,
                     y = (low[0].y + low[1].y + high[0].y + high[1].y) / 4;
        good = std::abs(x - middle[0].x) < 0.002 && std::abs(y - middle[0].y) < 0.002;
      }
    if (good) return stride;
  }
  return 1;
}

void ElevationFile::findPlaces(const Rectangle& posts, std::vector<Place>& places) const {
  places.resize(std::size_t{posts.rows} * posts.columns);
  if (stride_ == 1 && direct_) {
    // Columns do not know of rows.
    const auto columns = exact(posts.row, posts.column, posts.columns, 1);
    Place* to = places.data();
    for (std::uint32_t r = 0; r < posts.rows; ++r, to += posts.columns) {
      const double y = exact(posts.row + r, posts.column, 1, 1)[0].y;
      for (std::uint32_t c = 0; c < posts.columns; ++c) to[c] = {columns[c].x, y, 0};
    }
    return;
  }
  if (stride_ == 1) {
    for (std::uint32_t r = 0; r < posts.rows; ++r) {
      const auto row = exact(posts.row + r, posts.column, posts.columns, 1);
      std::copy(row.begin(), row.end(),
                places.begin() + static_cast<std::ptrdiff_t>(std::size_t{r} * posts.columns));
    }
    return;
  }
  const std::uint32_t firstColumn = posts.column / stride_ * stride_,
                      count = (posts.column + posts.columns - 1) / stride_ - posts.column / stride_ + 2;
  std::vector<Place> low, high;
  std::uint32_t lowRow = std::numeric_limits<std::uint32_t>::max();
  for (std::uint32_t r = 0; r < posts.rows; ++r) {
    const std::uint32_t row = posts.row + r, from = row / stride_ * stride_;
    if (from != lowRow) {
      low = from == lowRow + stride_ && !high.empty() ? std::move(high)
                                                      : exact(from, firstColumn, count, stride_);
      high = exact(from + stride_, firstColumn, count, stride_);
      lowRow = from;
    }
    const double v = static_cast<double>(row - from) / stride_;
    for (std::uint32_t c = 0; c < posts.columns; ++c) {
      const std::uint32_t column = posts.column + c, k = (column - firstColumn) / stride_;
      const double u = static_cast<double>(column % stride_) / stride_;
      const auto between = [&](double Place::*member) {
        return (low[k].*member * (1 - u) + low[k + 1].*member * u) * (1 - v) +
               (high[k].*member * (1 - u) + high[k + 1].*member * u) * v;
      };
      Place& place = places[std::size_t{r} * posts.columns + c];
      place.lift = between(&Place::lift);
      // About the end of what PROJ knows each post by itself.
      if (std::isnan(place.lift) && !(std::isnan(low[k].lift) && std::isnan(low[k + 1].lift) &&
                                      std::isnan(high[k].lift) && std::isnan(high[k + 1].lift)))
        place.lift = exact(row, column, 1, 1)[0].lift;
      if (direct_) {
        place.x = snapped((grid_.longitude(column) - own_.west) / own_.stepLongitude);
        place.y = snapped((grid_.latitude(row) - own_.south) / own_.stepLatitude);
      } else {
        place.x = between(&Place::x);
        place.y = between(&Place::y);
      }
    }
  }
}

}  // namespace trimtab::terrain
