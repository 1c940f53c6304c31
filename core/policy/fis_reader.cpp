#include <algorithm>
#include <array>
#include <cmath>

#include "fis_words.h"
#include "fuzzy_names.h"
#include "system_text.h"
#include "trimtab/units/number.h"
#include "words.h"

// Reads MATLAB's fuzzy inference system as text, with the shapes and hedges that fuzzylite adds to it. Keys
// and the names of types and shapes may be in capitals.
namespace trimtab::fuzzy_system {

namespace {

bool near(double a, double b) {
  return std::abs(a - b) < 1e-6;
}

std::string_view unquoted(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '\'' && text.back() == '\'') text = text.substr(1, text.size() - 2);
  return text;
}

/// Returns the text before a comment that begins outside of quotes.
std::string_view withoutComment(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\'') quoted = !quoted;
    if (!quoted && (line[i] == '%' || line[i] == '#')) return trimmed(line.substr(0, i));
  }
  return line;
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

/// Holds what a file says how many there are of something, and where it says so.
struct Count {
  std::string_view key, value;
  std::string where;
};

class Reader {
 public:
  Reader(std::string_view text, const std::string& where) : lines_(text, where) {}

  Result<System> read() {
    while (const auto line = lines_.next()) readLine(*line);
    // A file that was cut misses many things. Only the first fault is reported, and none that follows from
    // it.
    checkMethods();
    if (lines_.empty()) checkWhatIsThere();
    nameAll();
    // Rules are read last, since variables may follow them.
    for (const auto& [rule, text] : rules_)
      if (!system_.inputs.empty() && !system_.outputs.empty()) readRule(rule, text);
    if (lines_.empty()) checkCounts();
    if (!lines_.empty()) return lines_.findings();
    return {std::move(system_), lines_.findings()};
  }

 private:
  enum class Section { none, unknown, system, variable, rules };

  void readLine(std::string_view line) {
    if (section_ == Section::rules && line.starts_with(kFisReason)) {
      reason_ = oneLine(line.substr(kFisReason.size()));
      return;
    }
    const bool off = isSwitchedOff(line);
    if (off) line = trimmed(line.substr(kFisOff.size()));
    if (line.empty()) return;
    if (line.front() == '[' && line.back() == ']') return openSection(line.substr(1, line.size() - 2));
    const std::string_view whole = line;
    line = withoutComment(line);
    if (line.empty() || section_ == Section::unknown) return;
    if (section_ != Section::rules) return readEntry(line);
    if (rules_.size() == kMostRules)
      lines_.refuse("Rules", "at most " + std::to_string(kMostRules) + " rules", "more");
    if (rules_.size() > kMostRules) return;
    if (reason_.empty() && whole.size() > line.size())
      reason_ = oneLine(trimmed(whole.substr(line.size())).substr(1));
    rules_.push_back({{"", {}, 1, !off, std::exchange(reason_, {}), lines_.place()}, line});
  }

  /// Other comments may begin alike.
  bool isSwitchedOff(std::string_view line) const {
    if (section_ != Section::rules || !line.starts_with(kFisOff)) return false;
    const std::string_view rule = trimmed(line.substr(kFisOff.size()));
    return !rule.empty() && std::string_view("-0123456789").find(rule.front()) != std::string_view::npos;
  }

  void openSection(std::string_view name) {
    const std::string lower = lowered(name.substr(0, 40));
    const bool input = lower.starts_with("input");
    if (input || lower.starts_with("output")) {
      section_ = Section::variable;
      auto& list = input ? system_.inputs : system_.outputs;
      if (list.size() == kMostVariables) {
        section_ = Section::unknown;
        return lines_.refuse(name, "at most " + std::to_string(kMostVariables) + " of a kind", "more");
      }
      variable_ = &list.emplace_back();
      variable_->where = lines_.place();
      const std::string wanted = (input ? "Input" : "Output") + std::to_string(list.size());
      if (lower != lowered(wanted)) lines_.refuse(name, "[" + wanted + "]", name);
    } else if (lower == "system") {
      section_ = Section::system;
    } else if (lower == "rules") {
      section_ = Section::rules;
      hasRules_ = true;
    } else {
      section_ = Section::unknown;
      lines_.refuse(name, "[System], [Input1], [Output1] or [Rules]", name);
    }
  }

