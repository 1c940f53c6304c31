#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/host/column_map.h"
#include "trimtab/units/result.h"

namespace trimtab {

/// A recorded flight as rows whose times never fall. Readers report in their findings what they dropped,
/// filled in or found odd.
struct Flight {
  std::string name;
  std::vector<AircraftState> states;

  double beginS() const { return states.empty() ? 0 : states.front().time; }
  double durationS() const { return states.empty() ? 0 : states.back().time - states.front().time; }
};

/// Reads a flight: a table of text with named columns, a decision trace, or a .pcap capture of a host, told
/// apart by content. resources/docs/logs.md has the names, units and formats that are read. `columns` says
/// where quantities are, if the names do not. Without a time column, rows are `defaultStepS` seconds apart;
/// without an attitude, the track gives one. Rows before the simulator was ready (below -1,000 ft) are
/// dropped with a note; gaps and jumps are noted. If two readings of a file fit, it is refused.
Result<Flight> readFlight(const std::filesystem::path& file, double defaultStepS = 0.1,
                          const ColumnMap& columns = {});
Result<Flight> parseFlightCsv(std::string_view text, const std::string& where, double defaultStepS = 0.1,
                              const ColumnMap& columns = {});

/// Returns a flight as CSV, with a column for everything that the states hold. `height_m` stands beside
/// `altitude_ft` so that it reads back bit for bit: a fifth of all doubles in metres have no double in feet.
std::string flightCsv(const Flight& flight);

/// One UDP payload of a capture. Captures are classic pcap files in either byte order, with microseconds or
/// nanoseconds, of Ethernet, raw IP, Linux cooked or BSD loopback.
struct CapturedDatagram {
  double time = 0;
  std::string from, to;  ///< "address:port"
  std::vector<std::byte> bytes;
};
Result<std::vector<CapturedDatagram>> readPcap(const std::filesystem::path& file);
Result<std::vector<CapturedDatagram>> parsePcap(std::string_view bytes, const std::string& where);
/// Writes a classic little-endian pcap file with microseconds and raw IPv4, which any dissector reads.
Result<Done> writePcap(const std::filesystem::path& file, std::span<const CapturedDatagram> datagrams);

/// Return how such a file begins, and how datagrams follow: for those who write them as they come. `where`
/// names the file in findings.
std::string pcapHeader();
Result<std::string> pcapRecords(std::span<const CapturedDatagram> datagrams, const std::string& where);

/// Returns the flight of the busiest host among the datagrams, from 0 s on, timed by the host's time stamps
/// if they always rise, else by arrival. The findings report other senders, bad packets, loss, silences and
/// jumps.
Result<Flight> flightFromDatagrams(std::span<const CapturedDatagram> datagrams, const std::string& where);

/// Returns the state at `time`, interpolated: positions along the chord, angles the short way round.
AircraftState stateAt(const Flight& flight, double time);
/// Reports whether nothing is known between row `i` and the next: a silence in which the aircraft moved on,
/// or a jump.
bool breaksAfter(const Flight& flight, std::size_t i);

}  // namespace trimtab
