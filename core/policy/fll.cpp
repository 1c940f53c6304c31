#include <algorithm>

#include "system_text.h"
#include "trimtab/units/number.h"
#include "words.h"

// FuzzyLite Language, version 6.
namespace trimtab::fuzzy_system {

namespace {

constexpr std::string_view kOff = "# rule: if ";

/// A property that may have one of some values only.
struct Property {
  std::string_view block, key;
  std::vector<std::string_view> values;  ///< none: any
};

const std::vector<Property>& properties() {
  static const std::vector<Property> all{
      {"InputVariable", "enabled", {"true"}},
      {"InputVariable", "range", {}},
      {"InputVariable", "lock-range", {"false", "true"}},
      {"OutputVariable", "enabled", {"true"}},
      {"OutputVariable", "range", {}},
      {"OutputVariable", "lock-range", {"false"}},
      {"OutputVariable", "lock-previous", {"false"}},
      {"OutputVariable", "aggregation", {}},
      {"OutputVariable", "accumulation", {}},  // in version 5
      {"OutputVariable",
       "defuzzifier",
       {"WeightedAverage TakagiSugeno", "WeightedAverage Automatic", "WeightedAverage"}},
      {"OutputVariable", "default", {}},
      {"RuleBlock", "enabled", {"true"}},
      {"RuleBlock", "conjunction", {}},
      {"RuleBlock", "disjunction", {}},
      {"RuleBlock", "implication", {}},
      {"RuleBlock", "activation", {"General", "none", ""}},
  };
  return all;
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& where) : lines_(text, where) {}

  Result<System> read() {
    while (const auto line = lines_.next()) readLine(*line);
    if (system_.outputs.empty()) lines_.refuse("OutputVariable", "one", "none");
    // Rules are read last, since variables may follow them.
    for (const auto& [rule, text] : rules_) readRule(rule, text);
    if (!lines_.empty()) return lines_.findings();
    return std::move(system_);
  }

 private:
  void readLine(std::string_view line) {
    const bool off = line.starts_with(kOff);
    if (off) line = trimmed(line.substr(1));
    const std::size_t comment = std::min(line.find('#'), line.size());
    const std::string_view reason = line.substr(std::min(comment + 1, line.size()));
    line = trimmed(line.substr(0, comment));
    if (line.empty()) return;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos)
      return lines_.refuse("", "key: value, as in a file that is whole; write it again", line);
    const std::string_view key = trimmed(line.substr(0, colon)), value = trimmed(line.substr(colon + 1));
    if (key == "rule" && block_ == "RuleBlock") {
      if (rules_.size() == kMostRules)
        lines_.refuse(key, "at most " + std::to_string(kMostRules) + " rules", "more");
      if (rules_.size() <= kMostRules)
        rules_.push_back({{"", {}, 1, !off, oneLine(reason), lines_.place()}, value});
    } else if (key == "Engine") {
      system_.name = value;
    } else if (key == "InputVariable" || key == "OutputVariable") {
      block_ = key;
      auto& list = key == "InputVariable" ? system_.inputs : system_.outputs;
      if (list.size() == kMostVariables)
        return lines_.refuse(key, "at most " + std::to_string(kMostVariables) + " of a kind", "more");
      variable_ = &list.emplace_back();
      variable_->name = value;
      variable_->where = lines_.place();
    } else if (key == "RuleBlock") {
      block_ = key;
      if (++ruleBlocks_ > 1) lines_.refuse(key, "one rule block", "a second one");
    } else if (key == "term" && (block_ == "InputVariable" || block_ == "OutputVariable")) {
      readTerm(value);
    } else if (key != "description") {
      readProperty(key, value);
    }
  }

  void readProperty(std::string_view key, std::string_view value) {
    const auto at = std::find_if(properties().begin(), properties().end(),
                                 [&](const Property& p) { return p.block == block_ && p.key == key; });
    if (at == properties().end())
      return lines_.refuse(key, "a property of " + (block_.empty() ? "an engine" : std::string(block_)),
                           "another");
    if (!at->values.empty() && std::find(at->values.begin(), at->values.end(), value) == at->values.end())
      return lines_.refuse(key,
                           std::string(at->values.front()) +
                               (key == "enabled" ? "; remove what is switched off, or switch it on"
                                                 : "; change it in the tool that wrote the file"),
                           value);
    if (key == "conjunction") system_.conjunction = {std::string(value), lines_.place()};
    if (key == "disjunction") system_.disjunction = {std::string(value), lines_.place()};
    if (key == "lock-range") variable_->lockRange = value == "true";
    if (key == "default") {
      const auto number = readNumber(value);
      if (!number) return lines_.refuse(key, "a number or nan", value);
      variable_->unfired = *number;
      variable_->unfiredWhere = lines_.place();
    }
    if (key == "range") {
      const auto ends = policyWords(value);
      const auto low = readNumber(ends.empty() ? "" : ends[0]),
                 high = readNumber(ends.size() == 2 ? ends[1] : "");
      if (!low || !high) return lines_.refuse(key, "two numbers", value);
      variable_->range = {*low, *high};
    }
  }

