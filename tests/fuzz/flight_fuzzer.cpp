#include <cstdlib>

#include "trimtab/host/flight.h"

/// Text or capture: refused with findings, or a flight whose times do not fall and that reads back as it is.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  auto flight = parseFlightCsv(text, "fuzz");
  if (const auto datagrams = parsePcap(text, "fuzz")) flight = flightFromDatagrams(*datagrams, "fuzz");
  if (!flight) {
    if (flight.findings().empty()) std::abort();
    return 0;
  }
  for (std::size_t i = 1; i < flight->states.size(); ++i)
    if (flight->states[i].time < flight->states[i - 1].time) std::abort();
  stateAt(*flight, flight->beginS() + flight->durationS() / 3);
  const auto again = parseFlightCsv(flightCsv(*flight), "again");
  if (!again || again->states != flight->states) std::abort();
  return 0;
}
