#include "html_model.h"

#include <algorithm>
#include <cmath>

#include "app/plot/svg.h"

namespace trimtab::harness {
namespace {

void addOnce(std::vector<std::string>& list, const std::string& name) {
  if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
}
int indexOf(const std::vector<std::string>& list, const std::string& name) {
  return static_cast<int>(std::find(list.begin(), list.end(), name) - list.begin());
}

std::string grouped(std::string digits) {
  const std::size_t start = digits.starts_with('-') ? 1 : 0;
  for (std::size_t at = digits.find('.') == std::string::npos ? digits.size() : digits.find('.');
       at > start + 3;) {
    at -= 3;
    digits.insert(at, ",");
  }
  return digits;
}

}  // namespace

ReportModel::ReportModel(const Results& of) : results(of) {
  for (const Unit& u : results.units) {
    addOnce(flights, u.name.flight);
    addOnce(presets, u.name.preset);
    addOnce(cases, u.name.method);
  }
}

std::vector<const Unit*> ReportModel::unitsOf(const std::string& flight) const {
  std::vector<const Unit*> units;
  for (const Unit& u : results.units)
    if (u.name.flight == flight) units.push_back(&u);
  return units;
}

const Unit* ReportModel::unit(const std::string& flight, const std::string& preset,
                              const std::string& method) const {
  for (const Unit& u : results.units)
    if (u.name == UnitName{flight, preset, method}) return &u;
  return nullptr;
}

int ReportModel::presetLook(const std::string& preset) const {
  return indexOf(presets, preset);
}

int ReportModel::caseLook(const std::string& method) const {
  return indexOf(cases, method);
}

std::vector<plot::Key> ReportModel::keys() const {
  std::vector<plot::Key> keys;
  for (const std::string& preset : presets)
    keys.push_back({preset, presetLook(preset), -1, cases.size() > 1});
  for (const std::string& method : cases) keys.push_back({caseText(method), -1, caseLook(method)});
  return keys;
}

const Summary& ReportModel::summary(const Unit& unit, const Quantity& quantity) const {
  const auto [at, isNew] = summaries_.try_emplace({&unit, &quantity});
  if (isNew) at->second = summarise(unit, quantity);
  return at->second;
}

bool ReportModel::measured(const Quantity& quantity) const {
  return std::any_of(results.units.begin(), results.units.end(),
                     [&](const Unit& u) { return !std::isnan(summary(u, quantity).median); });
}

double ReportModel::centre(const Unit& unit, const Quantity& quantity) const {
  const Summary& s = summary(unit, quantity);
  return std::isinf(s.mean) ? s.median : s.mean;
}

std::string caseText(const std::string& method) {
  std::string text = method;
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string unitText(const UnitName& name) {
  return name.preset + " \xc2\xb7 " + caseText(name.method);
}

std::string roundedText(double value) {
  if (std::isnan(value)) return {};
  if (std::isinf(value)) return value > 0 ? "\xe2\x88\x9e" : "\xe2\x88\x92\xe2\x88\x9e";
  const double size = std::abs(value);
  if (size == 0) return "0";
  if (size >= 100) return grouped(plot::decimal(value, size >= 1000 ? 0 : 1));
  if (size < 1e-6) return plot::tickText(value);
  return plot::decimal(value, 2 - static_cast<int>(std::floor(std::log10(size))));
}

std::string wholeText(double value) {
  return std::isfinite(value) ? grouped(plot::decimal(std::round(value), 0)) : roundedText(value);
}

std::string msText(double value) {
  return value > 0 && value < 0.0005 ? "<0.001" : roundedText(value);
}

std::string ratioText(double value) {
  return std::isfinite(value) ? plot::decimal(value, 3) : roundedText(value);
}

std::string intervalText(const PairedRatio& ratio) {
  return ratio.pairs == 0 ? std::string() : ratioText(ratio.low) + " to " + ratioText(ratio.high);
}

std::string numberText(double value, const Quantity& quantity) {
  if (quantity.whole || quantity.kind == Quantity::Kind::count) return wholeText(value);
  // Near 1 it is the distance from it that tells frames apart.
  if (!quantity.largerIsWorse && std::abs(value) <= 1) return plot::decimal(value, 5);
  return roundedText(value);
}

std::string axisText(const Quantity& quantity) {
  return std::string(quantity.label) +
         (quantity.unit.empty() ? std::string() : " (" + std::string(quantity.unit) + ')');
}

std::vector<double> finiteOf(const Unit& unit, const Quantity& quantity) {
  std::vector<double> values;
  for (const MeasuredFrame& frame : unit.frames)
    if (const double value = quantity.of(frame); std::isfinite(value)) values.push_back(value);
  return values;
}

}  // namespace trimtab::harness
