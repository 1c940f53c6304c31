#include <cmath>
#include <cstdlib>
#include <vector>

#include "trimtab/host/decoder.h"
#include "trimtab/host/encoder.h"

namespace {

/// Ground of 100 m that is known everywhere, with a hole in the north.
class Plain : public trimtab::GroundHeights {
 public:
  std::optional<trimtab::Metres> heightAt(trimtab::Degrees latitude, trimtab::Degrees) const override {
    return latitude < trimtab::Degrees{80} ? std::optional(trimtab::Metres{100}) : std::nullopt;
  }
  std::optional<trimtab::Metres> highest() const override { return trimtab::Metres{100}; }
  trimtab::Metres postDistance() const override { return trimtab::Metres{10000}; }
};

/// Whatever is asked, the answer is one packet of the right size with numbers in it.
void checkAnswers(trimtab::HostDecoder& decoder) {
  using namespace trimtab;
  std::vector<TerrainQuery> queries;
  decoder.takeQueries(queries);
  const Plain plain;
  for (const TerrainQuery& query : queries)
    for (const GroundHeights* ground :
         {static_cast<const GroundHeights*>(&plain), static_cast<const GroundHeights*>(nullptr)}) {
      const auto answer = answerOf(query, ground);
      if (answer.size() < 16 || answer.size() != std::to_integer<std::size_t>(answer[1])) std::abort();
      const auto number = wire::get<double>(answer, 8, query.order);
      if (!std::isfinite(number)) std::abort();
      const bool valid = (std::to_integer<unsigned>(answer[4]) & 1U) != 0;
      if (valid && (ground == nullptr || !query.from)) std::abort();
    }
}

}  // namespace

/// A datagram is good, bad or for someone else, never two of them; a state it yields is finite, in range, and
/// survives being sent again, and so do its symbols. What it asks about the terrain has an answer.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  HostDecoder decoder, again;
  const auto state = decoder.accept({std::as_bytes(std::span(data, size)), 1, "fuzz"});
  const HostStatistics& s = decoder.statistics();
  checkAnswers(decoder);
  if ((s.refusedPackets > 0) != s.newestRefused.has_value()) std::abort();
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
  if (!sent || sent->position != p || sent->clamp != state->clamp) std::abort();
  if (!symbols) return 0;
  // A surface that one datagram defines and destroys leaves an empty store, for which nothing is sent.
  const auto back = again.symbols();
  if (again.statistics().refusedPackets > 0 || (back ? *back : HostSymbols{}) != *symbols) std::abort();
  return 0;
}
