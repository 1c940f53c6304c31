#pragma once

#include <memory>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/host_symbols.h"

namespace trimtab {

/// A decoded packet with the times that latencies are measured from.
struct ReceivedState {
  AircraftState state;
  double kernelTime = 0;   ///< when the kernel received the datagram, seconds of CLOCK_REALTIME
  double decodedTime = 0;  ///< when the state was decoded, on the same clock
  std::shared_ptr<const HostSymbols> symbols{};  ///< of the host, as of this packet; null if it sent none
};

}  // namespace trimtab
