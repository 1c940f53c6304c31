#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "trimtab/policy/levers.h"
#include "trimtab/policy/signals.h"
#include "trimtab/units/result.h"

/// A policy as an engineer writes it: terms over signals, and rules that set levers.
namespace trimtab {

/// Says how the membership of a term follows from a signal x. The formulas are fuzzylite's.
enum class TermShape : std::uint8_t {
  points,     ///< x1 y1 x2 y2 ...: the line between neighbouring points, constant beyond the ends
  triangle,   ///< a b c: 0 at a, 1 at b, 0 at c
  trapezoid,  ///< a b c d: 0 at a, 1 from b to c, 0 at d; a may be -inf, d may be inf
  ramp,       ///< a b: 0 at a, 1 at b, constant beyond; falls if b < a
  gaussian,   ///< mean, deviation: exp(-(x - mean)^2 / (2 deviation^2))
  bell,       ///< centre, width, slope: 1 / (1 + |(x - centre) / width|^(2 slope))
  sigmoid     ///< middle, slope: 1 / (1 + exp(-slope (x - middle)))
};
inline constexpr std::array<std::string_view, 7> kTermShapes{"points",   "triangle", "trapezoid", "ramp",
                                                             "gaussian", "bell",     "sigmoid"};

struct PolicyTerm {
  Signal signal = Signal::altitude;
  std::string name;  ///< a word, unique within the signal
  TermShape shape = TermShape::points;
  std::vector<double> numbers;  ///< as the shape says, in the signal's unit

  friend bool operator==(const PolicyTerm&, const PolicyTerm&) = default;
};

/// Says what a rule sets if it fires.
struct LeverSetting {
  Lever lever = Lever::occlusion;
  double value = 0;

  friend bool operator==(const LeverSetting&, const LeverSetting&) = default;
};

/// One rule. Its condition is text such as "above_ground is low and not (speed is slow or pitch is very up)":
/// `not` binds closest, then `and`, then `or`; a term may have the hedges very, somewhat, extremely, seldom
/// and not, and `SIGNAL is any` is always 1.
struct PolicyRule {
  std::string condition;
  std::vector<LeverSetting> settings;  ///< at least one
  double weight = 1;                   ///< 0..1
  bool enabled = true;
  std::string reason;  ///< why the rule is there, for people

  friend bool operator==(const PolicyRule&, const PolicyRule&) = default;
};

/// Says how `and` and `or` combine memberships a and b.
enum class PolicyNorm : std::uint8_t {
  minimum,  ///< min(a, b) and max(a, b)
  product   ///< a b and a + b - a b
};

struct Policy {
  PolicyNorm norm = PolicyNorm::minimum;
  std::vector<PolicyTerm> terms;
  std::vector<PolicyRule> rules;

  bool empty() const { return terms.empty() && rules.empty(); }
  friend bool operator==(const Policy&, const Policy&) = default;
};

inline constexpr std::size_t kMostPolicyTerms = 256, kMostPolicyRules = 1024, kMostTermNumbers = 128,
                             kMostConditionParts = 64;

/// Returns a rule as one line, "if CONDITION then LEVER = VALUE, LEVER = VALUE with WEIGHT"; the weight is
/// left out if it is 1. Neither `enabled` nor `reason` is part of it.
std::string ruleText(const PolicyRule& rule);
/// Is the inverse. Findings name `where` and say what was expected. The condition's words are checked by
/// compile().
Result<PolicyRule> readPolicyRule(std::string_view text, const std::string& where);

/// Returns a term's shape as text, "trapezoid -inf 0 500 1500"; and the inverse, with findings at `where`.
std::string shapeText(const PolicyTerm& term);
Result<PolicyTerm> readShape(std::string_view text, const std::string& where);

/// Returns the membership, 0..1, of x in the term; NaN for NaN. The term must be one that compile() accepts.
double membershipOf(const PolicyTerm& term, double x);

}  // namespace trimtab
