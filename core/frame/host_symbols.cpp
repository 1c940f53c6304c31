#include "trimtab/frame/host_symbols.h"

#include <algorithm>
#include <cmath>

namespace trimtab {
namespace {

template <class T>
const T* findById(const std::vector<T>& sorted, std::uint16_t id) {
  const auto at = std::lower_bound(sorted.begin(), sorted.end(), id,
                                   [](const T& t, std::uint16_t i) { return t.id < i; });
  return at != sorted.end() && at->id == id ? &*at : nullptr;
}

bool isDark(const HostSymbol& symbol, double timeS) {
  if (symbol.dutyPercent >= 100) return false;
  if (symbol.dutyPercent == 0) return true;
  if (!(symbol.flashPeriodS > 0) || !std::isfinite(timeS)) return false;
  const double phase = timeS / static_cast<double>(symbol.flashPeriodS);
  return (phase - std::floor(phase)) * 100 >= symbol.dutyPercent;
}

}  // namespace

bool operator==(const HostSymbol& a, const HostSymbol& b) {
  const bool sameShape = a.shape == b.shape || (a.shape && b.shape && *a.shape == *b.shape);
  return sameShape && a.id == b.id && a.parent == b.parent && a.surface == b.surface &&
         a.visible == b.visible && a.attached == b.attached && a.inheritsColour == b.inheritsColour &&
         a.layer == b.layer && a.dutyPercent == b.dutyPercent && a.flashPeriodS == b.flashPeriodS &&
         a.u == b.u && a.v == b.v && a.rotationDeg == b.rotationDeg && a.scaleU == b.scaleU &&
         a.scaleV == b.scaleV && a.rgba == b.rgba;
}

const HostSurface* HostSymbols::surface(std::uint16_t id) const {
  return findById(surfaces, id);
}
const HostSymbol* HostSymbols::symbol(std::uint16_t id) const {
  return findById(symbols, id);
}

std::vector<std::uint16_t> darkSymbols(const HostSymbols& symbols, double timeS) {
  std::vector<std::uint16_t> dark;
  for (const HostSymbol& symbol : symbols.symbols)
    if (symbol.visible && isDark(symbol, timeS)) dark.push_back(symbol.id);
  return dark;
}

}  // namespace trimtab
