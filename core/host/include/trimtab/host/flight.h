#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/units/result.h"

namespace trimtab {

/// A flight by rows: what `--flight` reads. Times do not fall; the findings tell what was dropped, filled in
/// or found odd.
struct Flight {
  std::string name;
  std::vector<AircraftState> states;

  double beginS() const { return states.empty() ? 0 : states.front().time; }
  double durationS() const { return states.empty() ? 0 : states.back().time - states.front().time; }
};

/// A CSV with named columns (design.md; FlightGear's hyphenated names too; without a time column rows are 0.1
/// s apart unless `defaultStepS` says otherwise), a decision trace of ours, or a .pcap of a host: told apart
/// by content. Rows before the simulator was ready (below -1,000 ft) are dropped with a note; gaps and jumps
/// are noted.
Result<Flight> readFlight(const std::filesystem::path& file, double defaultStepS = 0.1);
Result<Flight> parseFlightCsv(std::string_view text, const std::string& where, double defaultStepS = 0.1);

/// The CSV form: header of design.md and what else the states hold. `height_m` beside `altitude_ft` makes it
/// read back bit for bit: a fifth of all doubles in metres have no double in feet.
std::string flightCsv(const Flight& flight);

/// UDP payloads of a capture in file order (classic pcap, either byte order, micro- or nanoseconds; Ethernet,
/// raw IP, Linux cooked, BSD loopback).
struct CapturedDatagram {
  double time = 0;
  std::string from, to;  ///< "address:port"
  std::vector<std::byte> bytes;
};
Result<std::vector<CapturedDatagram>> readPcap(const std::filesystem::path& file);
Result<std::vector<CapturedDatagram>> parsePcap(std::string_view bytes, const std::string& where);
/// Classic little-endian microsecond pcap, raw IPv4, so that any dissector reads it.
Result<Done> writePcap(const std::filesystem::path& file, std::span<const CapturedDatagram> datagrams);

/// The flight of the busiest host among the datagrams, from 0 s on: by the host's timestamps where they rise
/// throughout, else by arrival. The findings tell of other senders, bad packets, loss, silences and jumps.
Result<Flight> flightFromDatagrams(std::span<const CapturedDatagram> datagrams, const std::string& where);

/// Where along a flight: state interpolated at `time` (positions along the chord, angles the short way
/// round).
AircraftState stateAt(const Flight& flight, double time);
/// Whether nothing is known between row `i` and the next: a silence in which it moved on, or a jump.
bool breaksAfter(const Flight& flight, std::size_t i);

}  // namespace trimtab
