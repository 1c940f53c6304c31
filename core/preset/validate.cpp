#include <algorithm>
#include <array>
#include <cmath>

#include "trimtab/policy/compiled_policy.h"
#include "trimtab/preset/policy_lines.h"
#include "trimtab/preset/rules.h"
#include "trimtab/preset/table.h"
#include "trimtab/units/number.h"

namespace trimtab {

namespace {

std::string withUnit(double value, std::string_view unit) {
  return numberText(value) + (unit.empty() ? "" : " ") + std::string(unit);
}

std::string rangeText(Range range, std::string_view unit) {
  return numberText(range.low) + " to " + withUnit(range.high, unit);
}

std::string numberOf(std::size_t index) {
  return std::to_string(index + 1);
}

Finding finding(Severity severity, const ParameterRow& row, std::string expected, std::string found) {
  return {severity, "", std::string(row.key), std::move(expected), std::move(found)};
}

bool outside(double value, Range range) {
  return !(value >= range.low && value <= range.high);
}

/// Reports whether text is well-formed UTF-8: no lone or missing continuation, no longer form than needed, no
/// surrogate, nothing beyond U+10FFFF.
bool isUtf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = [&](std::size_t i) {
      return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0u;
    };
    const unsigned lead = byte(0);
    const std::size_t more = lead < 0x80 ? 0 : lead < 0xe0 ? 1 : lead < 0xf0 ? 2 : 3;
    if (more > 0 && (lead < 0xc2 || lead > 0xf4)) return false;
    for (std::size_t i = 1; i <= more; ++i)
      if ((byte(i) & 0xc0) != 0x80) return false;
    if ((lead == 0xe0 && byte(1) < 0xa0) || (lead == 0xed && byte(1) > 0x9f) ||
        (lead == 0xf0 && byte(1) < 0x90) || (lead == 0xf4 && byte(1) > 0x8f))
      return false;
    at += more + 1;
  }
  return true;
}

void checkScalar(const ParameterRow& row, double value, Findings& findings) {
  if (!std::isfinite(value) || outside(value, row.hard))
    findings.push_back(
        finding(Severity::error, row, rangeText(row.hard, row.unit), withUnit(value, row.unit)));
  else if (row.whole && value != std::floor(value))
    findings.push_back(finding(Severity::error, row, "a whole number", withUnit(value, row.unit)));
  else if (outside(value, row.usual))
    findings.push_back(finding(Severity::warning, row, "usually " + rangeText(row.usual, row.unit),
                               withUnit(value, row.unit)));
}

void checkCurveRow(const ParameterRow& row, const CurvePoints& curve, Findings& findings) {
  const CurveCheck check = checkCurve(curve, row.hard);
  const auto error = [&](std::string expected, std::string found) {
    findings.push_back(finding(Severity::error, row, std::move(expected), std::move(found)));
  };
  const CurvePoint p =
      check.at < curve.size && check.at < CurvePoints::kCapacity ? curve.point[check.at] : CurvePoint{};
  const std::string point = "point " + numberOf(check.at) + " at " + withUnit(p.x, row.unit);
  switch (check.flaw) {
    case CurveFlaw::none:
      break;
    case CurveFlaw::count:
      return error("2 to " + std::to_string(CurvePoints::kCapacity) + " points", std::to_string(curve.size));
    case CurveFlaw::not_a_number:
      return error("finite numbers",
                   "point " + numberOf(check.at) + ": " + numberText(p.x) + ", " + numberText(p.y));
    case CurveFlaw::outside_x:
      return error(rangeText(row.hard, row.unit), point);
    case CurveFlaw::outside_y:
      return error("membership 0 to 1", numberText(p.y) + " in point " + numberOf(check.at));
    case CurveFlaw::falling:
      return error("points in rising order",
                   point + " after " + withUnit(curve.point[check.at - 1].x, row.unit));
    case CurveFlaw::triple:
      return error("at most two points at one place", point + " is the third");
  }
  for (const CurvePoint& q : curve.span())
    if (outside(q.x, row.usual))
      findings.push_back(finding(Severity::warning, row, "usually " + rangeText(row.usual, row.unit),
                                 "a point at " + withUnit(q.x, row.unit)));
}

