#include <algorithm>
#include <cmath>

#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

namespace {

/// Degrees a bucket is wide in the row of whole degrees that starts at `south`.
double bucketWidth(int south) {
  const int away = south >= 0 ? south : -south - 1;  // degrees from the equator of the row's nearer border
  if (away >= 89) return 12;
  if (away >= 86) return 4;
  if (away >= 83) return 2;
  if (away >= 76) return 1;
  if (away >= 62) return 0.5;
  if (away >= 22) return 0.25;
  return 0.125;
}

Bucket none() {
  return {-1, Degrees{0}, Degrees{0}, Degrees{0}, Degrees{0}};
}

}  // namespace

Bucket bucketOf(long index) {
  if (index < 0) return none();
  const long column = index >> 14, row = index >> 6 & 0xff, y = index >> 3 & 7, x = index & 7;
  if (column >= 360 || row >= 180) return none();
  const double width = bucketWidth(static_cast<int>(row) - 90);
  const double west = static_cast<double>(column - 180) + static_cast<double>(x) * std::min(width, 1.0);
  if (static_cast<double>(x) * width >= 1 && x != 0) return none();
  const double south = static_cast<double>(row - 90) + static_cast<double>(y) / 8;
  return {index, Degrees{west}, Degrees{south}, Degrees{west + width}, Degrees{south + 0.125}};
}

Bucket bucketAt(Degrees latitude, Degrees longitude) {
  const double lat = latitude.value(), lon = wrapped180(longitude).value();
  if (!(std::abs(lat) <= 90) || !std::isfinite(lon)) return none();
  const int row = std::min(static_cast<int>(std::floor(lat)), 89);
  const double width = bucketWidth(row);
  const double whole = std::floor(std::min(lon, std::nextafter(180.0, 0.0)));
  double column = whole;
  long x = 0;
  if (width > 1) {
    column = std::max(-180.0, std::floor(whole / width) * width);
  } else {
    x = std::min(static_cast<long>((lon - whole) / width), static_cast<long>(1 / width) - 1);
  }
  const long y = std::min(static_cast<long>((lat - row) * 8), 7L);
  return bucketOf((static_cast<long>(column) + 180) << 14 | static_cast<long>(row + 90) << 6 | y << 3 | x);
}

Bucket bucketNear(Degrees latitude, Degrees longitude) {
  Bucket bucket = bucketAt(latitude, longitude);
  if (bucket.index < 0) return bucket;
  const Degrees turn{360 * std::round((longitude - bucket.west).value() / 360)};
  bucket.west = bucket.west + turn;
  bucket.east = bucket.east + turn;
  return bucket;
}

}  // namespace trimtab::terrain
