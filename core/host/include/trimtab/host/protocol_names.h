#pragma once

#include <array>
#include <string_view>

#include "trimtab/host/decoder.h"

namespace trimtab {

/// How command lines and people call the protocols of hosts. `sent` says whether encoders for it exist.
struct ProtocolName {
  WireProtocol wire;
  HostProtocol wanted;
  const char *option, *label;
  bool sent;
};
inline constexpr std::array kProtocols{
    ProtocolName{WireProtocol::native_fdm, HostProtocol::native_fdm, "native-fdm", "FlightGear native-fdm 24",
                 true},
    ProtocolName{WireProtocol::cigi3, HostProtocol::cigi3, "cigi3", "CIGI 3", true},
    ProtocolName{WireProtocol::cigi4, HostProtocol::cigi4, "cigi4", "CIGI 4", true},
    ProtocolName{WireProtocol::dis, HostProtocol::dis, "dis", "DIS", false},
    ProtocolName{WireProtocol::x_plane, HostProtocol::x_plane, "x-plane", "X-Plane", false}};

/// Returns the row of a protocol; null for WireProtocol::none and HostProtocol::automatic.
constexpr const ProtocolName* nameOf(WireProtocol wire) {
  for (const ProtocolName& name : kProtocols)
    if (name.wire == wire) return &name;
  return nullptr;
}
constexpr const ProtocolName* nameOf(HostProtocol wanted) {
  for (const ProtocolName& name : kProtocols)
    if (name.wanted == wanted) return &name;
  return nullptr;
}
constexpr const ProtocolName* nameOf(std::string_view option) {
  for (const ProtocolName& name : kProtocols)
    if (name.option == option) return &name;
  return nullptr;
}
/// Reports whether a protocol has messages with frame numbers and symbols.
constexpr bool isCigi(WireProtocol wire) {
  return wire == WireProtocol::cigi3 || wire == WireProtocol::cigi4;
}

}  // namespace trimtab
