#include "mapped_system.h"

#include <algorithm>
#include <cmath>

#include "fuzzy_names.h"
#include "fuzzy_shapes.h"
#include "system_text.h"
#include "trimtab/policy/levers.h"
#include "trimtab/policy/signals.h"
#include "words.h"

namespace trimtab::fuzzy_system {
namespace {

template <class Row>
std::string keyList(const Row& rows) {
  std::string keys;
  for (const auto& row : rows)
    keys += (keys.empty() ? "" : ", ") + std::string(row.key) +
            (row.unit.empty() ? "" : " (" + std::string(row.unit) + ")");
  return keys;
}

bool isKey(std::string_view key, bool input) {
  return input ? signalNamed(key).has_value() : leverOfOutput(key).has_value();
}

/// Stands for a key that the mapping gives and that does not exist, so that nothing else is said of it.
constexpr std::string_view kRefused = "?";

class KeyFinder {
 public:
  KeyFinder(std::span<const RuleVariable> mapping, const std::string& where)
      : lines_({}, where), mapping_(mapping), used_(mapping.size(), false) {}

  std::vector<RuleVariable> find(const std::vector<Variable>& variables, bool input) {
    std::vector<RuleVariable> keys;
    std::string missing, place;
    for (const Variable& variable : variables) {
      keys.push_back(keyOf(variable, input));
      const std::string& key = keys.back().key;
      if (!key.empty() && key != kRefused &&
          std::any_of(keys.begin(), keys.end() - 1, [&](const auto& each) { return each.key == key; }))
        lines_.refuseAt(variable.where, input ? "input" : "output", "each key for one variable", key);
      if (!key.empty()) continue;
      if (missing.empty()) place = variable.where;
      if (missing.size() < 80) missing += (missing.empty() ? "" : ", ") + variable.name.substr(0, 40);
    }
    const std::string kind = input ? "signal" : "lever", first = missing.substr(0, missing.find(','));
    if (!missing.empty())
      lines_.refuseAt(place, input ? "input" : "output",
                      "the key of a " + kind + ", or --map \"" + first + "=KEY*SCALE+OFFSET\" with one of " +
                          (input ? keyList(kSignalRows) : keyList(kLeverRows)),
                      missing);
    return keys;
  }

  Result<SystemKeys> finish(SystemKeys keys, const System& system) {
    for (std::size_t i = 0; i < mapping_.size(); ++i)
      if (!used_[i])
        lines_.refuseAt("--map", mapping_[i].variable,
                        "a variable of the file: " + namesOf(system.inputs) + ", " + namesOf(system.outputs),
                        "none of this name");
    if (!lines_.empty()) return lines_.findings();
    return {std::move(keys), lines_.findings()};
  }

 private:
  RuleVariable keyOf(const Variable& variable, bool input) {
    for (std::size_t i = 0; i < mapping_.size(); ++i) {
      const RuleVariable& each = mapping_[i];
      if (each.variable != variable.name && wordOf(each.variable) != variable.name) continue;
      used_[i] = true;
      if (isKey(each.key, input)) return each;
      lines_.refuseAt("--map", each.variable, input ? keyList(kSignalRows) : keyList(kLeverRows), each.key);
      return {variable.name, std::string(kRefused), 1, 0};
    }
    const std::string lower = keyInName(variable.name, input);
    if (!lower.empty() && lower != variable.name)
      lines_.noteAt(variable.where, "name", "'" + variable.name + "', read as " + lower);
    return {variable.name, lower, 1, 0};
  }

  Lines lines_;
  std::span<const RuleVariable> mapping_;
  std::vector<bool> used_;
};

/// Converts the numbers of a membership over x = s * scale + offset into one over s.
void convert(Term& term, const RuleVariable& key) {
  const auto place = [&key](double& x) { x = (x - key.offset) / key.scale; };
  std::vector<double>& n = term.numbers;
  switch (*policyShapeOf(term)) {
    case TermShape::points: {
      moveStepsTogether(n);
      for (std::size_t i = 0; i + 1 < n.size(); i += 2) place(n[i]);
      if (key.scale > 0) break;
      std::reverse(n.begin(), n.end());
      for (std::size_t i = 0; i + 1 < n.size(); i += 2) std::swap(n[i], n[i + 1]);
      break;
    }
    case TermShape::triangle:
    case TermShape::trapezoid:
      std::for_each(n.begin(), n.end(), place);
      if (key.scale < 0) std::reverse(n.begin(), n.end());
      break;
    case TermShape::ramp:
      std::for_each(n.begin(), n.end(), place);
      break;
    case TermShape::gaussian:
    case TermShape::bell:
      if (n.size() < 2) break;  // refused later
      place(n[0]);
      n[1] /= std::abs(key.scale);
      break;
    case TermShape::sigmoid:
      if (n.size() < 2) break;
      place(n[0]);
      n[1] *= key.scale;
      break;
  }
}

/// Renames the inputs in a condition: the words before "is".
std::string renamed(const std::string& condition, const std::vector<RuleVariable>& inputs) {
  std::vector<std::string_view> words = policyWords(condition);
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (words[i + 1] != "is") continue;
    for (const RuleVariable& each : inputs)
      if (each.variable == words[i]) {
        words[i] = each.key;
        break;
      }
  }
  return joinedWords(words.begin(), words.end());
}

}  // namespace

std::string keyInName(std::string_view name, bool input) {
  std::string lower = lowered(name.substr(0, 40));
  return isKey(lower, input) ? lower : std::string();
}

std::optional<Lever> leverOfOutput(std::string_view name) {
  return name == kFormerOutput ? Lever::occlusion : leverNamed(name);
}

Result<SystemKeys> keysOf(const System& system, std::span<const RuleVariable> mapping,
                          const std::string& where) {
  KeyFinder finder(mapping, where);
  SystemKeys keys{finder.find(system.inputs, true), finder.find(system.outputs, false)};
  for (std::size_t i = 0; i < keys.inputs.size(); ++i) keys.inputs[i].variable = system.inputs[i].name;
  return finder.finish(std::move(keys), system);
}

System mappedBy(const SystemKeys& keys, System system) {
  const bool rename = std::any_of(keys.inputs.begin(), keys.inputs.end(),
                                  [](const RuleVariable& each) { return each.key != each.variable; });
  for (auto* const variables : {&system.inputs, &system.outputs}) {
    const bool input = variables == &system.inputs;
    for (std::size_t i = 0; i < variables->size(); ++i) {
      const RuleVariable& key = (input ? keys.inputs : keys.outputs)[i];
      Variable& variable = (*variables)[i];
      variable.name = key.key;
      if (key.scale == 1 && key.offset == 0) continue;
      const auto place = [&key](double& x) { x = (x - key.offset) / key.scale; };
      place(variable.range.low);
      place(variable.range.high);
      if (key.scale < 0) std::swap(variable.range.low, variable.range.high);
      if (!input) place(variable.unfired);
      for (Term& term : variable.terms) {
        if (input && policyShapeOf(term)) convert(term, key);
        if (!input) std::for_each(term.numbers.begin(), term.numbers.end(), place);
      }
    }
  }
  if (rename)
    for (Rule& rule : system.rules) rule.condition = renamed(rule.condition, keys.inputs);
  return system;
}

}  // namespace trimtab::fuzzy_system
