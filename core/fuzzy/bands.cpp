#include "trimtab/fuzzy/bands.h"

namespace trimtab {

namespace {

/// A total within this much below an edge counts as on it. Memberships are sums of a few rounded terms of at
/// most 2, so a total that the tables put on an edge misses it by some 1e-16: 30,000 ft at 24 degrees nose-up
/// gives 0.09999999999999998 for 0.1. No instrument resolves 1e-12 of membership (4e-9 ft, 6e-11 degrees).
constexpr double kRounding = 1e-12;

bool reaches(double total, double edge) {
  // A total of 0 is exact, and lies below every edge however small.
  return total >= edge || (total > 0 && total >= edge - kRounding);
}

}  // namespace

int bandOf(const BandList& bands, double total) {
  int band = -1;
  for (const Band& b : bands.span()) {
    if (!reaches(total, b.low)) break;
    ++band;
  }
  return band;
}

BandChoice nextBand(const BandList& bands, double hysteresis, double total, std::optional<int> previous) {
  const int plain = bandOf(bands, total);
  const int last = static_cast<int>(bands.size) - 1;
  if (!previous || *previous < -1 || *previous > last || total <= 0 || total >= BandList::kTop)
    return {plain, false};
  const auto low = [&bands](int band) { return bands.band[static_cast<std::size_t>(band)].low; };
  int band = *previous;
  while (band < plain && reaches(total, low(band + 1) + hysteresis)) ++band;
  while (band > plain && !reaches(total, low(band) - hysteresis)) --band;
  return {band, band != plain};
}

}  // namespace trimtab
