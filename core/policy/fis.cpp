#include <algorithm>
#include <array>
#include <cmath>

#include "system_text.h"
#include "trimtab/units/number.h"
#include "words.h"

// MATLAB's fuzzy inference system as text, with the shapes and hedges that fuzzylite adds to it.
namespace trimtab::fuzzy_system {

namespace {

constexpr std::string_view kReason = "% reason:", kOff = "% rule:";

/// Says how the order of a shape's numbers in MATLAB's language differs from fuzzylite's.
enum class Order { same, reversed, first_is_last };
struct Shape {
  std::string_view matlab, fuzzylite;
  Order order;
};
/// linzmf falls from 1 at its first number to 0 at its second: a ramp from the second to the first.
constexpr Shape kShapes[] = {
    {"discretemf", "Discrete", Order::same},  {"rampmf", "Ramp", Order::same},
    {"linsmf", "Ramp", Order::same},          {"linzmf", "Ramp", Order::reversed},
    {"trimf", "Triangle", Order::same},       {"trapmf", "Trapezoid", Order::same},
    {"gaussmf", "Gaussian", Order::reversed}, {"gbellmf", "Bell", Order::first_is_last},
    {"sigmf", "Sigmoid", Order::reversed},    {"constant", "Constant", Order::same}};

struct Norm {
  std::string_view matlab, fuzzylite;
};
constexpr Norm kConjunctions[] = {{"min", "Minimum"}, {"prod", "AlgebraicProduct"}};
constexpr Norm kDisjunctions[] = {{"max", "Maximum"}, {"probor", "AlgebraicSum"}};

/// Holds what fuzzylite adds to the number of a term for the hedges before it; a minus sign says not.
struct HedgeCode {
  std::string_view hedges;
  const char* code;
  double fraction;
};
constexpr HedgeCode kHedges[] = {{"", "", 0},         {"seldom", ".01", 0.01},  {"somewhat", ".05", 0.05},
                                 {"very", ".2", 0.2}, {"extremely", ".3", 0.3}, {"very very", ".4", 0.4}};
constexpr double kAny = 0.99;

bool near(double a, double b) {
  return std::abs(a - b) < 1e-6;
}

std::string_view unquoted(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '\'' && text.back() == '\'') text = text.substr(1, text.size() - 2);
  return text;
}

/// Returns a name as one word; MATLAB's may have blanks.
std::string asWord(std::string_view text) {
  std::string word(unquoted(text));
  std::replace_if(
      word.begin(), word.end(),
      [](char c) { return std::string_view(" \t(),=#").find(c) != std::string_view::npos; }, '_');
  return word;
}

/// Numbers between blanks or commas; nothing if one is no number.
std::optional<std::vector<double>> numbersIn(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view word : policyWords(text)) {
    if (word == ",") continue;
    const auto number = readNumber(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& where) : lines_(text, where) {}

  Result<System> read() {
    while (const auto line = lines_.next()) readLine(*line);
    if (!isSugeno_) lines_.refuse("Type", "'sugeno'", "none");
    if (system_.inputs.empty()) lines_.refuse("Input1", "an input", "none");
    if (system_.outputs.empty()) lines_.refuse("Output1", "an output", "none");
    // Rules are read last, since variables may follow them.
    for (const auto& [rule, text] : rules_)
      if (!system_.inputs.empty()) readRule(rule, text);
    if (!lines_.empty()) return lines_.findings();
    return std::move(system_);
  }

 private:
  void readLine(std::string_view line) {
    if (section_ == "Rules" && line.starts_with(kReason)) {
      reason_ = oneLine(line.substr(kReason.size()));
      return;
    }
    const bool off = isSwitchedOff(line);
    if (off) line = trimmed(line.substr(kOff.size()));
    if (line.empty() || line.front() == '#' || line.front() == '%') return;
    if (line.front() == '[' && line.back() == ']') return openSection(line.substr(1, line.size() - 2));
    if (section_ != "Rules") return readEntry(line);
    if (rules_.size() == kMostRules)
      lines_.refuse("Rules", "at most " + std::to_string(kMostRules) + " rules", "more");
    if (rules_.size() <= kMostRules)
      rules_.push_back({{"", {}, 1, !off, std::exchange(reason_, {}), lines_.place()}, line});
  }

  /// Other comments may begin alike.
  bool isSwitchedOff(std::string_view line) const {
    if (section_ != "Rules" || !line.starts_with(kOff)) return false;
    const std::string_view rule = trimmed(line.substr(kOff.size()));
    return !rule.empty() && std::string_view("-0123456789").find(rule.front()) != std::string_view::npos;
  }

  void openSection(std::string_view name) {
    section_ = name;
    const bool input = name.starts_with("Input");
    if (input || name.starts_with("Output")) {
      auto& list = input ? system_.inputs : system_.outputs;
      if (list.size() == kMostVariables)
        return lines_.refuse(name, "at most " + std::to_string(kMostVariables) + " of a kind", "more");
      variable_ = &list.emplace_back();
      variable_->where = lines_.place();
      const std::string wanted = (input ? "Input" : "Output") + std::to_string(list.size());
      if (name != wanted) lines_.refuse(name, "[" + wanted + "]", name);
    } else if (name != "System" && name != "Rules") {
      lines_.refuse(name, "[System], [Input1], [Output1] or [Rules]", name);
    }
  }

  void readEntry(std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) return lines_.refuse("", "key=value", line);
    const std::string_view key = trimmed(line.substr(0, equals)), value = trimmed(line.substr(equals + 1));
    if (section_ == "System") return readSystem(key, unquoted(value));
    if (!section_.starts_with("Input") && !section_.starts_with("Output"))
      return lines_.refuse(key, "a section", "none");
    if (key == "Name") {
      variable_->name = asWord(value);
    } else if (key == "Range") {
      const auto ends = value.size() < 2 ? std::nullopt : numbersIn(value.substr(1, value.size() - 2));
      if (!ends || ends->size() != 2) return lines_.refuse(key, "[low high]", value);
      variable_->range = {(*ends)[0], (*ends)[1]};
    } else if (key.starts_with("MF")) {
      readTerm(key, value);
    } else if (key != "NumMFs") {
      lines_.refuse(key, "Name, Range, NumMFs or MF1", "another");
    }
  }

