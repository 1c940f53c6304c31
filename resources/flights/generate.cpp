#include <cstdio>
#include <cstring>

#include "circuit.h"
#include "route.h"

/// Writes a flight to standard output: make_flight NAME > resources/flights/NAME.csv
int main(int argc, char** argv) {
  struct {
    const char* name;
    std::vector<trimtab::flights::CircuitRow> (*fly)();
  } const flights[] = {{"yecheon-circuit", trimtab::flights::circuit},
                       {"kansai-valley", trimtab::flights::kansaiValley},
                       {"everest-pass", trimtab::flights::everestPass}};
  for (const auto& flight : flights)
    if (argc == 2 && std::strcmp(argv[1], flight.name) == 0) {
      const std::string text = trimtab::flights::circuitCsv(flight.fly());
      return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() ? 0 : 1;
    }
  for (const auto& flight : flights) std::fprintf(stderr, "make_flight %s\n", flight.name);
  return 2;
}
