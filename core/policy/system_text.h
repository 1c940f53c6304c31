#pragma once

#include "trimtab/policy/fuzzy_system.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/text.h"

/// Declares what the two languages of fuzzy_system.h share.
namespace trimtab::fuzzy_system {

std::string toFuzzyLite(const System& system);
Result<System> readFuzzyLite(std::string_view text, const std::string& where);
Result<std::string> toMatlab(const System& system);
Result<System> readMatlab(std::string_view text, const std::string& where);

/// A reader refuses what is beyond, so that nothing takes long; policies and rule bases have less.
inline constexpr std::size_t kMostTerms = 4096, kMostRules = 2048, kMostVariables = 256;

/// Returns a reason as the one line that a comment is: control characters become blanks.
std::string oneLine(std::string_view reason);
/// Returns the numbers as text, with blanks between.
std::string numbersText(const std::vector<double>& numbers);

/// The lines of a file, and what is wrong with them.
class Lines {
 public:
  Lines(std::string_view text, const std::string& where) : rest_(withoutByteOrderMark(text)), where_(where) {}

  /// Goes to the next line and returns it without blanks around it; nothing at the end.
  std::optional<std::string_view> next();
  std::string place() const { return where_ + ":" + std::to_string(line_); }

  /// Refuses something in this line, or at the place of an earlier one.
  void refuse(std::string_view key, std::string expected, std::string_view found) {
    refuseAt(place(), key, std::move(expected), found);
  }
  void refuseAt(std::string place, std::string_view key, std::string expected, std::string_view found);
  /// Says how something at a place was read that could not be read as it stands.
  void noteAt(std::string place, std::string_view key, std::string found) {
    findings_.add({Severity::note, std::move(place), std::string(key), "", std::move(found)});
  }
  /// Says what an import lost that its user may miss.
  void warnAt(std::string place, std::string_view key, std::string found) {
    findings_.add({Severity::warning, std::move(place), std::string(key), "", std::move(found)});
  }
  /// Reports whether nothing was refused.
  bool empty() const { return !findings_.hasError(); }
  /// Returns why something was refused; notes only if nothing was.
  Findings findings() const;

 private:
  std::string_view rest_;
  const std::string& where_;
  std::size_t line_ = 0;
  FindingList findings_;
};

}  // namespace trimtab::fuzzy_system
