#include "trimtab/policy/fuzzy_system.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "fuzzy_names.h"
#include "system_text.h"
#include "trimtab/units/number.h"
#include "words.h"

namespace trimtab {

std::optional<RuleFormat> ruleFormatOf(const std::filesystem::path& file) {
  const std::string ending = fuzzy_system::lowered(file.extension().string());
  if (ending == ".fll") return RuleFormat::fuzzylite;
  if (ending == ".fis") return RuleFormat::matlab;
  return std::nullopt;
}

}  // namespace trimtab

namespace trimtab::fuzzy_system {
namespace {

constexpr std::size_t kLongestExpected = 400, kLongestFound = 120, kLongestLine = 32768;

/// Returns a number so near that a step between two points is meant, but no number so small that other
/// programs refuse it.
double justBelow(double x) {
  return x - std::max(1.0, std::abs(x)) * 4 * std::numeric_limits<double>::epsilon();
}

/// Conditions name variables and terms, so that a name has to mean one of them.
template <class Named>
void checkNames(const std::vector<Named>& list, std::string_view kind, Lines& notes) {
  std::set<std::string_view> seen;
  for (const Named& each : list)
    if (each.name.empty() || !seen.insert(each.name).second)
      notes.refuseAt(each.where, kind, "a name that stands once", each.name);
}

void checkNames(const System& system, Lines& notes) {
  for (const auto* const variables : {&system.inputs, &system.outputs}) {
    checkNames(*variables, "variable", notes);
    for (const Variable& variable : *variables) checkNames(variable.terms, "term", notes);
  }
}

void checkNorms(const System& system, Lines& notes) {
  const auto isNone = [](const Setting& norm) { return norm.value.empty() || norm.value == "none"; };
  for (const Rule& rule : system.rules) {
    const auto words = policyWords(rule.condition);
    const auto has = [&words](std::string_view word) {
      return std::find(words.begin(), words.end(), word) != words.end();
    };
    if (isNone(system.conjunction) && has("and"))
      notes.refuseAt(rule.where, "rule", "conjunction: Minimum", "\"and\" without conjunction");
    if (isNone(system.disjunction) && has("or"))
      notes.refuseAt(rule.where, "rule", "disjunction: Maximum", "\"or\" without disjunction");
  }
}

}  // namespace

std::string oneLine(std::string_view reason) {
  std::string text(reason);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return std::string(trimmed(text));
}

std::string numbersText(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : " ") + numberText(number);
  return text;
}

std::optional<std::string_view> Lines::next() {
  if (rest_.empty()) return std::nullopt;
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  const std::string_view line = trimmed(rest_.substr(0, end));
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++line_;
  if (line.size() <= kLongestLine) return line;
  refuse("", "lines of at most " + std::to_string(kLongestLine) + " characters", std::to_string(line.size()));
  return std::string_view{};
}

void Lines::refuseAt(std::string place, std::string_view key, std::string expected, std::string_view found) {
  if (expected.size() > kLongestExpected) expected.replace(kLongestExpected, std::string::npos, " ...");
  findings_.add({Severity::error, std::move(place), std::string(key.substr(0, 60)), std::move(expected),
                 found.empty() ? "nothing" : std::string(found.substr(0, kLongestFound))});
}

Findings Lines::findings() const {
  Findings all = findings_.all(where_);
  if (!empty()) std::erase_if(all, [](const Finding& f) { return f.severity == Severity::note; });
  return all;
}

Result<std::string> systemText(const System& system, RuleFormat format) {
  if (format == RuleFormat::matlab) return toMatlab(system);
  return toFuzzyLite(system);
}

Result<System> readSystem(std::string_view text, const std::string& where, RuleFormat format) {
  auto system = format == RuleFormat::matlab ? readMatlab(text, where) : readFuzzyLite(text, where);
  if (!system) return system;
  Lines notes({}, where);
  checkNames(*system, notes);
  checkNorms(*system, notes);
  if (!notes.empty()) return notes.findings();
  return system;
}

Result<FlatCondition> flatCondition(std::string_view condition) {
  const std::vector<std::string_view> words = policyWords(condition);
  const auto wordAt = [&words](std::size_t i) { return i < words.size() ? words[i] : std::string_view{}; };
  const auto isConnective = [](std::string_view word) { return word == "and" || word == "or"; };
  const auto refused = [](std::string expected, std::string_view found) {
    return Finding{Severity::error, "", "rule", std::move(expected),
                   found.empty() ? "the end of the condition" : std::string(found.substr(0, 80))};
  };
  FlatCondition flat;
  for (std::size_t at = 0;;) {
    Proposition proposition;
    proposition.input = wordAt(at++);
    if (proposition.input.empty()) return refused("an input", "");
    if (proposition.input == "(") return refused("\"and\" alone, or \"or\" alone", "a group in parentheses");
    if (wordAt(at) != "is") return refused("\"is\"", wordAt(at));
    while (++at < words.size() && !isConnective(words[at])) {
      if (!proposition.term.empty()) proposition.hedges.push_back(proposition.term);
      proposition.term = words[at];
    }
    if (proposition.term.empty()) return refused("a term", wordAt(at));
    flat.propositions.push_back(std::move(proposition));
    if (at == words.size()) return flat;
    if (!flat.connective.empty() && words[at] != flat.connective)
      return refused("\"and\" alone, or \"or\" alone", "both in one rule");
    flat.connective = words[at++];
  }
}

void moveStepsApart(std::vector<double>& xy) {
  for (std::size_t i = 0; i + 3 < xy.size(); i += 2)
    if (xy[i] == xy[i + 2]) xy[i] = justBelow(xy[i]);
}

void moveStepsTogether(std::vector<double>& xy) {
  for (std::size_t i = 0; i + 3 < xy.size(); i += 2)
    if (xy[i] == justBelow(xy[i + 2])) xy[i] = xy[i + 2];
}

std::string engineName(std::string_view name, std::string_view fallback) {
  std::string engine;
  for (const char c : name)
    engine += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
  return engine.empty() ? std::string(fallback) : engine;
}

}  // namespace trimtab::fuzzy_system
