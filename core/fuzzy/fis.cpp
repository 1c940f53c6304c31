#include <algorithm>
#include <cmath>
#include <optional>

#include "fuzzy_system.h"
#include "trimtab/preset/table.h"
#include "trimtab/units/number.h"

// MATLAB's fuzzy inference system as text, with the membership functions that fuzzylite adds to it.
namespace trimtab::fuzzy_system {

namespace {

struct Shape {
  std::string_view matlab, fuzzylite;
};
/// linzmf falls from 1 at its first number to 0 at its second: a ramp from the second to the first.
constexpr Shape kShapes[] = {{"discretemf", "Discrete"}, {"rampmf", "Ramp"},    {"linsmf", "Ramp"},
                             {"linzmf", "Ramp"},         {"trimf", "Triangle"}, {"trapmf", "Trapezoid"},
                             {"constant", "Constant"}};

std::string_view unquoted(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '\'' && text.back() == '\'') text = text.substr(1, text.size() - 2);
  return text;
}

/// Numbers between blanks or commas; none where one is no number.
std::optional<std::vector<double>> numbersIn(std::string_view text) {
  std::string spaced(text);
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::vector<double> numbers;
  for (const std::string_view word : words(spaced)) {
    const auto number = readNumber(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

class Reader {
 public:
  explicit Reader(const std::string& where) : where_(where) {}

  Result<System> read(std::string_view text) {
    for (line_ = 1; !text.empty(); ++line_) {
      const std::string_view line = trimmed(takeLine(text));
      if (line.empty() || line.front() == '#' || line.front() == '%') continue;
      if (line.front() == '[' && line.back() == ']')
        openSection(line.substr(1, line.size() - 2));
      else if (section_ == "Rules")
        rules_.emplace_back(line, line_);
      else
        readEntry(line);
    }
    if (!isSugeno_) refuse("Type", "'sugeno'", "none");
    if (outputs_ == 0) refuse("Output1", "one output", "none");
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

  void openSection(std::string_view name) {
    section_ = name;
    if (name.starts_with("Input")) {
      system_.inputs.push_back({"", {}, place()});
      variable_ = static_cast<std::ptrdiff_t>(system_.inputs.size()) - 1;
    } else if (name.starts_with("Output")) {
      if (++outputs_ > 1) refuse(name, "one output", "a second one");
      system_.output.where = place();
      variable_ = -1;
    } else if (name != "System" && name != "Rules") {
      refuse(name, "[System], [Input1], [Output1] or [Rules]", name);
    }
  }

  void readEntry(std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) return refuse("", "key=value", line);
    const std::string_view key = trimmed(line.substr(0, equals)), value = trimmed(line.substr(equals + 1));
    if (section_ == "System") return readSystem(key, unquoted(value));
    if (section_ != "" && (section_.starts_with("Input") || section_.starts_with("Output"))) {
      Variable& variable =
          variable_ < 0 ? system_.output : system_.inputs[static_cast<std::size_t>(variable_)];
      if (key == "Name") {
        variable.name = unquoted(value);
      } else if (key.starts_with("MF")) {
        readTerm(key, value, variable);
      } else if (key != "Range" && key != "NumMFs") {
        refuse(key, "Name, Range, NumMFs or MF1", "another");
      }
      return;
    }
    refuse(key, "a section", "none");
  }

  void readSystem(std::string_view key, std::string_view value) {
    const auto wants = [&](std::string_view wanted) {
      if (value != wanted) refuse(key, "'" + std::string(wanted) + "'", value);
    };
    if (key == "Name") system_.name = value;
    if (key == "Type") {
      isSugeno_ = true;
      wants("sugeno");
    }
    if (key == "AndMethod") wants("min");
    if (key == "DefuzzMethod") wants("wtaver");
  }

  /// MF1='low':'discretemf',[4000 1 5000 0.6]
  void readTerm(std::string_view key, std::string_view text, Variable& variable) {
    const std::size_t colon = text.find(':'), open = text.find('['), close = text.rfind(']');
    const std::size_t comma = text.find(',', std::min(colon, text.size()));
    if (colon == std::string_view::npos || open == std::string_view::npos ||
        close == std::string_view::npos || close < open || comma > open)
      return refuse(key, "'name':'shape',[numbers]", text);
    const std::string_view shape = unquoted(text.substr(colon + 1, comma - colon - 1));
    const auto known = std::find_if(std::begin(kShapes), std::end(kShapes),
                                    [&](const Shape& s) { return s.matlab == shape; });
    if (known == std::end(kShapes))
      return refuse(key, "discretemf, rampmf, linsmf, linzmf, trimf, trapmf or constant", shape);
    const auto numbers = numbersIn(text.substr(open + 1, close - open - 1));
    if (!numbers) return refuse(key, "numbers", text.substr(open));
    Term term{std::string(unquoted(text.substr(0, colon))), std::string(known->fuzzylite), *numbers, place()};
    if (shape == "linzmf") std::reverse(term.numbers.begin(), term.numbers.end());
    variable.terms.push_back(std::move(term));
  }

  /// "1 -2, 3 (0.5) : 1": a term of each input (0 none, negative not, 0.99 fuzzylite's any), a term of the
  /// output, weight, 1 for and.
  void readRule(std::string_view text) {
    const std::string expected = "terms of inputs, a term of the output (weight) : 1";
    const std::size_t open = text.find('('), close = text.find(')'), colon = text.rfind(':');
    if (open == std::string_view::npos || close == std::string_view::npos ||
        colon == std::string_view::npos || close < open || colon < close)
      return refuse("Rules", expected, text);
    const auto terms = numbersIn(text.substr(0, open));
    const auto weight = readNumber(trimmed(text.substr(open + 1, close - open - 1)));
    const auto joint = readNumber(trimmed(text.substr(colon + 1)));
    if (!terms || terms->size() != system_.inputs.size() + 1 || !weight || !joint)
      return refuse("Rules", expected, text);
    Rule rule{{}, 0, *weight, place()};
    for (std::size_t i = 0; i < system_.inputs.size(); ++i) {
      const double code = (*terms)[i];
      if (code == 0) continue;
      Condition condition{i, code < 0 ? Hedge::is_not : Hedge::is, 0};
      const double number = std::abs(code);
      if (std::abs(number - std::floor(number) - 0.99) < 1e-6) {
        condition.hedge = Hedge::any;
      } else if (number != std::floor(number) ||
                 number > static_cast<double>(system_.inputs[i].terms.size())) {
        return refuse("Rules", "the number of a term of " + system_.inputs[i].name, numberText(code));
      } else {
        condition.term = static_cast<std::size_t>(number) - 1;
      }
      rule.conditions.push_back(condition);
    }
    const double output = terms->back();
    if (output != std::floor(output) || output < 1 ||
        output > static_cast<double>(system_.output.terms.size()))
      return refuse("Rules", "the number of a term of " + system_.output.name, numberText(output));
    rule.output = static_cast<std::size_t>(output) - 1;
    if (*joint != 1 && rule.conditions.size() > 1)
      return refuse("Rules", "1, the conjunction", numberText(*joint));
    system_.rules.push_back(std::move(rule));
  }

  const std::string& where_;
  int line_ = 0, outputs_ = 0;
  bool isSugeno_ = false;
  std::string_view section_;
  std::ptrdiff_t variable_ = -1;  ///< index of the input being read; -1: the output
  std::vector<std::pair<std::string_view, int>> rules_;
  System system_;
  Findings findings_;
};

std::string termsText(const Variable& variable) {
  std::string text = "NumMFs=" + std::to_string(variable.terms.size()) + "\n";
  for (std::size_t i = 0; i < variable.terms.size(); ++i) {
    const Term& term = variable.terms[i];
    const auto shape = std::find_if(std::begin(kShapes), std::end(kShapes),
                                    [&](const Shape& s) { return s.fuzzylite == term.shape; });
    text += "MF" + std::to_string(i + 1) + "='" + term.name + "':'" + std::string(shape->matlab) + "',[";
    for (std::size_t n = 0; n < term.numbers.size(); ++n)
      text += (n > 0 ? " " : "") + numberText(term.numbers[n]);
    text += "]\n";
  }
  return text;
}

std::string rangeText(double low, double high) {
  return "Range=[" + numberText(low) + " " + numberText(high) + "]\n";
}

}  // namespace

std::string toMatlab(const System& system) {
  std::string text = "[System]\nName='" + system.name +
                     "'\nType='sugeno'\nVersion=2.0\nNumInputs=" + std::to_string(system.inputs.size()) +
                     "\nNumOutputs=1\nNumRules=" + std::to_string(system.rules.size()) +
                     "\nAndMethod='min'\nOrMethod='max'\nImpMethod='prod'\nAggMethod='sum'\n"
                     "DefuzzMethod='wtaver'\n";
  for (std::size_t i = 0; i < system.inputs.size(); ++i) {
    const Variable& input = system.inputs[i];
    const Range range =
        findRow(input.name == "altitude" ? "fuzzy.altitude.curve_ft" : "fuzzy.pitch.curve_deg")->hard;
    text += "\n[Input" + std::to_string(i + 1) + "]\nName='" + input.name + "'\n" +
            rangeText(range.low, range.high) + termsText(input);
  }
  text += "\n[Output1]\nName='" + system.output.name + "'\n" + rangeText(0, BandList::kTop) +
          termsText(system.output) + "\n[Rules]\n";
  for (const Rule& rule : system.rules) {
    std::vector<std::size_t> term(system.inputs.size(), 0);
    for (const Condition& c : rule.conditions) term[c.input] = c.term + 1;
    for (std::size_t i = 0; i < term.size(); ++i) text += (i > 0 ? " " : "") + std::to_string(term[i]);
    text += ", " + std::to_string(rule.output + 1) + " (" + numberText(rule.weight) + ") : 1\n";
  }
  return text;
}

Result<System> readMatlab(std::string_view text, const std::string& where) {
  return Reader(where).read(text);
}

}  // namespace trimtab::fuzzy_system
