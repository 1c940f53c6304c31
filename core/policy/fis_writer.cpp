#include <algorithm>

#include "fis_words.h"
#include "system_text.h"
#include "trimtab/units/number.h"
#include "words.h"

// Writes MATLAB's fuzzy inference system as text, with the shapes and hedges that fuzzylite adds to it.
namespace trimtab::fuzzy_system {

namespace {

std::string variableText(const Variable& variable) {
  std::string text = "Name='" + variable.name + "'\nRange=[" + numberText(variable.range.low) + " " +
                     numberText(variable.range.high) + "]\nNumMFs=" + std::to_string(variable.terms.size()) +
                     "\n";
  for (std::size_t i = 0; i < variable.terms.size(); ++i) {
    const Term& term = variable.terms[i];
    const auto shape = std::find_if(std::begin(kFisShapes), std::end(kFisShapes),
                                    [&](const FisShape& s) { return s.system == term.shape; });
    std::vector<double> numbers = term.numbers;
    if (shape->order == FisOrder::reversed) std::reverse(numbers.begin(), numbers.end());
    if (shape->order == FisOrder::first_is_last)
      std::rotate(numbers.begin(), numbers.begin() + 1, numbers.end());
    text += "MF" + std::to_string(i + 1) + "='" + term.name + "':'" + std::string(shape->matlab) + "',[" +
            numbersText(numbers) + "]\n";
  }
  return text;
}

/// Returns a rule in numbers, or why it cannot be one.
Result<std::string> ruleText(const Rule& rule, const System& system) {
  const auto refused = [](std::string expected, std::string found) {
    return Finding{Severity::error, "", "", std::move(expected), std::move(found)};
  };
  const auto flat = flatCondition(rule.condition);
  if (!flat) return flat.findings();
  std::vector<std::string> codes(system.inputs.size(), "0"), terms(system.outputs.size(), "0");
  for (const Proposition& part : flat->propositions) {
    const std::size_t input = indexOf(system.inputs, part.input);
    std::string& code = codes[input];
    if (code != "0") return refused("each input once", std::string(part.input) + " twice");
    std::size_t nots = 0;
    while (nots < part.hedges.size() && part.hedges[nots] == "not") ++nots;
    std::string hedges;
    for (std::size_t i = nots; i < part.hedges.size(); ++i)
      hedges += (hedges.empty() ? "" : " ") + std::string(part.hedges[i]);
    const std::vector<Term>& inputTerms = system.inputs[input].terms;
    const std::size_t term = indexOf(inputTerms, part.term);
    const bool any = term == inputTerms.size();  // compile() has seen that each other term exists
    const auto hedge = std::find_if(std::begin(kFisHedges), std::end(kFisHedges),
                                    [&](const FisHedge& h) { return h.hedges == hedges; });
    if (hedge == std::end(kFisHedges) || (any && !hedges.empty()))
      return refused("no hedges, or not, or one of very, somewhat, extremely and seldom, with not before it",
                     hedges + " " + std::string(part.term));
    code = (nots % 2 == 1 ? "-" : "") + (any ? "0.99" : std::to_string(term + 1) + hedge->code);
  }
  for (const Conclusion& conclusion : rule.conclusions) {
    std::string& term = terms[conclusion.output];
    if (term != "0") return refused("each output once", system.outputs[conclusion.output].name + " twice");
    term = std::to_string(conclusion.term + 1);
  }
  return joinedWords(codes.begin(), codes.end()) + ", " + joinedWords(terms.begin(), terms.end()) + " (" +
         numberText(rule.weight) + ") : " + (flat->connective == "or" ? "2" : "1");
}

}  // namespace

Result<std::string> toMatlab(const System& system) {
  const auto nameOf = [](const FisNorm(&norms)[2], const Setting& setting) {
    return std::string(norms[setting.value == norms[1].fuzzylite].matlab);
  };
  const auto rules =
      std::count_if(system.rules.begin(), system.rules.end(), [](const Rule& r) { return r.enabled; });
  std::string text = "[System]\nName='" + system.name +
                     "'\nType='sugeno'\nVersion=2.0\nNumInputs=" + std::to_string(system.inputs.size()) +
                     "\nNumOutputs=" + std::to_string(system.outputs.size()) +
                     "\nNumRules=" + std::to_string(rules) + "\nAndMethod='" +
                     nameOf(kFisConjunctions, system.conjunction) + "'\nOrMethod='" +
                     nameOf(kFisDisjunctions, system.disjunction) +
                     "'\nImpMethod='prod'\nAggMethod='sum'\nDefuzzMethod='wtaver'\n";
  for (std::size_t i = 0; i < system.inputs.size(); ++i)
    text += "\n[Input" + std::to_string(i + 1) + "]\n" + variableText(system.inputs[i]);
  for (std::size_t i = 0; i < system.outputs.size(); ++i)
    text += "\n[Output" + std::to_string(i + 1) + "]\n" + variableText(system.outputs[i]);
  text += "\n[Rules]\n";
  Findings findings;
  for (std::size_t i = 0; i < system.rules.size(); ++i) {
    const Rule& rule = system.rules[i];
    const auto numbers = ruleText(rule, system);
    if (!numbers) {
      Finding finding = numbers.findings()[0];
      finding.key = "rules." + std::to_string(i + 1);
      findings.push_back(std::move(finding));
      continue;
    }
    const std::string reason = oneLine(rule.reason);
    if (!reason.empty()) text += std::string(kFisReason) + " " + reason + "\n";
    text += (rule.enabled ? "" : std::string(kFisOff) + " ") + *numbers + "\n";
  }
  if (!findings.empty()) return findings;
  return text;
}

}  // namespace trimtab::fuzzy_system
