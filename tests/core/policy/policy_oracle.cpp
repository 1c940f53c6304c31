#include "policy_oracle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/core/policy/random_policy.h"
#include "tests/support.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/policy/policy_file.h"
#include "trimtab/units/number.h"

namespace trimtab::test {
namespace {

constexpr double kAgreement = 1e-9;

/// Writes out.fld; its inputs and a header are in it if `whole`. Returns the file's system.
fuzzy_system::System evaluate(const ScratchDir& dir, const std::string& text, RuleFormat format,
                              const std::vector<SignalValues>& rows, bool whole, std::string& error) {
  const std::string ending = format == RuleFormat::matlab ? "fis" : "fll";
  writeFile(dir / ("engine." + ending), text);
  const auto system = fuzzy_system::readSystem(text, "engine", format);
  if (!system) {
    error = toString(system.findings());
    return {};
  }
  std::string data;
  for (const SignalValues& row : rows) {
    for (const auto& input : system->inputs) data += numberText(row[*signalNamed(input.name)]) + " ";
    data += "\n";
  }
  writeFile(dir / "in.fld", data);
  const char* const with = whole ? "true" : "false";
  const Ran ran = run("cd " + dir.path().string() + " && fuzzylite -i engine." + ending + " -if " + ending +
                      " -o out.fld -of fld -d in.fld -decimals 12 -dinputs " + with + " -dheader " + with);
  if (ran.exitCode != 0) error = ran.err + ran.out;
  return *system;
}

/// fuzzylite takes firings up to 1e-6 for 0. Returns what its weighted average of our firings then is; our
/// own value differs from it by no more than those firings can make.
double withoutTinyFirings(const Policy& policy, const PolicyDecision& ours, Lever lever) {
  double sum = 0, weight = 0, tiny = 0;
  for (std::size_t r = 0; r < policy.rules.size(); ++r)
    for (const LeverSetting& s : policy.rules[r].settings)
      if (s.lever == lever) {
        const double w = ours.firing[r];
        (w > 1e-6 ? weight : tiny) += w;
        if (w > 1e-6) sum += w * s.value;
      }
  const Range range = rowOf(lever).hard;
  if (weight > 0) {
    const double rounding = 1e-12 + 1e-15 * range.high;
    EXPECT_NEAR(ours.target[lever], sum / weight, (range.high - range.low) * tiny / weight + rounding);
  }
  return sum / weight;
}

/// fuzzylite takes numbers within 1e-6 for equal, which moves what lies so near beside the corner of a shape.
/// Such a signal is put on the corner.
void moveOntoCorners(const Policy& policy, SignalValues& row) {
  for (const PolicyTerm& term : policy.terms)
    for (std::size_t i = 0; i < term.numbers.size(); i += term.shape == TermShape::points ? 2 : 1)
      if (std::abs(row[term.signal] - term.numbers[i]) < 2e-6) row[term.signal] = term.numbers[i];
}

}  // namespace

std::vector<LeverValues> byFuzzylite(const std::string& text, const std::vector<SignalValues>& rows,
                                     std::string& error, RuleFormat format) {
  const ScratchDir dir;
  const fuzzy_system::System system = evaluate(dir, text, format, rows, false, error);
  std::istringstream out(readFile(dir / "out.fld"));
  std::vector<LeverValues> values;
  std::string line;
  while (std::getline(out, line)) {
    std::istringstream cells(line);
    LeverValues row;
    std::string cell;
    for (const auto& output : system.outputs) {
      cells >> cell;
      row[*leverNamed(output.name)] = std::strtod(cell.c_str(), nullptr);
    }
    values.push_back(row);
  }
  if (values.size() != rows.size() && error.empty()) error = "the oracle stopped early";
  return values;
}

double differenceFromFuzzylite(const Policy& policy, RuleFormat format, std::mt19937_64& random, int points,
                               std::vector<SignalValues> rows) {
  const auto compiled = compile(policy, "test");
  EXPECT_TRUE(compiled) << toString(compiled.findings());
  const auto text = policyFileText(policy, "test policy", format);
  EXPECT_TRUE(text) << toString(text.findings());
  if (!compiled || !text) return HUGE_VAL;
  for (int i = 0; i < points; ++i) rows.push_back(randomSignals(random, policy));
  for (SignalValues& row : rows) moveOntoCorners(policy, row);
  std::string error;
  const auto theirs = byFuzzylite(*text, rows, error, format);
  EXPECT_EQ(error, "") << *text;
  double worst = 0;
  PolicyDecision ours;
  for (std::size_t i = 0; i < theirs.size(); ++i) {
    compiled->decide(rows[i], ours);
    for (const LeverRow& row : kLeverRows) {
      if (!compiled->moves(row.lever)) continue;
      const double a = withoutTinyFirings(policy, ours, row.lever), b = theirs[i][row.lever];
      if (std::isnan(a) && std::isnan(b)) continue;
      const double difference = std::isnan(a) || std::isnan(b) ? HUGE_VAL : std::abs(a - b);
      worst = std::max(worst, difference);
      // A double of the size of the farthest object has no digit of 1e-9 that both sums round alike.
      EXPECT_LE(difference, std::max(kAgreement, 1e-14 * row.hard.high))
          << row.key << ": " << a << " against " << b << "\n"
          << *text;
      if (!(difference <= kAgreement)) return worst;
    }
  }
  return worst;
}

std::optional<double> fuzzyliteNanoseconds(const std::string& fll, const std::vector<SignalValues>& rows,
                                           int runs) {
  const ScratchDir dir;
  std::string error;
  evaluate(dir, fll, RuleFormat::fuzzylite, rows, true, error);
  return error.empty() ? benchmarkNanoseconds(dir.path(), rows.size(), runs) : std::nullopt;
}

}  // namespace trimtab::test
