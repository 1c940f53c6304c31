#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/plot/plot.h"
#include "results.h"

/// What the sections of the HTML page share: names and looks of units, and numbers as text.
namespace trimtab::harness {

/// Gives results by flight, preset and case, each in the order of its first unit. On the whole page a preset
/// has one colour and a case one shape or dash.
class ReportModel {
 public:
  explicit ReportModel(const Results& results);

  const Results& results;
  std::vector<std::string> flights, presets, cases;

  std::vector<const Unit*> unitsOf(const std::string& flight) const;
  const Unit* unit(const std::string& flight, const std::string& preset, const std::string& method) const;
  int presetLook(const std::string& preset) const;
  int caseLook(const std::string& method) const;
  /// Returns the entries of a legend: colours (and dashes) of presets, shapes of cases.
  std::vector<plot::Key> keys() const;
  const Summary& summary(const Unit& unit, const Quantity& quantity) const;
  /// Reports whether any frame of any unit has the quantity.
  bool measured(const Quantity& quantity) const;
  /// Returns the number that represents a unit: the mean, or the median if the mean is not finite.
  double centre(const Unit& unit, const Quantity& quantity) const;

 private:
  mutable std::map<std::pair<const Unit*, const Quantity*>, Summary> summaries_;
};

/// Returns the name of a case for people to read, such as "view frustum" for "view_frustum".
std::string caseText(const std::string& method);
/// Returns "preset · case".
std::string unitText(const UnitName& name);
/// Returns three significant digits, or a whole number in groups of three digits. Empty for NaN.
std::string numberText(double value, const Quantity& quantity);
std::string roundedText(double value);
std::string wholeText(double value);
/// Returns milliseconds, and says so if a time is too short to matter.
std::string msText(double value);
std::string ratioText(double value);
/// Returns the interval, such as "0.98 to 1.02"; empty if nothing was measured.
std::string intervalText(const PairedRatio& ratio);
/// Returns a label with its unit, such as "frame time (ms)".
std::string axisText(const Quantity& quantity);
std::vector<double> finiteOf(const Unit& unit, const Quantity& quantity);

}  // namespace trimtab::harness
