#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "membership_at.h"
#include "trimtab/policy/fuzzy_system.h"

/// The shapes of rule files: those of a policy, and MATLAB's others, which become points.
namespace trimtab::fuzzy_system {

/// Returns the shape of a policy that a term has; nothing for MATLAB's others and for Constant and Linear.
std::optional<TermShape> policyShapeOf(const Term& term);
/// Returns how System spells a shape.
std::string_view systemNameOf(TermShape shape);

/// Returns what is wrong with the numbers of a membership; nothing if all is well.
std::optional<TermFlaw> membershipFlaw(const Term& term);
/// Returns the membership of x in a term that membershipFlaw() accepts.
double membershipIn(const Term& term, double x);

/// A curve as points "x y x y ...", and how far the lines between them are from it at most.
struct CurvePoints {
  std::vector<double> xy;
  double difference = 0;
};
/// Returns the points of one of MATLAB's other shapes, which membershipFlaw() accepts. They lie where the
/// curve bends, as many as a term may have.
CurvePoints pointsOf(const Term& term);

}  // namespace trimtab::fuzzy_system
