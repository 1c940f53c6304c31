#include <algorithm>

#include "fuzzy_system.h"
#include "trimtab/preset/table.h"
#include "trimtab/units/number.h"

// FuzzyLite Language, version 6.
namespace trimtab::fuzzy_system {

namespace {

std::string termLine(const Term& term) {
  std::string line = "  term: " + term.name + " " + term.shape;
  for (const double number : term.numbers) line += " " + numberText(number);
  return line + "\n";
}

std::string rangeText(std::string_view key) {
  const Range range = findRow(key)->hard;
  return numberText(range.low) + " " + numberText(range.high);
}

/// A property that may have one of some values only.
struct Property {
  std::string_view block, key;
  std::vector<std::string_view> values;  ///< none: any
};

const std::vector<Property>& properties() {
  static const std::vector<Property> all{
      {"InputVariable", "enabled", {"true"}},
      {"InputVariable", "range", {}},
      {"InputVariable", "lock-range", {"false"}},
      {"OutputVariable", "enabled", {"true"}},
      {"OutputVariable", "range", {}},
      {"OutputVariable", "lock-range", {"false"}},
      {"OutputVariable", "lock-previous", {"false"}},
      {"OutputVariable", "aggregation", {}},
      {"OutputVariable",
       "defuzzifier",
       {"WeightedAverage TakagiSugeno", "WeightedAverage Automatic", "WeightedAverage"}},
      {"RuleBlock", "enabled", {"true"}},
      {"RuleBlock", "conjunction", {"Minimum", "none"}},
      {"RuleBlock", "disjunction", {}},
      {"RuleBlock", "implication", {}},
      {"RuleBlock", "activation", {"General", "none", ""}},
  };
  return all;
}

class Reader {
 public:
  explicit Reader(const std::string& where) : where_(where) {}

  Result<System> read(std::string_view text) {
    for (line_ = 1; !text.empty(); ++line_) {
      const std::string_view whole = takeLine(text);
      const std::string_view line = trimmed(whole.substr(0, whole.find('#')));
      if (!line.empty()) readLine(line);
    }
    if (system_.output.name.empty()) refuse("OutputVariable", "one", "none");
    for (const auto& [rule, line] : rules_) {
      line_ = line;
      readRule(rule);
    }
    if (!findings_.empty()) return findings_;
    return std::move(system_);
  }

 private:
  std::string place() const { return where_ + ":" + std::to_string(line_); }
  void refuse(std::string_view key, std::string expected, std::string_view found) {
    findings_.push_back(
        {Severity::error, place(), std::string(key), std::move(expected), std::string(found.substr(0, 80))});
  }

  void readLine(std::string_view line) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return refuse("", "key: value", line);
    const std::string_view key = trimmed(line.substr(0, colon)), value = trimmed(line.substr(colon + 1));
    if (key == "Engine") {
      system_.name = value;
    } else if (key == "InputVariable") {
      block_ = key;
      system_.inputs.push_back({std::string(value), {}, place()});
    } else if (key == "OutputVariable") {
      block_ = key;
      if (!system_.output.name.empty()) refuse(key, "one output", "a second one");
      system_.output.name = value;
      system_.output.where = place();
    } else if (key == "RuleBlock") {
      block_ = key;
      if (++ruleBlocks_ > 1) refuse(key, "one rule block", "a second one");
    } else if (key == "term" && block_ == "InputVariable") {
      readTerm(value, system_.inputs.back());
    } else if (key == "term" && block_ == "OutputVariable") {
      readTerm(value, system_.output);
    } else if (key == "rule" && block_ == "RuleBlock") {
      rules_.emplace_back(value, line_);
    } else if (key == "default" && block_ == "OutputVariable") {
      if (const auto number = readNumber(value); !number || (*number != 0 && *number == *number))
        refuse(key, "0 or nan: what no rule fires for is 0", value);
    } else if (key != "description") {
      readProperty(key, value);
    }
  }

  void readProperty(std::string_view key, std::string_view value) {
    const auto at = std::find_if(properties().begin(), properties().end(),
                                 [&](const Property& p) { return p.block == block_ && p.key == key; });
    if (at == properties().end())
      return refuse(key, "a property of " + (block_.empty() ? "an engine" : std::string(block_)), "another");
    if (key == "conjunction" && value == "none") hasNoConjunction_ = true;
    if (at->values.empty() || std::find(at->values.begin(), at->values.end(), value) != at->values.end())
      return;
    refuse(key, std::string(at->values.front()), value);
  }

