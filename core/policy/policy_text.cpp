#include <algorithm>

#include "trimtab/policy/policy.h"
#include "trimtab/units/number.h"
#include "words.h"

namespace trimtab {
namespace {

Finding refusal(const std::string& where, const char* key, std::string expected, std::string_view found) {
  return {Severity::error, where, key, std::move(expected),
          found.empty() ? "nothing" : std::string(found.substr(0, 80))};
}

std::string leverKeys() {
  std::string text;
  for (const LeverRow& row : kLeverRows) text += (text.empty() ? "" : ", ") + std::string(row.key);
  return text;
}

}  // namespace

std::string ruleText(const PolicyRule& rule) {
  std::string text = "if " + rule.condition + " then ";
  for (std::size_t i = 0; i < rule.settings.size(); ++i)
    text += (i > 0 ? ", " : "") + std::string(rowOf(rule.settings[i].lever).key) + " = " +
            numberText(rule.settings[i].value);
  return rule.weight == 1 ? text : text + " with " + numberText(rule.weight);
}

Result<PolicyRule> readPolicyRule(std::string_view text, const std::string& where) {
  const std::vector<std::string_view> words = policyWords(text);
  const auto wordAt = [&](std::size_t i) { return i < words.size() ? words[i] : std::string_view{}; };
  if (wordAt(0) != "if") return refusal(where, "rule", "if CONDITION then LEVER = VALUE", text);
  const auto then = std::find(words.begin(), words.end(), "then");
  if (then == words.end() || then == words.begin() + 1)
    return refusal(where, "rule", "a condition between if and then", text);
  PolicyRule rule;
  rule.condition = joinedWords(words.begin() + 1, then);
  std::size_t at = static_cast<std::size_t>(then - words.begin());
  do {
    const auto lever = leverNamed(wordAt(++at));
    if (!lever) return refusal(where, "rule", "a lever after then: " + leverKeys(), wordAt(at));
    if (wordAt(++at) != "=") return refusal(where, "rule", "= after the lever", wordAt(at));
    const auto value = readNumber(wordAt(++at));
    if (!value) return refusal(where, "rule", "a number after =", wordAt(at));
    rule.settings.push_back({*lever, *value});
  } while (wordAt(++at) == ",");
  if (wordAt(at) == "with") {
    const auto weight = readNumber(wordAt(++at));
    if (!weight) return refusal(where, "rule", "a weight after with", wordAt(at));
    rule.weight = *weight;
    ++at;
  }
  if (at < words.size()) return refusal(where, "rule", "the end of the rule", words[at]);
  return rule;
}

std::string shapeText(const PolicyTerm& term) {
  std::string text(kTermShapes[static_cast<std::size_t>(term.shape)]);
  for (const double number : term.numbers) text += " " + numberText(number);
  return text;
}

Result<PolicyTerm> readShape(std::string_view text, const std::string& where) {
  const std::vector<std::string_view> words = policyWords(text);
  const auto shape = std::find(kTermShapes.begin(), kTermShapes.end(), words.empty() ? "" : words[0]);
  if (shape == kTermShapes.end()) {
    std::string names;
    for (const std::string_view name : kTermShapes) names += (names.empty() ? "" : ", ") + std::string(name);
    return refusal(where, "shape", "one of " + names, words.empty() ? "" : words[0]);
  }
  PolicyTerm term;
  term.shape = static_cast<TermShape>(shape - kTermShapes.begin());
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto number = readNumber(words[i]);
    if (!number) return refusal(where, "shape", "a number", words[i]);
    if (term.numbers.size() == kMostTermNumbers)
      return refusal(where, "shape", "at most " + std::to_string(kMostTermNumbers) + " numbers", "more");
    term.numbers.push_back(*number);
  }
  return term;
}

}  // namespace trimtab