void checkBandsRow(const ParameterRow& row, const BandList& bands, Findings& findings) {
  const BandCheck check = checkBands(bands, row.hard);
  const auto error = [&](std::string expected, std::string found) {
    findings.push_back(finding(Severity::error, row, std::move(expected), std::move(found)));
  };
  const Band b = check.at < bands.size && check.at < BandList::kCapacity ? bands.band[check.at] : Band{};
  const std::string edge = "band " + numberOf(check.at) + " from " + numberText(b.low);
  const auto sizeText = [](const Band& band) {
    return std::to_string(band.widthPx) + "x" + std::to_string(band.heightPx) + " px";
  };
  switch (check.flaw) {
    case BandFlaw::none:
      break;
    case BandFlaw::count:
      return error("1 to " + std::to_string(BandList::kCapacity) + " bands", std::to_string(bands.size));
    case BandFlaw::not_a_number:
      return error("finite numbers", edge);
    case BandFlaw::outside_low:
      return error("lower edges above 0 and below " + numberText(BandList::kTop), edge);
    case BandFlaw::falling:
      return error("lower edges in rising order",
                   edge + " after " + numberText(bands.band[check.at - 1].low));
    case BandFlaw::size:
      return error("sizes of " + rangeText(row.hard, row.unit),
                   sizeText(b) + " in band " + numberOf(check.at));
  }
  for (const Band& band : bands.span())
    if (outside(band.widthPx, row.usual) || outside(band.heightPx, row.usual))
      findings.push_back(
          finding(Severity::warning, row, "usually " + rangeText(row.usual, row.unit), sizeText(band)));
}

/// Exports write the lines as they are, so that nothing in one may break its file.
void checkLinesRow(const ParameterRow& row, const TextLines& lines, Findings& findings) {
  constexpr std::size_t kMostLines = kMostPolicyRules, kLongestLine = 20000;
  const auto error = [&](std::string expected, std::string found) {
    findings.push_back(finding(Severity::error, row, std::move(expected), std::move(found)));
  };
  if (lines.line.size() > kMostLines)
    return error("at most " + std::to_string(kMostLines) + " lines", std::to_string(lines.line.size()));
  for (std::size_t i = 0; i < lines.line.size(); ++i) {
    const std::string& line = lines.line[i];
    const bool control = std::any_of(line.begin(), line.end(),
                                     [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 0x7f; });
    if (line.size() > kLongestLine)
      error("lines of at most " + std::to_string(kLongestLine) + " characters",
            std::to_string(line.size()) + " in line " + numberOf(i));
    else if (control || !isUtf8(line))
      error("text in UTF-8 without control characters",
            std::string(control ? "a control character" : "other bytes") + " in line " + numberOf(i));
  }
}

void checkRow(const ParameterRow& row, const TuningParameters& parameters, Findings& findings) {
  const ParameterValue value = row.get(parameters);
  switch (row.kind) {
    case Kind::scalar:
      return checkScalar(row, std::get<double>(value), findings);
    case Kind::flag:
      return;
    case Kind::choice:
      if (const std::size_t index = std::get<ChoiceIndex>(value).index; index >= row.choices.size())
        findings.push_back(finding(Severity::error, row,
                                   "one of " + std::to_string(row.choices.size()) + " options",
                                   "option " + numberOf(index)));
      return;
    case Kind::curve:
      return checkCurveRow(row, std::get<CurvePoints>(value), findings);
    case Kind::bands:
      return checkBandsRow(row, std::get<BandList>(value), findings);
    case Kind::lines:
      return checkLinesRow(row, std::get<TextLines>(value), findings);
  }
}

/// A condition between parameters; `key` is the one that the finding names.
struct Rule {
  std::string_view key, text;
  bool (*holds)(const TuningParameters&);
  std::string (*expected)(const TuningParameters&);
  std::string (*found)(const TuningParameters&);
};

