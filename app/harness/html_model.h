#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/plot/plot.h"
#include "results.h"

/// What the sections of the page share: names and looks of units, and numbers as text.
namespace trimtab::harness {

/// Results by flight, preset and case, each in the order of its first unit. A preset is a colour, a case a
/// shape or a dash, on the whole page.
class ReportModel {
 public:
  explicit ReportModel(const Results& results);

  const Results& results;
  std::vector<std::string> flights, presets, cases;

  std::vector<const Unit*> unitsOf(const std::string& flight) const;
  const Unit* unit(const std::string& flight, const std::string& preset, const std::string& method) const;
  int presetLook(const std::string& preset) const;
  int caseLook(const std::string& method) const;
  /// Colours (and dashes, where lines join cases) of presets and shapes of cases.
  std::vector<plot::Key> keys() const;
  const Summary& summary(const Unit& unit, const Quantity& quantity) const;
  /// Whether any frame of any unit has it.
  bool measured(const Quantity& quantity) const;
  /// The number that stands for a unit: the mean, or where frames without a finite one spoil it, the median.
  double centre(const Unit& unit, const Quantity& quantity) const;

 private:
  mutable std::map<std::pair<const Unit*, const Quantity*>, Summary> summaries_;
};

/// "view_frustum" as people read it.
std::string caseText(const std::string& method);
/// "preset · case".
std::string unitText(const UnitName& name);
/// Three digits that count, whole numbers in groups of three; nothing for NaN.
std::string numberText(double value, const Quantity& quantity);
std::string roundedText(double value);
std::string wholeText(double value);
/// What is too short to matter is told as such.
std::string msText(double value);
std::string ratioText(double value);
/// "frame time (ms)".
std::string axisText(const Quantity& quantity);
std::vector<double> finiteOf(const Unit& unit, const Quantity& quantity);

}  // namespace trimtab::harness
