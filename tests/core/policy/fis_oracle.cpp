#include "fis_oracle.h"

#include <cstdlib>
#include <sstream>

#include "tests/support.h"
#include "trimtab/units/number.h"

namespace trimtab::test {

std::vector<std::vector<double>> fisByFuzzylite(const std::string& fis,
                                                const std::vector<std::vector<double>>& rows,
                                                std::string& error) {
  const ScratchDir dir;
  std::string data;
  for (const auto& row : rows) {
    for (const double value : row) data += numberText(value) + " ";
    data += "\n";
  }
  writeFile(dir / "engine.fis", fis);
  writeFile(dir / "in.fld", data);
  const Ran ran =
      run("cd " + dir.path().string() +
          " && fuzzylite -i engine.fis -if fis -o out.fld -of fld -d in.fld -decimals 12 -dinputs false"
          " -dheader false");
  if (ran.exitCode != 0) error = ran.err + ran.out;
  std::istringstream out(readFile(dir / "out.fld"));
  std::vector<std::vector<double>> values;
  std::string line, cell;
  while (std::getline(out, line)) {
    std::istringstream cells(line);
    values.emplace_back();
    while (cells >> cell) values.back().push_back(std::strtod(cell.c_str(), nullptr));
  }
  if (values.size() != rows.size() && error.empty()) error = "fuzzylite stopped early";
  return values;
}

}  // namespace trimtab::test