  void readTerm(std::string_view text) {
    const auto parts = policyWords(text);
    if (parts.size() < 3) return lines_.refuse("term", "a name, a shape and numbers", text);
    if (++terms_ > kMostTerms) {
      if (terms_ == kMostTerms + 1)
        lines_.refuse("term", "at most " + std::to_string(kMostTerms) + " terms", "more");
      return;
    }
    Term term{std::string(parts[0]), std::string(parts[1]), {}, lines_.place()};
    for (std::size_t i = 2; i < parts.size(); ++i) {
      const auto number = readNumber(parts[i]);
      if (!number) return lines_.refuse("term " + term.name, "numbers", parts[i]);
      term.numbers.push_back(*number);
    }
    variable_->terms.push_back(std::move(term));
  }

  /// if altitude is low and pitch is not down then total is u1 with 0.5
  void readRule(Rule rule, std::string_view text) {
    const auto parts = policyWords(text);
    const auto wordAt = [&parts](std::size_t i) {
      return i < parts.size() ? parts[i] : std::string_view("the end of the line");
    };
    const auto refuse = [&](std::string expected, std::string_view found) {
      lines_.refuseAt(rule.where, "rule", std::move(expected), found);
    };
    if (wordAt(0) != "if") return refuse("\"if\"", wordAt(0));
    const auto then = std::find(parts.begin(), parts.end(), "then");
    if (then == parts.end()) return refuse("\"and\", \"or\" or \"then\"", wordAt(parts.size()));
    rule.condition = joinedWords(parts.begin() + 1, then);
    std::size_t at = static_cast<std::size_t>(then - parts.begin());
    do {
      Conclusion conclusion;
      conclusion.output = indexOf(system_.outputs, wordAt(++at));
      if (conclusion.output == system_.outputs.size())
        return refuse("an output (" + namesOf(system_.outputs) + ")", wordAt(at));
      if (wordAt(++at) != "is") return refuse("\"is\"", wordAt(at));
      const std::vector<Term>& terms = system_.outputs[conclusion.output].terms;
      conclusion.term = indexOf(terms, wordAt(++at));
      if (conclusion.term == terms.size()) return refuse("a term (" + namesOf(terms) + ")", wordAt(at));
      rule.conclusions.push_back(conclusion);
    } while (wordAt(++at) == "and");
    if (wordAt(at) == "with") {
      const auto weight = readNumber(wordAt(++at));
      if (!weight) return refuse("a weight", wordAt(at));
      rule.weight = *weight;
      ++at;
    }
    if (at < parts.size()) return refuse("the end of the line", parts[at]);
    system_.rules.push_back(std::move(rule));
  }

  Lines lines_;
  std::size_t ruleBlocks_ = 0, terms_ = 0;
  std::string_view block_;
  Variable* variable_ = nullptr;  ///< the last one; no list grows while its last element is read
  std::vector<std::pair<Rule, std::string_view>> rules_;
  System system_;
};

std::string variableText(const Variable& variable, bool input) {
  std::string text = (input ? "InputVariable: " : "OutputVariable: ") + variable.name +
                     "\n  enabled: true\n  range: " + numberText(variable.range.low) + " " +
                     numberText(variable.range.high) +
                     "\n  lock-range: " + (variable.lockRange ? "true\n" : "false\n");
  if (!input)
    text += "  aggregation: none\n  defuzzifier: WeightedAverage TakagiSugeno\n  default: " +
            numberText(variable.unfired) + "\n  lock-previous: false\n";
  for (const Term& term : variable.terms)
    text += "  term: " + term.name + " " + term.shape + " " + numbersText(term.numbers) + "\n";
  return text;
}

}  // namespace

std::string toFuzzyLite(const System& system) {
  std::string text = "Engine: " + system.name + "\n";
  for (const Variable& input : system.inputs) text += variableText(input, true);
  for (const Variable& output : system.outputs) text += variableText(output, false);
  text += "RuleBlock: rules\n  enabled: true\n  conjunction: " + system.conjunction.value +
          "\n  disjunction: " + system.disjunction.value +
          "\n  implication: AlgebraicProduct\n  activation: General\n";
  for (const Rule& rule : system.rules) {
    text += std::string(rule.enabled ? "  rule: if " : "  # rule: if ") + rule.condition + " then ";
    for (std::size_t i = 0; i < rule.conclusions.size(); ++i) {
      const Variable& output = system.outputs[rule.conclusions[i].output];
      text += (i > 0 ? " and " : "") + output.name + " is " + output.terms[rule.conclusions[i].term].name;
    }
    text += " with " + numberText(rule.weight);
    const std::string reason = oneLine(rule.reason);
    text += (reason.empty() ? "" : "  # " + reason) + "\n";
  }
  return text;
}

Result<System> readFuzzyLite(std::string_view text, const std::string& where) {
  return Reader(text, where).read();
}

}  // namespace trimtab::fuzzy_system