  void readTerm(std::string_view text, Variable& variable) {
    const auto parts = words(text);
    if (parts.size() < 3) return refuse("term", "a name, a shape and numbers", text);
    Term term{std::string(parts[0]), std::string(parts[1]), {}, place()};
    for (std::size_t i = 2; i < parts.size(); ++i) {
      const auto number = readNumber(parts[i]);
      if (!number) return refuse("term " + term.name, "numbers", parts[i]);
      term.numbers.push_back(*number);
    }
    variable.terms.push_back(std::move(term));
  }

  /// if altitude is low and pitch is not down then total is u1 with 0.5
  void readRule(std::string_view text) {
    const auto parts = words(text);
    std::size_t at = 0;
    const auto take = [&]() {
      return at < parts.size() ? parts[at++] : std::string_view("the end of the line");
    };
    const auto wants = [&](std::string_view word) {
      const std::string_view found = take();
      if (found == word) return true;
      refuse("rule", "\"" + std::string(word) + "\"", found);
      return false;
    };
    Rule rule{{}, 0, 1, place()};
    if (!wants("if")) return;
    for (bool more = true; more;) {
      Condition condition;
      const std::string_view name = take();
      condition.input = indexOf(system_.inputs, name);
      if (condition.input == system_.inputs.size())
        return refuse("rule", "an input (" + namesOf(system_.inputs) + ")", name);
      if (!wants("is")) return;
      const std::vector<Term>& terms = system_.inputs[condition.input].terms;
      std::string_view word = take();
      // A hedge comes before a term, so a term may have its name.
      if (word == "any" && indexOf(terms, word) == terms.size()) {
        condition.hedge = Hedge::any;
      } else {
        if (word == "not") condition.hedge = Hedge::is_not, word = take();
        condition.term = indexOf(terms, word);
        if (condition.term == terms.size())
          return refuse("rule", "not, any or a term (" + namesOf(terms) + ")", word);
      }
      rule.conditions.push_back(condition);
      const std::string_view next = take();
      more = next == "and";
      if (more && hasNoConjunction_)
        return refuse("rule", "conjunction: Minimum", "\"and\" without conjunction");
      if (!more && next != "then") return refuse("rule", "\"and\" or \"then\"", next);
    }
    if (!wants(system_.output.name) || !wants("is")) return;
    const std::string_view output = take();
    rule.output = indexOf(system_.output.terms, output);
    if (rule.output == system_.output.terms.size())
      return refuse("rule", "a term (" + namesOf(system_.output.terms) + ")", output);
    if (at < parts.size()) {
      if (!wants("with")) return;
      const std::string_view weight = take();
      const auto number = readNumber(weight);
      if (!number) return refuse("rule", "a weight", weight);
      rule.weight = *number;
    }
    if (at < parts.size()) return refuse("rule", "the end of the line", parts[at]);
    system_.rules.push_back(std::move(rule));
  }

  const std::string& where_;
  int line_ = 0, ruleBlocks_ = 0;
  std::string_view block_;
  bool hasNoConjunction_ = false;
  std::vector<std::pair<std::string_view, int>> rules_;
  System system_;
  Findings findings_;
};

}  // namespace

std::string toFuzzyLite(const System& system) {
  std::string text = "Engine: " + system.name + "\n";
  for (const Variable& input : system.inputs) {
    text += "InputVariable: " + input.name + "\n  enabled: true\n  range: " +
            rangeText(input.name == "altitude" ? "fuzzy.altitude.curve_ft" : "fuzzy.pitch.curve_deg") +
            "\n  lock-range: false\n";
    for (const Term& term : input.terms) text += termLine(term);
  }
  text += "OutputVariable: " + system.output.name + "\n  enabled: true\n  range: 0 " +
          numberText(BandList::kTop) +
          "\n  lock-range: false\n  aggregation: none\n  defuzzifier: WeightedAverage TakagiSugeno\n"
          "  default: 0\n  lock-previous: false\n";
  for (const Term& term : system.output.terms) text += termLine(term);
  text +=
      "RuleBlock: rules\n  enabled: true\n  conjunction: Minimum\n  disjunction: none\n"
      "  implication: AlgebraicProduct\n  activation: General\n";
  for (const Rule& rule : system.rules) {
    text += "  rule: if";
    const char* joint = " ";
    for (const Condition& c : rule.conditions) {
      text += joint + system.inputs[c.input].name + " is " + system.inputs[c.input].terms[c.term].name;
      joint = " and ";
    }
    text += " then " + system.output.name + " is " + system.output.terms[rule.output].name + " with " +
            numberText(rule.weight) + "\n";
  }
  return text;
}

Result<System> readFuzzyLite(std::string_view text, const std::string& where) {
  return Reader(where).read(text);
}

}  // namespace trimtab::fuzzy_system
