#include <cmath>
#include <cstdlib>
#include <vector>

#include "trimtab/host/decoder.h"

/// A sequence of datagrams to one decoder, each with its length in two bytes and two of time in front:
/// whatever came before, the counters add up and a state is numbers in range.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trimtab;
  HostDecoder decoder;
  Extrapolator extrapolator;
  double now = 1;
  std::uint64_t sent = 0, states = 0;
  for (std::size_t at = 0; at + 4 <= size; ++sent) {
    const std::size_t length = std::min<std::size_t>(data[at] | data[at + 1] << 8, size - at - 4);
    now += (data[at + 2] | data[at + 3] << 8) * 1e-4;
    const std::vector<std::uint8_t> exact(data + at + 4, data + at + 4 + length);
    at += 4 + length;
    const auto state =
        decoder.accept({std::as_bytes(std::span(exact)), now, data[at - 1] % 8 == 0 ? "b" : "a"});
    if (!state) continue;
    ++states;
    if (!(std::abs(state->position.latitude.value()) <= 90) || !std::isfinite(state->position.height.value()))
      std::abort();
    extrapolator.push(*state);
    const AircraftState eye = extrapolator.at(state->time + 0.01, 0.5);
    if (!(std::abs(eye.position.latitude.value()) <= 90) || !std::isfinite(eye.position.height.value()))
      std::abort();
  }
  std::vector<HostStatistics> senders = decoder.otherSenders();
  senders.push_back(decoder.statistics());
  std::uint64_t received = 0, decoded = 0;
  for (const HostStatistics& s : senders) {
    received += s.received;
    decoded += s.states;
    if (s.states + s.bad + s.notForUs + s.notReady + s.repeated + s.reordered > s.received ||
        s.implausible > s.received)
      std::abort();
    // No number of frames that nobody can have sent.
    if (s.lost.value_or(0) > 36000 * s.received) std::abort();
  }
  if (decoder.received() != sent || received != sent || decoded != states) std::abort();
  return 0;
}