  void readEntry(std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) return lines_.refuse("", "key=value", line);
    const std::string_view key = trimmed(line.substr(0, equals)), value = trimmed(line.substr(equals + 1));
    const std::string lower = lowered(key.substr(0, 40));
    if (section_ == Section::system) return readSystem(key, lower, unquoted(value));
    if (section_ != Section::variable) return lines_.refuse(key, "a section", "none");
    if (lower == "name") {
      variable_->name = unquoted(value);
    } else if (lower == "range") {
      const auto ends = value.size() < 2 ? std::nullopt : numbersIn(value.substr(1, value.size() - 2));
      if (!ends || ends->size() != 2) return lines_.refuse(key, "[low high]", value);
      variable_->range = {(*ends)[0], (*ends)[1]};
    } else if (lower == "nummfs") {
      const auto& [inputs, outputs] = std::tie(system_.inputs, system_.outputs);
      const bool input = !inputs.empty() && variable_ == &inputs.back();
      mfCounts_.push_back({{key, value, lines_.place()}, input, (input ? inputs : outputs).size() - 1});
    } else if (lower.starts_with("mf")) {
      readTerm(key, lower, value);
    } else {
      lines_.refuse(key, "Name, Range, NumMFs or MF1", "another");
    }
  }

  void readSystem(std::string_view key, const std::string& lower, std::string_view value) {
    const std::string word = lowered(value.substr(0, 80));
    const auto known = [&word](const FisNorm(&norms)[2]) {
      return std::find_if(std::begin(norms), std::end(norms),
                          [&](const FisNorm& norm) { return norm.matlab == word; });
    };
    const auto count = [&](Count& each) { each = {key, value, lines_.place()}; };
    if (lower == "name") system_.name = value;
    if (lower == "type") {
      hasType_ = true;
      if (word == "mamdani") system_.mamdani.emplace();
      if (word != "sugeno" && word != "mamdani") lines_.refuse(key, "'sugeno' or 'mamdani'", value);
    }
    if (lower == "andmethod") {
      const auto norm = known(kFisConjunctions);
      if (norm == std::end(kFisConjunctions)) return lines_.refuse(key, "'min' or 'prod'", value);
      system_.conjunction = {std::string(norm->fuzzylite), lines_.place()};
    }
    if (lower == "ormethod") {  // a word that is unknown counts only if a rule says or
      const auto norm = known(kFisDisjunctions);
      const bool strange = norm == std::end(kFisDisjunctions);
      system_.disjunction = {strange ? word : std::string(norm->fuzzylite), lines_.place()};
    }
    if (lower == "impmethod") implication_ = {word, lines_.place()};
    if (lower == "aggmethod") aggregation_ = {word, lines_.place()};
    if (lower == "defuzzmethod") defuzzifier_ = {word, lines_.place()};
    if (lower == "numinputs") count(inputCount_);
    if (lower == "numoutputs") count(outputCount_);
    if (lower == "numrules") count(ruleCount_);
  }

  /// MF1='low':'discretemf',[4000 1 5000 0.6]. A term that is refused keeps its place, so that the rules,
  /// which count terms, are not refused for it too.
  void readTerm(std::string_view key, const std::string& lower, std::string_view text) {
    if (++terms_ > kMostTerms) {
      if (terms_ == kMostTerms + 1)
        lines_.refuse(key, "at most " + std::to_string(kMostTerms) + " terms", "more");
      return;
    }
    Term& term = variable_->terms.emplace_back(Term{"", "Constant", {}, lines_.place()});
    const std::string wanted = "MF" + std::to_string(variable_->terms.size());
    if (lower != lowered(wanted)) return lines_.refuse(key, wanted, key);
    constexpr std::size_t kEnd = std::string_view::npos;
    const std::size_t quote = text.starts_with('\'') ? text.find('\'', 1) : 0,
                      colon = text.find(':', std::min(quote, text.size())),
                      comma = text.find(',', std::min(colon, text.size())),
                      open = text.find('[', std::min(comma, text.size())), close = text.rfind(']');
    if (open == kEnd || close == kEnd || close < open)
      return lines_.refuse(key, "'name':'shape',[numbers]", text);
    term.name = unquoted(text.substr(0, colon));
    const std::string_view shape = unquoted(text.substr(colon + 1, comma - colon - 1));
    const auto known = std::find_if(std::begin(kFisShapes), std::end(kFisShapes), [&](const FisShape& s) {
      return s.matlab == lowered(shape.substr(0, 40));
    });
    if (known == std::end(kFisShapes)) {
      std::string names;
      for (const FisShape& each : kFisShapes) names += (names.empty() ? "" : ", ") + std::string(each.matlab);
      return lines_.refuse(key, names, shape);
    }
    auto numbers = numbersIn(text.substr(open + 1, close - open - 1));
    if (!numbers) return lines_.refuse(key, "numbers", text.substr(open));
    if (known->order == FisOrder::reversed) std::reverse(numbers->begin(), numbers->end());
    if (known->order == FisOrder::first_is_last && !numbers->empty())
      std::rotate(numbers->begin(), numbers->end() - 1, numbers->end());
    term.shape = known->system;
    term.numbers = std::move(*numbers);
  }

  void checkWhatIsThere() {
    if (!hasRules_) return lines_.refuse("Rules", "[Rules]; the file may be cut", "the end of the file");
    if (!hasType_) lines_.refuse("Type", "'sugeno' or 'mamdani'", "none");
    if (system_.inputs.empty()) lines_.refuse("Input1", "an input", "none");
    if (system_.outputs.empty()) lines_.refuse("Output1", "an output", "none");
  }

  /// The methods have a meaning only once the type is known, which may follow them.
  void checkMethods() {
    const auto take = [this](const Setting& method, const char* key, std::string expected,
                             std::string& into) {
      if (method.value.empty()) return;
      if (expected.find("'" + method.value + "'") == std::string::npos)
        lines_.refuseAt(method.where, key, std::move(expected), method.value);
      into = method.value;
    };
    if (!hasType_) return;
    std::string average;
    if (!system_.mamdani)
      return take(defuzzifier_, "DefuzzMethod", "'wtaver', the weighted average", average);
    take(implication_, "ImpMethod", "'min' or 'prod'", system_.mamdani->implication);
    take(aggregation_, "AggMethod", "'max', 'sum' or 'probor'", system_.mamdani->aggregation);
    take(defuzzifier_, "DefuzzMethod", "'centroid', 'bisector', 'mom', 'lom' or 'som'",
         system_.mamdani->defuzzifier);
  }

  void checkCounts() {
    const auto check = [this](const Count& said, std::size_t there, const char* what) {
      if (said.key.empty() || readNumber(said.value) == static_cast<double>(there)) return;
      lines_.refuseAt(said.where, said.key, std::to_string(there) + what + ", as many as follow", said.value);
    };
    check(inputCount_, system_.inputs.size(), " inputs");
    check(outputCount_, system_.outputs.size(), " outputs");
    for (const auto& [said, input, index] : mfCounts_)
      check(said, (input ? system_.inputs : system_.outputs)[index].terms.size(), " terms");
    const auto on = [](const auto& rule) { return rule.first.enabled; };
    check(ruleCount_, static_cast<std::size_t>(std::count_if(rules_.begin(), rules_.end(), on)), " rules");
  }

  void nameAll() {
    for (auto* const variables : {&system_.inputs, &system_.outputs}) {
      makeNamesWords(*variables, lines_);
      for (Variable& variable : *variables) makeNamesWords(variable.terms, lines_);
    }
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
    if (rule.conclusions.empty()) return refuse("a term of an output, or no such rule", "none");
    system_.rules.push_back(std::move(rule));
  }

  static std::optional<std::string> propositionOf(double code, const Variable& input) {
    std::string text = input.name + (code < 0 ? " is not " : " is ");
    const double size = std::abs(code), number = std::floor(size + 1e-6), fraction = size - number;
    if (!(size <= kMostTerms + 1)) return std::nullopt;
    if (near(fraction, kFisAny)) return text + "any";
    const auto hedge = std::find_if(std::begin(kFisHedges), std::end(kFisHedges),
                                    [&](const FisHedge& h) { return near(h.fraction, fraction); });
    if (hedge == std::end(kFisHedges) || number < 1 || number > static_cast<double>(input.terms.size()))
      return std::nullopt;
    return text + std::string(hedge->hedges) + (hedge->hedges.empty() ? "" : " ") +
           input.terms[static_cast<std::size_t>(number) - 1].name;
  }

  /// Says how many terms the variable has that is this one of its kind.
  struct TermCount {
    Count said;
    bool input;
    std::size_t index;
  };

  Lines lines_;
  bool hasType_ = false, hasRules_ = false;
  std::size_t terms_ = 0;
  Section section_ = Section::none;
  Setting implication_, aggregation_, defuzzifier_;
  Count inputCount_, outputCount_, ruleCount_;
  std::vector<TermCount> mfCounts_;
  std::string reason_;            ///< of the next rule
  Variable* variable_ = nullptr;  ///< the last one; no list grows while its last element is read
  std::vector<std::pair<Rule, std::string_view>> rules_;
  System system_;
};

}  // namespace

Result<System> readMatlab(std::string_view text, const std::string& where) {
  return Reader(text, where).read();
}

}  // namespace trimtab::fuzzy_system