  void readSystem(std::string_view key, std::string_view value) {
    const auto wants = [&](std::string_view wanted) {
      if (value != wanted) lines_.refuse(key, "'" + std::string(wanted) + "'", value);
    };
    const auto norm = [&](const Norm(&norms)[2], Setting& setting) {
      for (const Norm& each : norms)
        if (each.matlab == value) setting = {std::string(each.fuzzylite), lines_.place()};
      if (setting.value.empty())
        lines_.refuse(key, "'" + std::string(norms[0].matlab) + "' or '" + std::string(norms[1].matlab) + "'",
                      value);
    };
    if (key == "Name") system_.name = value;
    if (key == "Type") {
      isSugeno_ = true;
      wants("sugeno");
    }
    if (key == "AndMethod") norm(kConjunctions, system_.conjunction);
    if (key == "OrMethod") norm(kDisjunctions, system_.disjunction);
    if (key == "DefuzzMethod") wants("wtaver");
  }

  /// MF1='low':'discretemf',[4000 1 5000 0.6]
  void readTerm(std::string_view key, std::string_view text) {
    if (++terms_ > kMostTerms) {
      if (terms_ == kMostTerms + 1)
        lines_.refuse(key, "at most " + std::to_string(kMostTerms) + " terms", "more");
      return;
    }
    const std::string wanted = "MF" + std::to_string(variable_->terms.size() + 1);
    if (key != wanted) return lines_.refuse(key, wanted, key);
    const std::size_t colon = text.find(':'), open = text.find('['), close = text.rfind(']');
    const std::size_t comma = text.find(',', std::min(colon, text.size()));
    if (colon == std::string_view::npos || open == std::string_view::npos ||
        close == std::string_view::npos || close < open || comma > open)
      return lines_.refuse(key, "'name':'shape',[numbers]", text);
    const std::string_view shape = unquoted(text.substr(colon + 1, comma - colon - 1));
    const auto known = std::find_if(std::begin(kShapes), std::end(kShapes),
                                    [&](const Shape& s) { return s.matlab == shape; });
    if (known == std::end(kShapes)) {
      std::string names;
      for (const Shape& each : kShapes) names += (names.empty() ? "" : ", ") + std::string(each.matlab);
      return lines_.refuse(key, names, shape);
    }
    auto numbers = numbersIn(text.substr(open + 1, close - open - 1));
    if (!numbers) return lines_.refuse(key, "numbers", text.substr(open));
    if (known->order == Order::reversed) std::reverse(numbers->begin(), numbers->end());
    if (known->order == Order::first_is_last && !numbers->empty())
      std::rotate(numbers->begin(), numbers->end() - 1, numbers->end());
    variable_->terms.push_back(
        {asWord(text.substr(0, colon)), std::string(known->fuzzylite), std::move(*numbers), lines_.place()});
  }

