#include "fis_makers.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "trimtab/units/number.h"

namespace trimtab::test {
namespace {

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

std::string listed(const std::vector<double>& numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : " ") + numberText(number, 5);
  return "[" + text + "]";
}

/// The term of so many even ones over 0..range, which overlap with their neighbours.
std::string evenTerm(std::size_t index, std::size_t count, double range, std::size_t shape) {
  const double step = range / static_cast<double>(count - 1), middle = step * static_cast<double>(index);
  switch (shape) {
    case 0:
      return "'trimf'," + listed({middle - step, middle, middle + step});
    case 1:
      return "'trapmf'," +
             listed({middle - 0.8 * step, middle - 0.2 * step, middle + 0.2 * step, middle + 0.8 * step});
    case 2:
      return "'gaussmf'," + listed({0.42 * step, middle});
    case 3:
      return "'gbellmf'," + listed({0.5 * step, 2.5, middle});
    case 4:
      return "'gauss2mf'," + listed({0.3 * step, middle - 0.1 * step, 0.3 * step, middle + 0.1 * step});
    default:
      return "'pimf'," +
             listed({middle - 0.9 * step, middle - 0.1 * step, middle + 0.1 * step, middle + 0.9 * step});
  }
}

std::string variableText(const std::string& section, const std::string& name, double range,
                         const std::vector<std::string>& terms) {
  std::string text = "\n[" + section + "]\nName='" + name + "'\nRange=[0 " + numberText(range) +
                     "]\nNumMFs=" + std::to_string(terms.size()) + "\n";
  for (std::size_t i = 0; i < terms.size(); ++i)
    text += "MF" + std::to_string(i + 1) + "='level " + std::to_string(i + 1) + "':" + terms[i] + "\n";
  return text;
}

/// The terms of the output, and which of them each rule takes by its height 0..1.
struct Outputs {
  std::vector<std::string> terms;
  std::vector<std::size_t> ofRule;
};

Outputs outputsOf(FisKind kind, const std::vector<double>& heights, std::size_t inputs,
                  std::mt19937_64& random) {
  Outputs made;
  const std::size_t levels = 3 + 2 * (random() % 2), shape = random() % 3;
  for (std::size_t i = 0; kind != FisKind::planes && i < levels; ++i)
    made.terms.push_back(
        kind == FisKind::mamdani
            ? evenTerm(i, levels, 100, shape)
            : "'constant',[" + numberText(100.0 * static_cast<double>(i) / static_cast<double>(levels - 1)) +
                  "]");
  for (const double height : heights) {
    if (kind != FisKind::planes) {
      made.ofRule.push_back(static_cast<std::size_t>(std::lround(height * static_cast<double>(levels - 1))));
      continue;
    }
    std::vector<double> plane;
    for (std::size_t i = 0; i < inputs; ++i)
      plane.push_back(uniform(random, -6, 6) / (10 * static_cast<double>(i + 1)));
    plane.push_back(20 + 60 * height);
    made.ofRule.push_back(made.terms.size());
    made.terms.push_back("'linear'," + listed(plane));
  }
  return made;
}

}  // namespace

std::string randomFis(FisKind kind, std::size_t inputs, std::mt19937_64& random) {
  const std::size_t perInput = inputs == 2 ? 3 + random() % 3 : 3, shape = random() % 6;
  std::vector<double> slopes;
  for (std::size_t i = 0; i < inputs; ++i)
    slopes.push_back(uniform(random, 0.4, 1) * (random() % 3 == 0 ? -1 : 1));
  std::vector<std::string> conditions;
  std::vector<double> heights;
  std::size_t rules = 1;
  for (std::size_t i = 0; i < inputs; ++i) rules *= perInput;
  for (std::size_t r = 0; r < rules; ++r) {
    std::string condition;
    double height = 0, most = 0;
    for (std::size_t i = 0, rest = r; i < inputs; ++i, rest /= perInput) {
      const double part = static_cast<double>(rest % perInput) / static_cast<double>(perInput - 1);
      condition += (condition.empty() ? "" : " ") + std::to_string(rest % perInput + 1);
      height += std::abs(slopes[i]) * (slopes[i] > 0 ? part : 1 - part);
      most += std::abs(slopes[i]);
    }
    conditions.push_back(condition);
    heights.push_back(std::clamp(height / most + uniform(random, -0.05, 0.05), 0.0, 1.0));
  }
  const Outputs outputs = outputsOf(kind, heights, inputs, random);
  const bool mamdani = kind == FisKind::mamdani;
  std::string text = "[System]\nName='made'\nType='" + std::string(mamdani ? "mamdani" : "sugeno") +
                     "'\nVersion=2.0\nNumInputs=" + std::to_string(inputs) +
                     "\nNumOutputs=1\nNumRules=" + std::to_string(rules) + "\nAndMethod='" +
                     (mamdani ? "min" : "prod") + "'\nOrMethod='" + (random() % 2 ? "max" : "probor") +
                     "'\nImpMethod='" + (mamdani ? "min" : "prod") + "'\nAggMethod='" +
                     (mamdani ? "max" : "sum") + "'\nDefuzzMethod='" + (mamdani ? "centroid" : "wtaver") +
                     "'\n";
  for (std::size_t i = 0; i < inputs; ++i) {
    std::vector<std::string> terms;
    const double range = 10 * static_cast<double>(i + 1);
    for (std::size_t t = 0; t < perInput; ++t) terms.push_back(evenTerm(t, perInput, range, shape));
    text +=
        variableText("Input" + std::to_string(i + 1), "In" + std::to_string(i + 1) + " (x)", range, terms);
  }
  text += variableText("Output1", "Out", 100, outputs.terms) + "\n[Rules]\n";
  for (std::size_t r = 0; r < rules; ++r)
    text += conditions[r] + ", " + std::to_string(outputs.ofRule[r] + 1) + " (1) : 1\n";
  return text;
}

}  // namespace trimtab::test
