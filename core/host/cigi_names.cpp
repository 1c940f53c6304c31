#include <array>
#include <string_view>

#include "trimtab/host/decoder.h"

namespace trimtab {
namespace {

/// Packets of a host, by their number (CIGI 3.3, ICD table 4).
constexpr std::array<std::string_view, 36> kHostPackets{"",
                                                        "IG Control",
                                                        "Entity Control",
                                                        "Conformal Clamped Entity Control",
                                                        "Component Control",
                                                        "Short Component Control",
                                                        "Articulated Part Control",
                                                        "Short Articulated Part Control",
                                                        "Rate Control",
                                                        "Celestial Sphere Control",
                                                        "Atmosphere Control",
                                                        "Environmental Region Control",
                                                        "Weather Control",
                                                        "Maritime Surface Conditions Control",
                                                        "Wave Control",
                                                        "Terrestrial Surface Conditions Control",
                                                        "View Control",
                                                        "Sensor Control",
                                                        "Motion Tracker Control",
                                                        "Earth Reference Model Definition",
                                                        "Trajectory Definition",
                                                        "View Definition",
                                                        "Collision Detection Segment Definition",
                                                        "Collision Detection Volume Definition",
                                                        "HAT/HOT Request",
                                                        "Line of Sight Segment Request",
                                                        "Line of Sight Vector Request",
                                                        "Position Request",
                                                        "Environmental Conditions Request",
                                                        "Symbol Surface Definition",
                                                        "Symbol Text Definition",
                                                        "Symbol Circle Definition",
                                                        "Symbol Line Definition",
                                                        "Symbol Clone",
                                                        "Symbol Control",
                                                        "Short Symbol Control"};
constexpr unsigned kFirstUserDefined = 201;

}  // namespace

std::string cigiPacketName(std::uint8_t id) {
  const std::string number = " (" + std::to_string(id) + ')';
  if (id > 0 && id < kHostPackets.size()) return std::string(kHostPackets[id]) + number;
  return (id >= kFirstUserDefined ? "user-defined" : "unknown") + number;
}

}  // namespace trimtab
