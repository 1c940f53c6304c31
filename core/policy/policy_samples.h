#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/policy/policy.h"

namespace trimtab {

/// Places in the space of the signals at which something may change: the numbers of the terms cut the range
/// of each signal into cells. A fixed sequence of places spends as much on a narrow cell as on a wide one.
class PolicySamples {
 public:
  /// Uses the terms over the signals in `asked` (bit s: signal s).
  PolicySamples(const Policy& policy, std::uint32_t asked);

  /// Returns the signals that vary.
  const std::vector<Signal>& signals() const { return signals_; }
  std::size_t cells(std::size_t dimension) const { return edges_[dimension].size() - 1; }
  /// Returns the edge before a cell, or the end of the range for the number of cells.
  double edge(std::size_t dimension, std::size_t cell) const { return edges_[dimension][cell]; }

  struct Place {
    std::array<std::size_t, kSignals> cell{};  ///< for each dimension
    SignalValues values;                       ///< NaN for signals that do not vary
  };
  /// Returns the place with this number of the sequence.
  Place at(std::uint64_t number) const;
  /// Puts one signal of a place into another cell, at a part 0..1 of it.
  void put(Place& place, std::size_t dimension, std::size_t cell, double part) const;

 private:
  std::vector<Signal> signals_;
  std::vector<std::vector<double>> edges_;
};

}  // namespace trimtab
