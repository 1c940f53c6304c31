#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/host/byte_order.h"

/// What we send: a host's packets for `feed play`, an IG's Start of Frame for synchronous hosts. Layouts are
/// in the .cpp beside each writer.
namespace trimtab {

/// FlightGear native-fdm version 24, 408 bytes.
std::vector<std::byte> encodeNativeFdm(const AircraftState& state);
/// One CIGI 3.3 message: IG Control, Entity Control of the ownship, View Control where there is a head,
/// View Definition where there is a view, Atmosphere Control where there is a visibility, Weather Control of
/// the rain and the snow layer where there is a weather.
std::vector<std::byte> encodeCigiHost(const AircraftState& state, std::uint32_t frame,
                                      std::uint32_t lastIgFrame, ByteOrder order = ByteOrder::big);
/// CIGI 3.3 Start of Frame, 24 bytes.
std::vector<std::byte> encodeCigiStartOfFrame(std::uint32_t igFrame, std::uint32_t lastHostFrame,
                                              double timeS, ByteOrder order = ByteOrder::big);

}  // namespace trimtab
