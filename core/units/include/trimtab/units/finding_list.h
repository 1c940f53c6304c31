#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <string>

#include "trimtab/units/result.h"

namespace trimtab {

/// Collects the findings about one input. It keeps the first of each severity and counts the others, so that
/// an input with a mistake in every line is refused as quickly, and can be read as well, as one with a few.
class FindingList {
 public:
  static constexpr std::size_t kMost = 20;  ///< of each severity

  void add(Finding finding) {
    if (counts(finding.severity)) findings_.push_back(std::move(finding));
  }
  void add(const Findings& findings) {
    for (const Finding& finding : findings) add(finding);
  }
  /// Adds what `make` returns, which is called only if the finding is kept.
  template <std::invocable Make>
  void add(Severity severity, const Make& make) {
    if (counts(severity)) findings_.push_back(make());
  }

  bool empty() const { return findings_.empty(); }
  bool hasError() const { return count_[static_cast<std::size_t>(Severity::error)] > 0; }
  /// Returns the findings in the order in which they were added, and after them how many more of each
  /// severity there were, as findings about `where`.
  Findings all(const std::string& where) const;

 private:
  bool counts(Severity severity) { return count_[static_cast<std::size_t>(severity)]++ < kMost; }

  Findings findings_;
  std::array<std::size_t, 3> count_{};
};

/// Returns the findings that a FindingList keeps of these.
Findings firstOf(const Findings& findings, const std::string& where);

}  // namespace trimtab
