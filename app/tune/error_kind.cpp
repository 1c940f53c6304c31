#include "error_kind.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "trimtab/units/number.h"

namespace trimtab::tune {

ErrorKind errorKindOf(std::string_view key) {
  const auto* const row = std::find_if(std::begin(kErrorKindRows), std::end(kErrorKindRows),
                                       [key](const ErrorKindRow& r) { return r.key == key; });
  return row == std::end(kErrorKindRows) ? ErrorKind::flip : row->kind;
}

std::string errorText(ErrorKind kind, double error) {
  const ErrorKindRow& row = rowOf(kind);
  return std::string(row.before) + numberText(error, 2) + std::string(row.unit);
}

double rankOf(std::vector<double>& samples, double fraction) {
  const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(samples.size())));
  const auto at =
      samples.begin() + static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(rank, 1, samples.size()) - 1);
  std::nth_element(samples.begin(), at, samples.end());
  return *at;
}

double errorOfImages(ErrorKind kind, std::vector<double>& images) {
  return kind == ErrorKind::pop ? rankOf(images, 0.95) : errorOfFlights(kind, images);
}

double errorOfFlights(ErrorKind kind, std::span<const double> flights) {
  if (flights.empty()) return std::numeric_limits<double>::quiet_NaN();
  if (kind != ErrorKind::flip) return *std::max_element(flights.begin(), flights.end());
  return std::accumulate(flights.begin(), flights.end(), 0.0) / static_cast<double>(flights.size());
}

}  // namespace trimtab::tune
