#include <cmath>
#include <cstdlib>

#include "trimtab/host/decoder.h"
#include "trimtab/host/encoder.h"

/// A datagram is good, bad or for someone else, never two of them; a state it yields is finite, in range, and
/// survives being sent again, and so do its symbols.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  HostDecoder decoder, again;
  const auto state = decoder.accept({std::as_bytes(std::span(data, size)), 1, "fuzz"});
  const HostStatistics& s = decoder.statistics();
  if (s.received != 1 || s.states + s.bad + s.notForUs + s.notReady > 1 || s.states != (state ? 1U : 0U))
    std::abort();
  if (s.newestBad.has_value() != (s.bad == 1) || s.newestNotForUs.has_value() != (s.notForUs == 1))
    std::abort();
  if (s.bad == 1 && (s.firstBadReason.empty() || (size > 0 && s.firstBadHex.empty()))) std::abort();
  if (!state) return 0;
  const GeodeticPosition& p = state->position;
  if (!(std::abs(p.latitude.value()) <= 90 && std::abs(p.longitude.value()) <= 180)) std::abort();
  if (!std::isfinite(p.height.value()) || !(std::abs(state->attitude.pitch.value()) <= 90)) std::abort();
  auto message = encodeCigiHost(*state, 1, 0);
  const auto symbols = decoder.symbols();
  if (symbols) {
    const auto packets = encodeCigiSymbols(*symbols);
    message.insert(message.end(), packets.begin(), packets.end());
  }
  const auto sent = again.accept({message, 1, "fuzz"});
  if (!sent || sent->position != p) std::abort();
  if (!symbols) return 0;
  // A surface that one datagram defines and destroys leaves an empty store, for which nothing is sent.
  const auto back = again.symbols();
  if (again.statistics().refusedSymbols > 0 || (back ? *back : HostSymbols{}) != *symbols) std::abort();
  return 0;
}
