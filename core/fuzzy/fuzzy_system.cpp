#include "fuzzy_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "trimtab/fuzzy/membership.h"
#include "trimtab/preset/rules.h"
#include "trimtab/units/number.h"

namespace trimtab::fuzzy_system {

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
/// What a tool that writes three decimals makes of two that add up to 1.
constexpr double kRounding = 0.0011;

/// Names of the two inputs' terms: the membership, and its complement.
struct InputNames {
  std::string_view input, direct, complement;
};
constexpr InputNames kInputs[] = {{"altitude", "low", "high"}, {"pitch", "down", "up"}};

// --- From parameters ---

/// So near that a step between two points is meant; no number so small that other programs refuse it.
double justBelow(double x) {
  return x - std::max(1.0, std::abs(x)) * 4 * std::numeric_limits<double>::epsilon();
}

Term discrete(std::string_view name, const CurvePoints& curve, bool complement) {
  Term term{std::string(name), "Discrete", {}, ""};
  for (std::size_t i = 0; i < curve.size; ++i) {
    // At a step other programs take the first of two values, we the last: the first point moves by a bit.
    const CurvePoint p = curve.point[i];
    const bool steps = i + 1 < curve.size && curve.point[i + 1].x == p.x;
    term.numbers.push_back(steps ? justBelow(p.x) : p.x);
    term.numbers.push_back(complement ? 1 - p.y : p.y);
  }
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
    CurvePoints curve;
    for (std::size_t i = 0; i < n.size(); i += 2) curve.point[curve.size++] = {n[i], n[i + 1]};
    for (std::size_t i = 0; i + 1 < curve.size; ++i)
      if (curve.point[i].x == justBelow(curve.point[i + 1].x)) curve.point[i].x = curve.point[i + 1].x;
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
      for (const double x : {p.x, std::nextafter(p.x, -kInf)})
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

}  // namespace

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
  for (const char c : name)
    system.name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
  if (system.name.empty()) system.name = "rules";
  const CurvePoints* const curves[] = {&p.altitude.curve, &pitch};
  for (std::size_t i = 0; i < std::size(kInputs); ++i)
    system.inputs.push_back(
        {std::string(kInputs[i].input),
         {discrete(kInputs[i].direct, *curves[i], false), discrete(kInputs[i].complement, *curves[i], true)},
         ""});
  system.output.name = "total";
  const RuleList& rules = p.scheme.rules;
  for (std::size_t i = 0; i < rules.size; ++i) {
    const FuzzyRule& rule = rules.rule[i];
    Rule written{{}, i, rule.weight, ""};
    system.output.terms.push_back({"u" + std::to_string(i + 1), "Constant", {rule.output}, ""});
    if (rule.altitude != AltitudeCondition::any)
      written.conditions.push_back({0, Hedge::is, rule.altitude == AltitudeCondition::low ? 0u : 1u});
    if (rule.pitch != PitchCondition::any)
      written.conditions.push_back({1, Hedge::is, rule.pitch == PitchCondition::nose_down ? 0u : 1u});
    if (written.conditions.empty()) {
      std::vector<Term>& terms = system.inputs[0].terms;
      if (terms.size() == 2) terms.push_back({"always", "Discrete", {0, 1, 1, 1}, ""});
      written.conditions.push_back({0, Hedge::is, 2});
    }
    system.rules.push_back(std::move(written));
  }
  return {std::move(system), std::move(findings)};
}

Result<TuningParameters> parametersOf(const System& system, const std::string& where,
                                      const TuningParameters& onto) {
  Findings findings;
  const auto refuse = [&findings](std::string at, std::string key, std::string expected, std::string found) {
    findings.push_back(
        {Severity::error, std::move(at), std::move(key), std::move(expected), std::move(found)});
  };
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
  if (system.rules.empty() || system.rules.size() > RuleList::kCapacity)
    refuse(where, "rules", "1 to " + std::to_string(RuleList::kCapacity) + " rules",
           std::to_string(system.rules.size()));
  if (std::any_of(findings.begin(), findings.end(),
                  [](const Finding& f) { return f.severity == Severity::error; }))
    return findings;

  RuleList rules;
  for (const Rule& written : system.rules) {
    const Term& output = system.output.terms[written.output];
    FuzzyRule rule{AltitudeCondition::any, PitchCondition::any, written.weight, 0};
    if (output.shape == "Constant" && output.numbers.size() == 1)
      rule.output = output.numbers[0];
    else
      refuse(output.where, "term " + output.name, "Constant with one number", output.shape);
    for (const Condition& c : written.conditions) {
      const Meaning meaning = c.hedge == Hedge::any ? Meaning::always : readings[c.input].terms[c.term];
      if (meaning == Meaning::always) {
        if (c.hedge == Hedge::is_not) refuse(written.where, "rule", "a rule that can fire", "not always");
        continue;
      }
      const bool direct = (meaning == Meaning::direct) != (c.hedge == Hedge::is_not);
      const bool twice =
          inputOf[c.input] == 0 ? rule.altitude != AltitudeCondition::any : rule.pitch != PitchCondition::any;
      if (twice)
        refuse(written.where, "rule", "each input at most once", system.inputs[c.input].name + " twice");
      if (inputOf[c.input] == 0)
        rule.altitude = direct ? AltitudeCondition::low : AltitudeCondition::high;
      else
        rule.pitch = direct ? PitchCondition::nose_down : PitchCondition::nose_up;
    }
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
  if (std::any_of(findings.begin(), findings.end(),
                  [](const Finding& f) { return f.severity == Severity::error; }))
    return findings;
  return {std::move(p), std::move(findings)};
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> found;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    found.push_back(text.substr(0, text.find_first_of(" \t\r")));
    text.remove_prefix(found.back().size());
  }
  return found;
}

std::string_view takeLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line;
}

}  // namespace trimtab::fuzzy_system
