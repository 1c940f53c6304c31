#pragma once

#include <cstdint>
#include <vector>

#include "trimtab/units/range.h"

namespace trimtab::fuzzy_system {

/// Weighted means of the same constants, one at each place of a grid.
class ConstantMeans {
 public:
  /// Begins the mean of the next place.
  void addPlace() { first_.push_back(first_.back()); }
  /// Adds a constant to the mean of the last place. The shares of a place sum to 1.
  void addShare(std::size_t constant, double share) {
    shares_.push_back({static_cast<std::uint32_t>(constant), share});
    ++first_.back();
  }

  std::size_t places() const { return first_.size() - 1; }
  /// Puts the mean of the constants at each place into `values`.
  void apply(const std::vector<double>& constants, std::vector<double>& values) const;
  /// Puts the sum of what each constant has in the values of all places into `sums`, one for each constant.
  void gather(const std::vector<double>& values, std::vector<double>& sums) const;

 private:
  struct Share {
    std::uint32_t constant;
    double share;
  };
  std::vector<std::size_t> first_{0};  ///< of each place in shares_, and the end
  std::vector<Share> shares_;
};

/// Constants, the differences of the wanted values from their means, and the greatest of them.
struct FittedConstants {
  std::vector<double> constants, differences;
  double most = 0;
};

/// Returns so many constants within a range whose means come near to the values that are wanted, one at each
/// place: by least squares in the first round, and then with the weight of each place multiplied with its
/// difference, which lowers the greatest one (Lawson 1961). The round whose greatest difference is least
/// counts. Each takes the same few steps of conjugate gradients, so the time does not depend on the values.
FittedConstants fitConstants(const ConstantMeans& means, const std::vector<double>& wanted,
                             std::size_t constants, Range within, int rounds);

/// More digits would claim what a fit does not know.
double roundedFit(double constant);

}  // namespace trimtab::fuzzy_system
