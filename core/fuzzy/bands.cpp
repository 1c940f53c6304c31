#include "trimtab/fuzzy/bands.h"

namespace trimtab {

int bandOf(const BandList& bands, double total) {
  int band = -1;
  for (const Band& b : bands.span()) {
    if (!(total >= b.low)) break;
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
  while (band < plain && total >= low(band + 1) + hysteresis) ++band;
  while (band > plain && total < low(band) - hysteresis) --band;
  return {band, band != plain};
}

}  // namespace trimtab
