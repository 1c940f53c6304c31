#include <cstdio>

#include "circuit.h"

/// Writes the sample flight to standard output: make_flight > resources/flights/yecheon-circuit.csv
int main() {
  const std::string text = trimtab::flights::circuitCsv(trimtab::flights::circuit());
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() ? 0 : 1;
}