  /// "1 -2 0, 3 0 (0.5) : 1": a term of each input (0 for none), a term of each output, the weight, and 1 for
  /// and or 2 for or.
  void readRule(Rule rule, std::string_view text) {
    const auto refuse = [&](std::string expected, std::string_view found) {
      lines_.refuseAt(rule.where, "Rules", std::move(expected), found);
    };
    const std::size_t comma = text.find(','), open = text.find('('), close = text.find(')'),
                      colon = text.rfind(':'), end = std::string_view::npos;
    const std::string form = "terms of inputs, terms of outputs (weight) : 1";
    if (comma == end || open == end || close == end || colon == end || open < comma || close < open ||
        colon < close)
      return refuse(form, text);
    const auto inputs = numbersIn(text.substr(0, comma)),
               outputs = numbersIn(text.substr(comma + 1, open - comma - 1));
    const auto weight = readNumber(trimmed(text.substr(open + 1, close - open - 1))),
               joint = readNumber(trimmed(text.substr(colon + 1)));
    if (!inputs || inputs->size() != system_.inputs.size() || !outputs ||
        outputs->size() != system_.outputs.size() || !weight || !joint)
      return refuse(form, text);
    if (*joint != 1 && *joint != 2) return refuse("1 for and, or 2 for or", numberText(*joint));
    rule.weight = *weight;
    for (std::size_t i = 0; i < inputs->size(); ++i) {
      if ((*inputs)[i] == 0) continue;
      const auto proposition = propositionOf((*inputs)[i], system_.inputs[i]);
      if (!proposition)
        return refuse("the number of a term of " + system_.inputs[i].name, numberText((*inputs)[i]));
      rule.condition += (rule.condition.empty() ? "" : *joint == 1 ? " and " : " or ") + *proposition;
    }
    if (rule.condition.empty()) rule.condition = system_.inputs[0].name + " is any";
    for (std::size_t i = 0; i < outputs->size(); ++i) {
      const double code = (*outputs)[i];
      if (code == 0) continue;
      const Variable& output = system_.outputs[i];
      if (code != std::floor(code) || !(code >= 1 && code <= static_cast<double>(output.terms.size())))
        return refuse("the number of a term of " + output.name, numberText(code));
      rule.conclusions.push_back({i, static_cast<std::size_t>(code) - 1});
    }
    if (rule.conclusions.empty()) return refuse("a term of an output", "none");
    system_.rules.push_back(std::move(rule));
  }

  static std::optional<std::string> propositionOf(double code, const Variable& input) {
    std::string text = input.name + (code < 0 ? " is not " : " is ");
    const double size = std::abs(code), number = std::floor(size + 1e-6), fraction = size - number;
    if (!(size <= kMostTerms + 1)) return std::nullopt;
    if (near(fraction, kAny)) return text + "any";
    const auto hedge = std::find_if(std::begin(kHedges), std::end(kHedges),
                                    [&](const HedgeCode& h) { return near(h.fraction, fraction); });
    if (hedge == std::end(kHedges) || number < 1 || number > static_cast<double>(input.terms.size()))
      return std::nullopt;
    return text + std::string(hedge->hedges) + (hedge->hedges.empty() ? "" : " ") +
           input.terms[static_cast<std::size_t>(number) - 1].name;
  }

  Lines lines_;
  bool isSugeno_ = false;
  std::size_t terms_ = 0;
  std::string_view section_;
  std::string reason_;            ///< of the next rule
  Variable* variable_ = nullptr;  ///< the last one; no list grows while its last element is read
  std::vector<std::pair<Rule, std::string_view>> rules_;
  System system_;
};

std::string variableText(const Variable& variable) {
  std::string text = "Name='" + variable.name + "'\nRange=[" + numberText(variable.range.low) + " " +
                     numberText(variable.range.high) + "]\nNumMFs=" + std::to_string(variable.terms.size()) +
                     "\n";
  for (std::size_t i = 0; i < variable.terms.size(); ++i) {
    const Term& term = variable.terms[i];
    const auto shape = std::find_if(std::begin(kShapes), std::end(kShapes),
                                    [&](const Shape& s) { return s.fuzzylite == term.shape; });
    std::vector<double> numbers = term.numbers;
    if (shape->order == Order::reversed) std::reverse(numbers.begin(), numbers.end());
    if (shape->order == Order::first_is_last)
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
    const auto hedge = std::find_if(std::begin(kHedges), std::end(kHedges),
                                    [&](const HedgeCode& h) { return h.hedges == hedges; });
    if (hedge == std::end(kHedges) || (any && !hedges.empty()))
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
  const auto nameOf = [](const Norm(&norms)[2], const Setting& setting) {
    return std::string(norms[setting.value == norms[1].fuzzylite].matlab);
  };
  const auto rules =
      std::count_if(system.rules.begin(), system.rules.end(), [](const Rule& r) { return r.enabled; });
  std::string text = "[System]\nName='" + system.name +
                     "'\nType='sugeno'\nVersion=2.0\nNumInputs=" + std::to_string(system.inputs.size()) +
                     "\nNumOutputs=" + std::to_string(system.outputs.size()) +
                     "\nNumRules=" + std::to_string(rules) + "\nAndMethod='" +
                     nameOf(kConjunctions, system.conjunction) + "'\nOrMethod='" +
                     nameOf(kDisjunctions, system.disjunction) +
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
    if (!reason.empty()) text += std::string(kReason) + " " + reason + "\n";
    text += (rule.enabled ? "" : std::string(kOff) + " ") + *numbers + "\n";
  }
  if (!findings.empty()) return findings;
  return text;
}

Result<System> readMatlab(std::string_view text, const std::string& where) {
  return Reader(text, where).read();
}

}  // namespace trimtab::fuzzy_system
