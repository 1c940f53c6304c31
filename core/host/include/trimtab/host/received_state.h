#pragma once

#include "trimtab/frame/frame.h"

namespace trimtab {

/// A decoded packet with the times that latencies are measured from.
struct ReceivedState {
  AircraftState state;
  double kernelTime = 0;   ///< seconds, CLOCK_REALTIME, when the kernel had the datagram
  double decodedTime = 0;  ///< same clock, when the state was ready
};

}  // namespace trimtab
