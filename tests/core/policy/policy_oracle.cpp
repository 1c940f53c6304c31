#include "policy_oracle.h"

#include <cstdlib>
#include <sstream>

#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/support.h"
#include "trimtab/units/number.h"

namespace trimtab::test {
namespace {

/// The keys of a file's inputs or outputs, in its order.
std::vector<std::string> blocks(const std::string& fll, const std::string& block) {
  std::vector<std::string> keys;
  for (std::size_t at = 0; (at = fll.find(block + ": ", at)) != std::string::npos;) {
    at += block.size() + 2;
    keys.push_back(fll.substr(at, fll.find('\n', at) - at));
  }
  return keys;
}

/// Writes out.fld; its inputs and a header are in it if `whole`.
void evaluate(const ScratchDir& dir, const std::string& fll, const std::vector<SignalValues>& rows,
              bool whole, std::string& error) {
  writeFile(dir / "engine.fll", fll);
  const auto inputs = blocks(fll, "InputVariable");
  std::string data;
  for (const SignalValues& row : rows) {
    for (const std::string& key : inputs) data += numberText(row[*signalNamed(key)]) + " ";
    data += "\n";
  }
  writeFile(dir / "in.fld", data);
  const char* const with = whole ? "true" : "false";
  const Ran ran =
      run("cd " + dir.path().string() +
          " && fuzzylite -i engine.fll -if fll -o out.fld -of fld -d in.fld -decimals 12 -dinputs " + with +
          " -dheader " + with);
  if (ran.exitCode != 0) error = ran.err + ran.out;
}

}  // namespace

std::vector<LeverValues> byFuzzylite(const std::string& fll, const std::vector<SignalValues>& rows,
                                     std::string& error) {
  const ScratchDir dir;
  evaluate(dir, fll, rows, false, error);
  const auto outputs = blocks(fll, "OutputVariable");
  std::istringstream out(readFile(dir / "out.fld"));
  std::vector<LeverValues> values;
  std::string line;
  while (std::getline(out, line)) {
    std::istringstream cells(line);
    LeverValues row;
    std::string cell;
    for (const std::string& key : outputs) {
      cells >> cell;
      row[*leverNamed(key)] = std::strtod(cell.c_str(), nullptr);
    }
    values.push_back(row);
  }
  if (values.size() != rows.size() && error.empty()) error = "the oracle stopped early";
  return values;
}

std::optional<double> fuzzyliteNanoseconds(const std::string& fll, const std::vector<SignalValues>& rows,
                                           int runs) {
  const ScratchDir dir;
  std::string error;
  evaluate(dir, fll, rows, true, error);
  return error.empty() ? benchmarkNanoseconds(dir.path(), rows.size(), runs) : std::nullopt;
}

}  // namespace trimtab::test
