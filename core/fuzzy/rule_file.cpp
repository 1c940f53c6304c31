#include "trimtab/fuzzy/rule_file.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "trimtab/fuzzy/membership.h"
#include "trimtab/preset/rules.h"
#include "trimtab/preset/table.h"
#include "trimtab/units/finding_list.h"
#include "trimtab/units/not_finite.h"
#include "trimtab/units/number.h"

namespace trimtab {

namespace {

using fuzzy_system::System;
using fuzzy_system::Term;
using fuzzy_system::Variable;

/// What a tool that writes three decimals makes of two that add up to 1.
constexpr double kRounding = 0.0011;

/// Names of the two inputs' terms: the membership, and its complement; and the key of the membership.
struct InputNames {
  std::string_view input, direct, complement, curve;
};
constexpr InputNames kInputs[] = {{"altitude", "low", "high", "fuzzy.altitude.curve_ft"},
                                  {"pitch", "down", "up", "fuzzy.pitch.curve_deg"}};

// --- From parameters ---

Term discrete(std::string_view name, const CurvePoints& curve, bool complement) {
  Term term{std::string(name), "Discrete", {}, ""};
  for (const CurvePoint& p : curve.span())
    term.numbers.insert(term.numbers.end(), {p.x, complement ? 1 - p.y : p.y});
  fuzzy_system::moveStepsApart(term.numbers);
  return term;
}

/// The rounded step as points; at 0 itself it has 0.5, which no step between two lines has.
CurvePoints roundedStep(const PitchParameters& p) {
  const double step = p.step.value(), limit = p.limit.value();
  if (limit == 0) return {{0, 1}, {0, 0}};
  CurvePoints curve{{-limit, 1}};
  const auto add = [&curve](double x, double y) { curve.point[curve.size++] = {x, std::clamp(y, 0.0, 1.0)}; };
  const bool reaches = step * limit > 1;
  if (reaches) add(1 / step - limit, 0);
  add(0, 1 - step * limit);
  add(0, step * limit);
  if (reaches) add(limit - 1 / step, 1);
  add(limit, 0);
  return curve;
}

// --- To parameters ---

/// A term's straight lines; none where it has others.
std::optional<CurvePoints> pointsOf(const Term& term) {
  std::vector<double> n = term.numbers;
  for (double& number : n)
    number += 0.0;  // no negative zeros: a step beside one would not come back as it is
  if (std::any_of(n.begin(), n.end(), [](double v) { return !std::isfinite(v); })) return std::nullopt;
  if (term.shape == "Discrete") {
    if (n.size() < 4 || n.size() % 2 != 0 || n.size() / 2 > CurvePoints::kCapacity) return std::nullopt;
    fuzzy_system::moveStepsTogether(n);
    CurvePoints curve;
    for (std::size_t i = 0; i < n.size(); i += 2) curve.point[curve.size++] = {n[i], n[i + 1]};
    return curve;
  }
  if (term.shape == "Ramp" && n.size() == 2 && n[0] != n[1])
    return n[0] < n[1] ? CurvePoints{{n[0], 0}, {n[1], 1}} : CurvePoints{{n[1], 1}, {n[0], 0}};
  if (term.shape == "Triangle" && n.size() == 3) return CurvePoints{{n[0], 0}, {n[1], 1}, {n[2], 0}};
  if (term.shape == "Trapezoid" && n.size() == 4)
    return CurvePoints{{n[0], 0}, {n[1], 1}, {n[2], 1}, {n[3], 0}};
  return std::nullopt;
}

bool isAlways(const CurvePoints& curve) {
  return std::all_of(curve.span().begin(), curve.span().end(), [](const CurvePoint& p) { return p.y == 1; });
}

/// How far two curves are from adding up to 1, at the points of both and just before them.
double complementError(const CurvePoints& a, const CurvePoints& b) {
  double worst = 0;
  for (const CurvePoints* const curve : {&a, &b})
    for (const CurvePoint& p : curve->span())
      for (const double x : {p.x, std::nextafter(p.x, -kInfinity)})
        worst = std::max(worst, std::abs(curveValue(a, x) + curveValue(b, x) - 1));
  return worst;
}

enum class Meaning { none, direct, complement, always };

struct InputReading {
  std::optional<CurvePoints> curve;
  std::vector<Meaning> terms;  ///< as the variable has them
};

InputReading readInput(const Variable& input, const InputNames& names, Findings& findings) {
  InputReading reading;
  const auto refuse = [&findings](const Term& term, std::string expected, std::string found) {
    findings.push_back(
        {Severity::error, term.where, "term " + term.name, std::move(expected), std::move(found)});
  };
  std::optional<CurvePoints> complement;
  const Term* complementTerm = nullptr;
  for (const Term& term : input.terms) {
    Meaning meaning = Meaning::none;
    const auto curve = pointsOf(term);
    const bool isDirect = term.name == names.direct || term.name == "nose_" + std::string(names.direct);
    const bool isComplement =
        term.name == names.complement || term.name == "nose_" + std::string(names.complement);
    if (!curve)
      refuse(term, "straight lines: Discrete (2 to 32 points), Ramp, Triangle or Trapezoid",
             term.shape + " of " + std::to_string(term.numbers.size()) + " numbers");
    else if (isDirect)
      meaning = Meaning::direct, reading.curve = curve;
    else if (isComplement)
      meaning = Meaning::complement, complement = curve, complementTerm = &term;
    else if (isAlways(*curve))
      meaning = Meaning::always;
    else
      refuse(term,
             std::string(names.direct) + ", " + std::string(names.complement) +
                 ", or a term that is 1 everywhere",
             "\"" + term.name + "\"");
    reading.terms.push_back(meaning);
  }
  if (reading.curve && complement) {
    const double error = complementError(*reading.curve, *complement);
    const std::string expected = "1 minus \"" + std::string(names.direct) + "\"";
    if (error > kRounding)
      refuse(*complementTerm, expected, "another curve, " + numberText(error) + " off");
    else if (error > 1e-9)
      findings.push_back({Severity::warning, complementTerm->where, "term " + complementTerm->name, expected,
                          "it by " + numberText(error) + ", taken as rounding"});
  } else if (complement) {
    for (std::size_t i = 0; i < complement->size; ++i) complement->point[i].y = 1 - complement->point[i].y;
    reading.curve = complement;
  }
  return reading;
}

/// What the rules of this program cannot do for every rule of a file alike.
void checkSystem(const System& system, Findings& findings) {
  const auto refuse = [&findings](const std::string& at, std::string key, std::string expected,
                                  std::string found) {
    findings.push_back({Severity::error, at, std::move(key), std::move(expected), std::move(found)});
  };
  if (system.outputs.size() > 1)
    refuse(system.outputs[1].where, "output " + system.outputs[1].name, "one output", "a second one");
  const Variable& output = system.outputs[0];
  if (output.unfired != 0 && !std::isnan(output.unfired))
    refuse(output.unfiredWhere, "default", "0 or nan: what no rule fires for is 0",
           numberText(output.unfired));
  for (const Variable& input : system.inputs)
    if (input.lockRange) refuse(input.where, "lock-range", "false", "true");
  const auto& conjunction = system.conjunction;
  if (!conjunction.value.empty() && conjunction.value != "none" && conjunction.value != "Minimum")
    refuse(conjunction.where, "conjunction", "Minimum", conjunction.value);
}

Result<System> systemOf(const TuningParameters& p, const std::string& name) {
  Findings findings;
  if (p.altitude.reading != AltitudeReading::table)
    return Finding{Severity::error, "", "fuzzy.altitude.reading", "table: lines between points",
                   "a printed equation, which is no straight line"};
  CurvePoints pitch = p.pitch.curve;
  if (p.pitch.reading == PitchReading::rounded_step) {
    pitch = roundedStep(p.pitch);
    findings.push_back(
        {Severity::warning, "", "fuzzy.pitch.reading", "linear",
         "rounded_step: at 0 deg itself the file has " + numberText(curveValue(pitch, 0)) + " for 0.5"});
  }
  System system;
  system.name = fuzzy_system::engineName(name, "rules");
  system.conjunction.value = "Minimum";
  system.disjunction.value = "none";
  const CurvePoints* const curves[] = {&p.altitude.curve, &pitch};
  for (std::size_t i = 0; i < std::size(kInputs); ++i)
    system.inputs.push_back(
        {std::string(kInputs[i].input),
         findRow(kInputs[i].curve)->hard,
         false,
         {discrete(kInputs[i].direct, *curves[i], false), discrete(kInputs[i].complement, *curves[i], true)},
         "",
         0,
         ""});
  Variable& output = system.outputs.emplace_back();
  output.name = "total";
  output.range = {0, BandList::kTop};
  output.unfired = 0;
  const RuleList& rules = p.scheme.rules;
  for (std::size_t i = 0; i < rules.size; ++i) {
    const FuzzyRule& rule = rules.rule[i];
    output.terms.push_back({"u" + std::to_string(i + 1), "Constant", {rule.output}, ""});
    std::string condition;
    if (rule.altitude != AltitudeCondition::any)
      condition = rule.altitude == AltitudeCondition::low ? "altitude is low" : "altitude is high";
    if (rule.pitch != PitchCondition::any)
      condition += std::string(condition.empty() ? "" : " and ") +
                   (rule.pitch == PitchCondition::nose_down ? "pitch is down" : "pitch is up");
    if (condition.empty()) {
      std::vector<Term>& terms = system.inputs[0].terms;
      if (terms.size() == 2) terms.push_back({"always", "Discrete", {0, 1, 1, 1}, ""});
      condition = "altitude is always";
    }
    system.rules.push_back({std::move(condition), {{0, i}}, rule.weight, true, "", ""});
  }
  return {std::move(system), std::move(findings)};
}

/// Reads what a rule asks of each input; a finding if it asks what FuzzyRule cannot.
std::optional<Finding> readConditions(const fuzzy_system::Rule& written, const System& system,
                                      const std::vector<InputReading>& readings,
                                      const std::vector<std::size_t>& inputOf, FuzzyRule& rule) {
  const auto refused = [&written](std::string expected, std::string_view found) {
    return Finding{Severity::error, written.where, "rule", std::move(expected), std::string(found)};
  };
  const auto flat = fuzzy_system::flatCondition(written.condition);
  if (!flat) return refused(flat.findings()[0].expected, flat.findings()[0].found);
  if (flat->connective == "or") return refused("\"and\" or \"then\"", "or");
  for (const fuzzy_system::Proposition& part : flat->propositions) {
    const std::size_t input = fuzzy_system::indexOf(system.inputs, part.input);
    if (input == system.inputs.size())
      return refused("an input (" + fuzzy_system::namesOf(system.inputs) + ")", part.input);
    const std::vector<Term>& terms = system.inputs[input].terms;
    const std::size_t term = fuzzy_system::indexOf(terms, part.term);
    const bool isNot = !part.hedges.empty() && part.hedges[0] == "not";
    // A hedge comes before a term, so a term may have its name.
    const bool any = part.term == "any" && term == terms.size();
    if (part.hedges.size() > (isNot ? 1 : 0) || (term == terms.size() && !any))
      return refused("not, any or a term (" + fuzzy_system::namesOf(terms) + ")",
                     part.hedges.size() > (isNot ? 1 : 0) ? part.hedges[isNot ? 1 : 0] : part.term);
    const Meaning meaning = any ? Meaning::always : readings[input].terms[term];
    if (meaning == Meaning::always) {
      if (isNot) return refused("a rule that can fire", "not always");
      continue;
    }
    const bool direct = (meaning == Meaning::direct) != isNot, isAltitude = inputOf[input] == 0;
    if (isAltitude ? rule.altitude != AltitudeCondition::any : rule.pitch != PitchCondition::any)
      return refused("each input at most once", system.inputs[input].name + " twice");
    if (isAltitude)
      rule.altitude = direct ? AltitudeCondition::low : AltitudeCondition::high;
    else
      rule.pitch = direct ? PitchCondition::nose_down : PitchCondition::nose_up;
  }
  return std::nullopt;
}

Result<TuningParameters> parametersOf(const System& system, const std::string& where,
                                      const TuningParameters& onto) {
  Findings findings;
  const auto refuse = [&findings](std::string at, std::string key, std::string expected, std::string found) {
    findings.push_back(
        {Severity::error, std::move(at), std::move(key), std::move(expected), std::move(found)});
  };
  checkSystem(system, findings);
  std::vector<InputReading> readings;
  std::vector<std::size_t> inputOf;  ///< 0 altitude, 1 pitch
  for (const Variable& input : system.inputs) {
    std::size_t which = 0;
    while (which < std::size(kInputs) && kInputs[which].input != input.name) ++which;
    if (which == std::size(kInputs)) {
      refuse(input.where, "input " + input.name, "altitude or pitch", "\"" + input.name + "\"");
      which = 0;
      readings.push_back({});
    } else {
      readings.push_back(readInput(input, kInputs[which], findings));
    }
    inputOf.push_back(which);
  }
  TuningParameters p = onto;
  for (std::size_t which = 0; which < std::size(kInputs); ++which) {
    const auto count = std::count(inputOf.begin(), inputOf.end(), which);
    const auto at = std::find(inputOf.begin(), inputOf.end(), which) - inputOf.begin();
    const std::string names(kInputs[which].input);
    if (count != 1) {
      if (findings.empty()) refuse(where, "input " + names, "it once", std::to_string(count) + " of them");
      continue;
    }
    const auto& curve = readings[static_cast<std::size_t>(at)].curve;
    if (!curve) {
      if (findings.empty())
        refuse(
            system.inputs[static_cast<std::size_t>(at)].where, "input " + names,
            "a term " + std::string(kInputs[which].direct) + " or " + std::string(kInputs[which].complement),
            "neither");
      continue;
    }
    if (which == 0)
      static_cast<CurvePoints&>(p.altitude.curve) = *curve;
    else
      static_cast<CurvePoints&>(p.pitch.curve) = *curve;
  }
  const auto count = std::count_if(system.rules.begin(), system.rules.end(),
                                   [](const fuzzy_system::Rule& r) { return r.enabled; });
  if (count < 1 || count > static_cast<std::ptrdiff_t>(RuleList::kCapacity))
    refuse(where, "rules", "1 to " + std::to_string(RuleList::kCapacity) + " rules", std::to_string(count));
  if (hasError(findings)) return findings;

  RuleList rules;
  for (const fuzzy_system::Rule& written : system.rules) {
    if (!written.enabled) continue;
    const Term& output = system.outputs[0].terms[written.conclusions[0].term];
    FuzzyRule rule{AltitudeCondition::any, PitchCondition::any, written.weight, 0};
    if (output.shape == "Constant" && output.numbers.size() == 1)
      rule.output = output.numbers[0];
    else
      refuse(output.where, "term " + output.name, "Constant with one number", output.shape);
    if (written.conclusions.size() > 1) refuse(written.where, "rule", "one term of the output", "several");
    if (auto flaw = readConditions(written, system, readings, inputOf, rule))
      findings.push_back(std::move(*flaw));
    rules.rule[rules.size++] = rule;
  }
  p.scheme.rules = rules;
  p.scheme.combination = Combination::rules;
  p.altitude.reading = AltitudeReading::table;
  p.pitch.reading = PitchReading::linear;
  for (Finding& f : rangeFindings(p))
    if (f.key == "fuzzy.rules" || f.key == "fuzzy.altitude.curve_ft" || f.key == "fuzzy.pitch.curve_deg") {
      f.where = where;
      findings.push_back(std::move(f));
    }
  if (hasError(findings)) return findings;
  return {std::move(p), std::move(findings)};
}

}  // namespace

Result<std::string> ruleFileText(const TuningParameters& parameters, const std::string& name,
                                 RuleFormat format) {
  const Result<System> system = systemOf(parameters, name);
  if (!system) return system.findings();
  const auto text = fuzzy_system::systemText(*system, format);
  if (!text) return text;
  Findings findings = system.findings();
  const auto rules = parameters.scheme.rules.span();
  if (format == RuleFormat::matlab &&
      std::any_of(rules.begin(), rules.end(), [](const FuzzyRule& r) { return r.weight > 1; }))
    findings.push_back({Severity::warning, "", "fuzzy.rules", "weights up to 1, as MATLAB takes them",
                        "a larger one, written as it is"});
  return {*text, std::move(findings)};
}

Result<TuningParameters> readRuleFile(std::string_view text, const std::string& where, RuleFormat format,
                                      const TuningParameters& onto) {
  const Result<System> system = fuzzy_system::readSystem(text, where, format);
  if (!system) return system.findings();
  auto parameters = parametersOf(*system, where, onto);
  if (!parameters) return firstOf(parameters.findings(), where);
  return parameters;
}

}  // namespace trimtab
