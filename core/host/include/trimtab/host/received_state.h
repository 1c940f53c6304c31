#pragma once

#include "trimtab/frame/frame.h"

namespace trimtab {

/// A decoded packet with the times that latencies are measured from.
struct ReceivedState {
  AircraftState state;
  double kernelTime = 0;   ///< when the kernel received the datagram, seconds of CLOCK_REALTIME
  double decodedTime = 0;  ///< when the state was decoded, on the same clock
};

}  // namespace trimtab
