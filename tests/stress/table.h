#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace trimtab::stress {

/// Whether TRIMTAB_STRESS_LONG is set: the same cases with about a hundred times the samples.
bool isLong();
inline std::size_t samples(std::size_t quick, std::size_t longer) {
  return isLong() ? longer : quick;
}
inline std::size_t samples(std::size_t quick) {
  return samples(quick, quick * 100);
}

/// One row of the table: the worst error of a case against its bound. The row is entered, and the test that
/// holds it fails where the bound does not hold or nothing was seen, when it goes out of scope.
///
/// A bound of 0 means exactly equal, or a count of violations that must be none: such a row has no margin.
/// `why` derives the bound, in a line.
class Case {
 public:
  Case(std::string field, std::string name, double bound, std::string unit, std::string why);
  ~Case();
  Case(const Case&) = delete;
  Case& operator=(const Case&) = delete;

  /// An error that is not a number is infinite.
  void see(double error) {
    ++seen_;
    if (std::isnan(error)) error = std::numeric_limits<double>::infinity();
    if (error > worst_) worst_ = error;
  }
  /// The same; `where` says where it was, once it is the worst so far.
  template <class Where>
  void see(double error, const Where& where) {
    const double before = worst_;
    see(error);
    if (worst_ > before) at_ = where();
  }
  /// One more violation unless `fine`.
  void require(bool fine) { violate(!fine); }
  template <class Where>
  void require(bool fine, const Where& where) {
    if (!fine && worst_ == 0) at_ = where();
    violate(!fine);
  }

 private:
  void violate(bool violated) {
    ++seen_;
    if (violated) worst_ += 1;
  }

  std::size_t row_;
  std::string at_;
  double worst_ = 0;
  std::size_t seen_ = 0;
};

/// Numbers for `where`, with all their digits.
std::string digits(double value);

}  // namespace trimtab::stress
