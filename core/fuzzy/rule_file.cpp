#include "trimtab/fuzzy/rule_file.h"

#include <algorithm>

#include "fuzzy_system.h"

namespace trimtab {

std::optional<RuleFormat> ruleFormatOf(const std::filesystem::path& file) {
  if (file.extension() == ".fll") return RuleFormat::fuzzylite;
  if (file.extension() == ".fis") return RuleFormat::matlab;
  return std::nullopt;
}

Result<std::string> ruleFileText(const TuningParameters& parameters, const std::string& name,
                                 RuleFormat format) {
  const Result<fuzzy_system::System> system = fuzzy_system::systemOf(parameters, name);
  if (!system) return system.findings();
  if (format == RuleFormat::fuzzylite) return {toFuzzyLite(*system), system.findings()};
  Findings findings = system.findings();
  const auto rules = parameters.scheme.rules.span();
  if (std::any_of(rules.begin(), rules.end(), [](const FuzzyRule& r) { return r.weight > 1; }))
    findings.push_back({Severity::warning, "", "fuzzy.rules", "weights up to 1, as MATLAB takes them",
                        "a larger one, written as it is"});
  return {toMatlab(*system), std::move(findings)};
}

Result<TuningParameters> readRuleFile(std::string_view text, const std::string& where, RuleFormat format,
                                      const TuningParameters& onto) {
  const Result<fuzzy_system::System> system = format == RuleFormat::fuzzylite
                                                  ? fuzzy_system::readFuzzyLite(text, where)
                                                  : fuzzy_system::readMatlab(text, where);
  if (!system) return system.findings();
  return fuzzy_system::parametersOf(*system, where, onto);
}

}  // namespace trimtab
