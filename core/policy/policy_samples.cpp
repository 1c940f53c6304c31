#include "policy_samples.h"

#include <algorithm>
#include <cmath>

namespace trimtab {
namespace {

/// Adds where the membership of a term begins or ends to change, or is half.
void addNumbers(const PolicyTerm& term, std::vector<double>& edges) {
  const std::vector<double>& n = term.numbers;
  switch (term.shape) {
    case TermShape::points:
      for (std::size_t i = 0; i + 1 < n.size(); i += 2) edges.push_back(n[i]);
      break;
    case TermShape::triangle:
    case TermShape::trapezoid:
    case TermShape::ramp:
      edges.insert(edges.end(), n.begin(), n.end());
      break;
    case TermShape::gaussian:
      for (const double deviations : {-2.0, -1.0, 0.0, 1.0, 2.0}) edges.push_back(n[0] + deviations * n[1]);
      break;
    case TermShape::bell:
      for (const double widths : {-2.0, -1.0, 0.0, 1.0, 2.0}) edges.push_back(n[0] + widths * n[1]);
      break;
    case TermShape::sigmoid:
      for (const double steps : {-3.0, 0.0, 3.0}) edges.push_back(n[0] + steps / n[1]);
      break;
  }
}

/// Returns a well spread number in 0..1 (a bit mixer, the same on every machine).
double mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  x ^= x >> 31;
  return static_cast<double>(x >> 11) * 0x1p-53;
}

}  // namespace

PolicySamples::PolicySamples(const Policy& policy, std::uint32_t asked) {
  for (const SignalRow& row : kSignalRows) {
    if (!(asked >> static_cast<unsigned>(row.signal) & 1)) continue;
    std::vector<double> edges{row.range.low, row.range.high};
    for (const PolicyTerm& term : policy.terms)
      if (term.signal == row.signal) addNumbers(term, edges);
    std::erase_if(edges, [&](double x) { return !(x >= row.range.low && x <= row.range.high); });
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    signals_.push_back(row.signal);
    edges_.push_back(std::move(edges));
  }
}

void PolicySamples::put(Place& place, std::size_t dimension, std::size_t cell, double part) const {
  place.cell[dimension] = cell;
  place.values[signals_[dimension]] = std::lerp(edge(dimension, cell), edge(dimension, cell + 1), part);
}

PolicySamples::Place PolicySamples::at(std::uint64_t number) const {
  Place place;
  for (std::size_t d = 0; d < signals_.size(); ++d) {
    const double scaled = mixed(number * kSignals + d) * static_cast<double>(cells(d));
    const std::size_t cell = std::min(static_cast<std::size_t>(scaled), cells(d) - 1);
    // A third of all places lie on an edge, where memberships have their extremes.
    const double part = scaled - static_cast<double>(cell);
    put(place, d, cell, std::clamp(1.5 * part - 0.25, 0.0, 1.0));
  }
  return place;
}

}  // namespace trimtab
