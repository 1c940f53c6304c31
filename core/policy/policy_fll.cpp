#include <algorithm>
#include <cctype>
#include <map>

#include "condition.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/policy_file.h"
#include "trimtab/units/number.h"
#include "words.h"

namespace trimtab {
namespace {

/// As the language spells the shapes, in the enumeration's order.
constexpr std::array<std::string_view, kTermShapes.size()> kFllShapes{
    "Discrete", "Triangle", "Trapezoid", "Ramp", "Gaussian", "Bell", "Sigmoid"};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return text;
}

std::string rangeText(Range range) {
  return numberText(range.low) + " " + numberText(range.high);
}

/// The distinct values that rules give a lever, rising: its terms v1, v2 ...
std::vector<double> valuesOf(const Policy& policy, Lever lever) {
  std::vector<double> values;
  for (const PolicyRule& rule : policy.rules)
    for (const LeverSetting& setting : rule.settings)
      if (setting.lever == lever) values.push_back(setting.value);
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::string consequent(const Policy& policy, const PolicyRule& rule) {
  std::string text;
  for (const LeverSetting& setting : rule.settings) {
    const std::vector<double> values = valuesOf(policy, setting.lever);
    const auto at = std::lower_bound(values.begin(), values.end(), setting.value) - values.begin();
    text += (text.empty() ? "" : " and ") + std::string(rowOf(setting.lever).key) + " is v" +
            std::to_string(at + 1);
  }
  return rule.weight == 1 ? text : text + " with " + numberText(rule.weight);
}

std::string inputs(const Policy& policy) {
  std::string text;
  for (const SignalRow& row : kSignalRows) {
    std::string terms;
    for (const PolicyTerm& term : policy.terms) {
      if (term.signal != row.signal) continue;
      terms += "  term: " + term.name + " " + std::string(kFllShapes[static_cast<std::size_t>(term.shape)]);
      for (const double number : term.numbers) terms += " " + numberText(number);
      terms += "\n";
    }
    // A signal without terms is an input if a rule names it, as `any` may be asked of it.
    const bool named = std::any_of(policy.rules.begin(), policy.rules.end(), [&row](const PolicyRule& rule) {
      const auto words = policyWords(rule.condition);
      return std::find(words.begin(), words.end(), row.key) != words.end();
    });
    if (terms.empty() && !named) continue;
    text += "InputVariable: " + std::string(row.key) + "\n  enabled: true\n  range: " + rangeText(row.range) +
            "\n  lock-range: true\n" + terms;
  }
  return text;
}

std::string outputs(const Policy& policy) {
  std::string text;
  for (const LeverRow& row : kLeverRows) {
    const std::vector<double> values = valuesOf(policy, row.lever);
    if (values.empty()) continue;
    text += "OutputVariable: " + std::string(row.key) + "\n  enabled: true\n  range: " + rangeText(row.hard) +
            "\n  lock-range: false\n  aggregation: none\n  defuzzifier: WeightedAverage TakagiSugeno\n"
            "  default: nan\n  lock-previous: false\n";
    for (std::size_t i = 0; i < values.size(); ++i)
      text += "  term: v" + std::to_string(i + 1) + " Constant " + numberText(values[i]) + "\n";
  }
  return text;
}

class Reader {
 public:
  explicit Reader(const std::string& where) : where_(where) {}

  Result<Policy> read(std::string_view text) {
    for (line_ = 1; !text.empty(); ++line_) {
      const std::size_t end = text.find('\n');
      readLine(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    for (const Waiting& rule : rules_) {
      line_ = rule.line;
      readRule(rule);
    }
    if (policy_.rules.empty() && findings_.empty()) refuse("rule", "at least one rule", "none");
    if (!findings_.empty()) return findings_;
    const auto compiled = compile(policy_, where_);
    if (!compiled) return compiled.findings();
    return std::move(policy_);
  }

 private:
  struct Waiting {
    std::string text, reason;
    bool enabled;
    std::size_t line;
  };

  void refuse(std::string key, std::string expected, std::string_view found) {
    findings_.push_back({Severity::error, where_ + ":" + std::to_string(line_), std::move(key),
                         std::move(expected), found.empty() ? "nothing" : std::string(found.substr(0, 80))});
  }

  void readLine(std::string_view whole) {
    std::string_view line = trimmed(whole);
    const bool off = line.starts_with("# rule:");
    if (off) line = trimmed(line.substr(1));
    const std::size_t comment = line.find('#');
    const std::string_view reason =
        comment == std::string_view::npos ? std::string_view{} : trimmed(line.substr(comment + 1));
    line = trimmed(line.substr(0, comment));
    if (line.empty()) return;
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) return refuse("line", "KEY: VALUE", line);
    const std::string_view key = trimmed(line.substr(0, colon)), value = trimmed(line.substr(colon + 1));
    if (key == "rule")
      rules_.push_back({std::string(value), std::string(reason), !off, line_});
    else if (key == "Engine" || key == "InputVariable" || key == "OutputVariable" || key == "RuleBlock")
      beginBlock(key, value);
    else if (key == "term")
      readTerm(value);
    else
      readProperty(key, value);
  }

  void beginBlock(std::string_view block, std::string_view name) {
    block_ = block;
    signal_.reset();
    lever_.reset();
    if (block == "InputVariable" && !(signal_ = signalNamed(name)))
      refuse("InputVariable", "the key of a signal", name);
    if (block == "OutputVariable" && !(lever_ = leverNamed(name)))
      refuse("OutputVariable", "the key of a lever", name);
    if (block == "RuleBlock" && ++ruleBlocks_ > 1) refuse("RuleBlock", "one", "another");
  }

  void readTerm(std::string_view value) {
    const std::size_t nameEnd = std::min(value.find(' '), value.size());
    const std::string name(value.substr(0, nameEnd));
    const std::string_view shaped = trimmed(value.substr(nameEnd));
    const std::size_t shapeEnd = std::min(shaped.find(' '), shaped.size());
    const std::string_view shape = shaped.substr(0, shapeEnd), numbers = shaped.substr(shapeEnd);
    if (lever_) {
      const auto number = readNumber(trimmed(numbers));
      if (shape != "Constant" || !number) return refuse(name, "Constant and a number", shaped);
      values_[*lever_][name] = *number;
    } else if (signal_) {
      const auto known = std::find(kFllShapes.begin(), kFllShapes.end(), shape);
      if (known == kFllShapes.end()) return refuse(name, "a shape that a policy has", shape);
      const auto at = static_cast<std::size_t>(known - kFllShapes.begin());
      auto term = readShape(std::string(kTermShapes[at]) + std::string(numbers),
                            where_ + ":" + std::to_string(line_));
      if (!term) return addAll(term.findings());
      policy_.terms.push_back(std::move(*term));
      policy_.terms.back().signal = *signal_;
      policy_.terms.back().name = name;
    }
  }

  void addAll(const Findings& findings) {
    findings_.insert(findings_.end(), findings.begin(), findings.end());
  }

  void readProperty(std::string_view key, std::string_view value) {
    struct Allowed {
      std::string_view block, key;
      std::vector<std::string_view> values;
    };
    static const std::vector<Allowed> kAllowed{
        {"InputVariable", "enabled", {"true"}},
        {"OutputVariable", "enabled", {"true"}},
        {"OutputVariable", "lock-previous", {"false"}},
        {"OutputVariable", "default", {"nan"}},
        {"OutputVariable",
         "defuzzifier",
         {"WeightedAverage TakagiSugeno", "WeightedAverage Automatic", "WeightedAverage"}},
        {"RuleBlock", "enabled", {"true"}},
        {"RuleBlock", "activation", {"General", "none", ""}}};
    for (const Allowed& each : kAllowed)
      if (each.block == block_ && each.key == key &&
          std::find(each.values.begin(), each.values.end(), value) == each.values.end())
        refuse(std::string(key), std::string(each.values.front()), value);
    if (block_ == "RuleBlock" && (key == "conjunction" || key == "disjunction")) readNorm(key, value);
  }

  void readNorm(std::string_view key, std::string_view value) {
    if (value == "none" || value.empty()) return;
    const bool minimum = value == "Minimum" || value == "Maximum";
    if (!minimum && value != "AlgebraicProduct" && value != "AlgebraicSum")
      return refuse(std::string(key), "Minimum with Maximum, or AlgebraicProduct with AlgebraicSum", value);
    const PolicyNorm norm = minimum ? PolicyNorm::minimum : PolicyNorm::product;
    if (norm_ && *norm_ != norm) refuse(std::string(key), "the norm that goes with the other one", value);
    norm_ = policy_.norm = norm;
  }

  /// Rules are read last, since outputs may follow them.
  void readRule(const Waiting& waiting) {
    const auto words = policyWords(waiting.text);
    const auto then = std::find(words.begin(), words.end(), "then");
    if (words.empty() || words[0] != "if" || then == words.end())
      return refuse("rule", "if CONDITION then LEVER is VALUE", waiting.text);
    PolicyRule rule;
    rule.enabled = waiting.enabled;
    rule.reason = waiting.reason;
    for (auto word = words.begin() + 1; word != then; ++word) {
      const bool tight = rule.condition.empty() || rule.condition.back() == '(' || *word == ")";
      rule.condition += (tight ? "" : " ") + std::string(*word);
    }
    std::size_t at = static_cast<std::size_t>(then - words.begin());
    const auto wordAt = [&](std::size_t i) { return i < words.size() ? words[i] : std::string_view{}; };
    do {
      const auto lever = leverNamed(wordAt(++at));
      if (!lever) return refuse("rule", "the key of a lever", wordAt(at));
      if (wordAt(++at) != "is") return refuse("rule", "is after the lever", wordAt(at));
      const auto& values = values_[*lever];
      const auto value = values.find(std::string(wordAt(++at)));
      if (value == values.end())
        return refuse("rule", "a term of " + std::string(rowOf(*lever).key), wordAt(at));
      rule.settings.push_back({*lever, value->second});
    } while (wordAt(++at) == "and");
    if (wordAt(at) == "with") {
      const auto weight = readNumber(wordAt(++at));
      if (!weight) return refuse("rule", "a weight after with", wordAt(at));
      rule.weight = *weight;
      ++at;
    }
    if (at < words.size()) return refuse("rule", "the end of the rule", words[at]);
    policy_.rules.push_back(std::move(rule));
  }

  const std::string& where_;
  Policy policy_;
  Findings findings_;
  std::size_t line_ = 1, ruleBlocks_ = 0;
  std::string block_;
  std::optional<Signal> signal_;
  std::optional<Lever> lever_;
  std::optional<PolicyNorm> norm_;
  std::map<Lever, std::map<std::string, double>> values_;
  std::vector<Waiting> rules_;
};

}  // namespace

Result<std::string> toFuzzyLite(const Policy& policy, const std::string& name) {
  const auto compiled = compile(policy, name);
  if (!compiled) return compiled.findings();
  std::string engine;
  for (const char c : name) engine += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  const bool minimum = policy.norm == PolicyNorm::minimum;
  std::string text =
      "Engine: " + (engine.empty() ? "policy" : engine) + "\n" + inputs(policy) + outputs(policy) +
      "RuleBlock: policy\n  enabled: true\n  conjunction: " + (minimum ? "Minimum" : "AlgebraicProduct") +
      "\n  disjunction: " + (minimum ? "Maximum" : "AlgebraicSum") +
      "\n  implication: none\n  activation: General\n";
  for (const PolicyRule& rule : policy.rules) {
    const auto steps = readCondition(rule.condition, name, "rule");
    text += std::string(rule.enabled ? "  rule: " : "  # rule: ") + "if " + withSingleTermsNegated(*steps) +
            " then " + consequent(policy, rule);
    std::string reason = rule.reason;
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    text += (reason.empty() ? "" : "  # " + reason) + "\n";
  }
  return text;
}

Result<Policy> readFuzzyLite(std::string_view text, const std::string& where) {
  return Reader(where).read(text);
}

}  // namespace trimtab
