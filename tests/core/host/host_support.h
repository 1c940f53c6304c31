#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "trimtab/host/decoder.h"
#include "trimtab/host/encoder.h"

namespace trimtab::test {

inline AircraftState aState() {
  AircraftState s;
  s.time = 12.5;
  s.position = {Degrees{36.6278}, Degrees{128.3555}, Metres{1981.2}};
  s.attitude = {Degrees{280.25}, Degrees{-4.5}, Degrees{12.75}};
  return s;
}

inline AircraftState aFullState() {
  AircraftState s = aState();
  s.head = Attitude{Degrees{-30.5}, Degrees{-12.25}, Degrees{2.5}};
  s.visibility = Metres{7500};
  s.weather = HostWeather{Precipitation::snow, 3, Metres{1800}};
  s.view = HostView{Metres{2.5}, Degrees{-40}, Degrees{45}, Degrees{-25}, Degrees{30}};
  return s;
}

/// Feeds one datagram with its arrival.
inline std::optional<AircraftState> feed(HostDecoder& decoder, const std::vector<std::byte>& bytes,
                                         double arrival, const std::string& from = "127.0.0.1:8004") {
  return decoder.accept({bytes, arrival, from});
}

/// Reports whether any of the findings says `text`.
inline bool mentions(const Findings& findings, const std::string& text) {
  return toString(findings).find(text) != std::string::npos;
}

}  // namespace trimtab::test
