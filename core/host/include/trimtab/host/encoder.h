#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/host_symbols.h"
#include "trimtab/host/byte_order.h"

/// Encodes what is sent: a host's packets for `feed play`, and an IG's Start of Frame for synchronous hosts.
/// The layouts are beside each writer, in encoder.cpp, native_fdm.cpp, cigi4.cpp and symbol_encoder.cpp.
namespace trimtab {

/// Returns a FlightGear native-fdm packet of version 24, 408 bytes.
std::vector<std::byte> encodeNativeFdm(const AircraftState& state);
/// Returns one CIGI 3.3 message: IG Control and Entity Control of the ownship; View Control if the state has
/// a head, View Definition if it has a view, Atmosphere Control if it has a visibility, Weather Control of
/// the rain and the snow layer if it has weather. The wind is in Atmosphere Control and in the layer that
/// falls, so a state with neither loses it.
std::vector<std::byte> encodeCigiHost(const AircraftState& state, std::uint32_t frame,
                                      std::uint32_t lastIgFrame, ByteOrder order = ByteOrder::big);
/// Returns the same as a CIGI 4.0 message, with Entity Position in place of Entity Control.
std::vector<std::byte> encodeCigi4Host(const AircraftState& state, std::uint32_t frame,
                                       std::uint32_t lastIgFrame, ByteOrder order = ByteOrder::big);
/// Returns the CIGI 3.3 packets that make these symbols: all surfaces, then all definitions, then a Symbol
/// Control each, so that a parent is defined before a child names it. They follow the message of
/// encodeCigiHost. Points and circles beyond what a packet holds (29 and 9), and text beyond 235 bytes, are
/// left out.
std::vector<std::byte> encodeCigiSymbols(const HostSymbols& symbols, ByteOrder order = ByteOrder::big);
/// Returns a small set of symbols as a host might send it, for demonstrations and tests: a radar scope whose
/// sweep turns with the time, two contacts, a waypoint and a flashing weapon cue.
HostSymbols exampleSymbols(double timeS);
/// Returns a CIGI 3.3 Start of Frame, 24 bytes.
std::vector<std::byte> encodeCigiStartOfFrame(std::uint32_t igFrame, std::uint32_t lastHostFrame,
                                              double timeS, ByteOrder order = ByteOrder::big);
/// Returns a CIGI 4.0 Start of Frame, 24 bytes.
std::vector<std::byte> encodeCigi4StartOfFrame(std::uint32_t igFrame, std::uint32_t lastHostFrame,
                                               double timeS, ByteOrder order = ByteOrder::big);

}  // namespace trimtab
