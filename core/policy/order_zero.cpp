#include "order_zero.h"

#include <algorithm>

#include "fuzzy_shapes.h"
#include "system_text.h"
#include "trimtab/units/number.h"

namespace trimtab::fuzzy_system {
namespace {

std::string keyOf(const Term& term) {
  return "term " + term.name.substr(0, 40);
}

/// Replaces MATLAB's other shapes by points.
void usePoints(Variable& input, Lines& lines) {
  for (Term& term : input.terms) {
    if (policyShapeOf(term)) continue;
    if (const auto flaw = membershipFlaw(term)) {
      lines.refuseAt(term.where, keyOf(term), flaw->expected, flaw->found);
      continue;
    }
    CurvePoints points = pointsOf(term);
    lines.noteAt(term.where, keyOf(term),
                 term.shape + ", read as " + std::to_string(points.xy.size() / 2) +
                     " points; the lines between them differ from it by at most " +
                     numberText(points.difference, 2));
    term.shape = systemNameOf(TermShape::points);
    term.numbers = std::move(points.xy);
  }
}

/// A plane that no input tilts is a constant.
void useConstants(Variable& output) {
  for (Term& term : output.terms) {
    if (term.shape != "Linear" || term.numbers.empty()) continue;
    if (std::any_of(term.numbers.begin(), term.numbers.end() - 1, [](double each) { return each != 0; }))
      continue;
    term.shape = "Constant";
    term.numbers = {term.numbers.back()};
  }
}

}  // namespace

Result<System> orderZeroOf(System system, const std::string& where) {
  Lines lines({}, where);
  for (Variable& output : system.outputs) useConstants(output);
  for (Variable& input : system.inputs) usePoints(input, lines);
  if (!lines.empty()) return lines.findings();
  return {std::move(system), lines.findings()};
}

}  // namespace trimtab::fuzzy_system