constexpr std::array kRules{
    Rule{"fuzzy.hysteresis",
         "Twice the hysteresis is less than the narrowest band; the last band reaches up to 2.",
         hysteresisLeavesBands,
         [](const TuningParameters& p) {
           // The difference is rounded to twelve digits: one of two typed edges should read as people would
           // write it.
           const double half = narrowestBand(p.scheme.bands) / 2;
           const double scale = half > 0 ? std::pow(10, 11 - std::floor(std::log10(half))) : 1;
           return "less than " + numberText(std::round(half * scale) / scale) + ", half the narrowest band";
         },
         [](const TuningParameters& p) { return numberText(p.scheme.hysteresis.value()); }},
    Rule{"fuzzy.hysteresis",
         "It is less than the first band's edge, else the scheme would never become frustum again.",
         hysteresisLeavesFrustum,
         [](const TuningParameters& p) {
           return "less than " + numberText(p.scheme.bands.band[0].low) + ", the first band's edge";
         },
         [](const TuningParameters& p) { return numberText(p.scheme.hysteresis.value()); }},
    Rule{"fuzzy.altitude.maximum_ft",
         "With an equation reading it is at least the altitude curve's last point.", maximumCoversCurve,
         [](const TuningParameters& p) {
           const CurvePoints& curve = p.altitude.curve;
           return "at least " + withUnit(curve.point[curve.size - 1].x, "ft") +
                  ", the altitude curve's last point";
         },
         [](const TuningParameters& p) { return withUnit(p.altitude.maximum.value(), "ft"); }},
    Rule{
        "motion.left_fov_deg",
        "The fields of view to the left and right are not both 0, else every frame that moves would be fast.",
        someFieldOfViewIsLeft,
        [](const TuningParameters&) { return std::string("left or right field of view above 0 deg"); },
        [](const TuningParameters&) { return std::string("0 deg for both"); }},
};

/// Compiles the policy; every finding has a key of the table and says which term or rule it is about.
Result<CompiledPolicy> checkedPolicy(const PolicyParameters& parameters) {
  const auto policy = policyOf(parameters);
  if (!policy) return policy.findings();
  auto compiled = compile(*policy, "");
  if (compiled) return compiled;
  Findings findings;
  for (const Finding& f : compiled.findings()) {
    // compile() names "terms.SIGNAL.NAME" or "rules.N".
    const std::size_t dot = f.key.find('.');
    const bool rule = f.key.starts_with("rules");
    const std::string place =
        dot == std::string::npos ? "" : (rule ? " in rule " : " in term ") + f.key.substr(dot + 1);
    findings.push_back({f.severity, "", rule ? "policy.rules" : "policy.terms", f.expected, f.found + place});
  }
  return findings;
}

}  // namespace

Findings rangeFindings(const TuningParameters& parameters) {
  Findings findings;
  for (const ParameterRow& row : parameterRows()) checkRow(row, parameters, findings);
  return findings;
}

Findings ruleFindings(const TuningParameters& parameters) {
  Findings findings;
  for (const Rule& rule : kRules)
    if (!rule.holds(parameters))
      findings.push_back(
          {Severity::error, "", std::string(rule.key), rule.expected(parameters), rule.found(parameters)});
  // A policy that is switched off is checked too, so that switching it on cannot fail.
  const Findings policy = checkedPolicy(parameters.policy).findings();
  findings.insert(findings.end(), policy.begin(), policy.end());
  return findings;
}

std::vector<RuleText> ruleTexts() {
  std::vector<RuleText> texts;
  for (const Rule& rule : kRules) texts.push_back({rule.key, rule.text});
  return texts;
}

Result<ValidatedParameters> validate(const TuningParameters& parameters) {
  Findings findings = rangeFindings(parameters);
  if (hasError(findings)) return findings;
  Findings broken = ruleFindings(parameters);
  findings.insert(findings.end(), broken.begin(), broken.end());
  if (!broken.empty()) return findings;
  std::shared_ptr<const CompiledPolicy> policy;
  if (parameters.policy.enabled)
    policy = std::make_shared<const CompiledPolicy>(checkedPolicy(parameters.policy).value());
  return {ValidatedParameters(parameters, std::move(policy)), std::move(findings)};
}

ValidatedParameters defaultParameters() {
  return validate(TuningParameters{}).value();
}

}  // namespace trimtab
