#include "trimtab/host/flight.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "cigi3.h"
#include "cigi4.h"
#include "flight_notes.h"
#include "trimtab/host/decoder.h"
#include "trimtab/host/motion.h"
#include "trimtab/host/protocol_names.h"
#include "trimtab/preset/file_io.h"

namespace trimtab {
namespace {

/// Reports whether a step is much longer than the steps around it: a recording in steps of ten seconds has no
/// silences.
bool isSilent(const std::vector<AircraftState>& states, std::size_t i) {
  constexpr double kTimesLonger = 5;
  const double step = states[i + 1].time - states[i].time;
  if (step <= kSilenceS) return false;
  double around = 0;
  if (i > 0) around = states[i].time - states[i - 1].time;
  if (i + 2 < states.size()) around = std::max(around, states[i + 2].time - states[i + 1].time);
  return around > 0 && step > kTimesLonger * around;
}

std::string fixed(double value, int decimals, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f %s", decimals, value, unit);
  return text;
}

using Stream = std::vector<const CapturedDatagram*>;

struct Decoded {
  std::vector<AircraftState> states;
  std::vector<double> arrivals;
  HostStatistics statistics;
};

Decoded decode(const Stream& stream) {
  Decoded decoded;
  HostDecoder decoder;
  for (const CapturedDatagram* d : stream) {
    if (const auto state = decoder.accept({d->bytes, d->time, d->from})) {
      decoded.states.push_back(*state);
      decoded.arrivals.push_back(d->time);
    }
  }
  decoded.statistics = decoder.statistics();
  return decoded;
}

bool isStartOfFrame(const CapturedDatagram& d) {
  const bool of3 =
      d.bytes.size() >= cigi3::kStartOfFrameSize && d.bytes[0] == std::byte{cigi3::kStartOfFrame};
  return of3 || cigi4::byteOrder(d.bytes, cigi4::kStartOfFrame);
}

/// Says why a sender's datagrams hold no state; empty if that is unknown.
std::string whyNone(const HostStatistics& s) {
  if (!s.firstBadReason.empty()) return "the first bad one: " + s.firstBadReason;
  const std::optional<Finding>& newest = s.newestNotForUs ? s.newestNotForUs : s.newestUnused;
  return newest ? "the newest: " + toString(*newest) : std::string();
}

void appendLinkNotes(const HostStatistics& s, const std::string& where, Findings& findings) {
  const auto count = [&](std::uint64_t n, const std::string& what, Severity severity = Severity::note) {
    if (n > 0) findings.push_back({severity, where, "", "", std::to_string(n) + ' ' + what});
  };
  count(s.bad, "bad datagrams, passed over; the first: " + s.firstBadReason, Severity::warning);
  count(s.notForUs, "datagrams for someone else, passed over; the newest: " +
                        toString(s.newestNotForUs.value_or(Finding{})));
  count(s.truncated, "messages with a broken tail; the first bad datagram: " + s.firstBadReason,
        Severity::warning);
  count(s.refusedPackets, "packets left out of their messages; the first: " + s.firstRefusedReason,
        Severity::warning);
  count(s.uncounted, "messages used although their frame number stands still");
  for (const IgnoredPackets& each : s.ignored)
    count(each.count, "packets not read: " + cigiPacketName(each.id));
  count(s.notReady, "datagrams below -1000 ft: the simulator was not ready; dropped");
  count(s.lost.value_or(0), "frames lost, by their numbers");
  count(s.repeated, "repeated frames, passed over");
  count(s.reordered, "late frames, passed over");
  count(s.implausible, "frames with an implausible number, passed over");
  count(s.restarts, "restarts of the host's frame count");
}

}  // namespace

void appendMotionNotes(const Flight& flight, const std::string& where, Findings& findings) {
  constexpr std::size_t kMost = 10;
  const auto& states = flight.states;
  std::size_t silences = 0, jumps = 0;
  for (std::size_t i = 0; i + 1 < states.size(); ++i) {
    const double step = states[i + 1].time - states[i].time;
    const std::string at = "row " + std::to_string(i + 1) + ", " + fixed(states[i].time, 3, "s");
    if (isSilent(states, i) && ++silences <= kMost)
      findings.push_back({Severity::note, where, at, "", "silence of " + fixed(step, 1, "s")});
    if (breaksAfter(flight, i) && ++jumps <= kMost)
      findings.push_back({Severity::note, where, at, "",
                          "jump of " +
                              fixed(distanceM(states[i].position, states[i + 1].position) / 1000, 1, "km") +
                              " within " + fixed(step, 2, "s")});
  }
  if (silences > kMost || jumps > kMost)
    findings.push_back(
        {Severity::note, where, "", "",
         std::to_string(silences) + " silences and " + std::to_string(jumps) + " jumps in all"});
}

bool breaksAfter(const Flight& flight, std::size_t i) {
  const auto& states = flight.states;
  if (i + 1 >= states.size()) return false;
  return isJump(states[i].position, states[i + 1].position, states[i + 1].time - states[i].time,
                isSilent(states, i));
}

Result<Flight> flightFromDatagrams(std::span<const CapturedDatagram> datagrams, const std::string& where) {
  std::map<std::string, Stream> streams;
  std::size_t startOfFrames = 0;
  for (const CapturedDatagram& d : datagrams) {
    if (isStartOfFrame(d))
      ++startOfFrames;
    else
      streams[d.from + " > " + d.to].push_back(&d);
  }
  const std::string* busiest = nullptr;
  Decoded decoded;
  for (const auto& [name, stream] : streams) {
    Decoded candidate = decode(stream);
    if (busiest && candidate.states.size() <= decoded.states.size()) continue;
    busiest = &name;
    decoded = std::move(candidate);
  }
  Findings findings;
  if (!busiest || decoded.states.empty()) {
    const std::string reason = whyNone(decoded.statistics);
    findings.push_back({Severity::error, where, "",
                        "datagrams of a host (CIGI, native-fdm, DIS or X-Plane) with an own aircraft",
                        std::to_string(datagrams.size()) + " datagrams, none of them" +
                            (reason.empty() ? "" : "; " + reason)});
    return findings;
  }
  if (startOfFrames > 0)
    findings.push_back(
        {Severity::note, where, "", "",
         std::to_string(startOfFrames) + " Start of Frame messages of an image generator, passed over"});
  for (const auto& [name, stream] : streams)
    if (&name != busiest)
      findings.push_back({Severity::note, where, name, "",
                          std::to_string(stream.size()) + " datagrams of another sender, passed over"});
  appendLinkNotes(decoded.statistics, where, findings);

  Flight flight;
  flight.states = std::move(decoded.states);
  auto& states = flight.states;
  const auto falls = [](const AircraftState& a, const AircraftState& b) { return !(a.time < b.time); };
  if (std::adjacent_find(states.begin(), states.end(), falls) != states.end()) {
    for (std::size_t i = 0; i < states.size(); ++i)
      states[i].time = i > 0 ? std::max(decoded.arrivals[i], states[i - 1].time) : decoded.arrivals[i];
    if (isCigi(decoded.statistics.protocol))
      findings.push_back({Severity::note, where, "", "",
                          "the host's timestamps do not rise throughout; arrival times are used"});
  }
  const double begin = states.front().time;
  for (AircraftState& state : states) state.time -= begin;
  const auto clamped = std::count_if(states.begin(), states.end(), [](const AircraftState& state) {
    return state.clamp != GroundClamp::none;
  });
  if (clamped > 0)
    findings.push_back({Severity::note, where, "", "",
                        std::to_string(clamped) +
                            " states stand on the ground: their heights count from the terrain that they are "
                            "flown over; a table of them does not say so"});
  appendMotionNotes(flight, where, findings);
  return {std::move(flight), std::move(findings)};
}

namespace {

/// Says with what a packed file is unpacked; null if it is none.
const char* unpacker(std::string_view bytes) {
  if (bytes.starts_with("\x1f\x8b")) return "gunzip";
  if (bytes.starts_with("\x28\xb5\x2f\xfd")) return "unzstd";
  return bytes.starts_with(
             "\xfd"
             "7zXZ")
             ? "unxz"
             : nullptr;
}

Result<Flight> readAnyFlight(const std::filesystem::path& file, double defaultStepS,
                             const ColumnMap& columns) {
  const std::string where = file.string();
  const Result<std::string> read = readWhole(file, kLargestRecording);
  if (!read) return read.findings();
  const std::string& bytes = *read;
  if (const char* tool = unpacker(bytes))
    return Finding{Severity::error, where, "", "a table, a trace or a capture as it is",
                   std::string("a packed file; unpack it first: ") + tool + ' ' + file.filename().string()};
  const auto begins = [&bytes](std::string_view magic) {
    return std::string_view(bytes).substr(0, 4) == magic;
  };
  const bool capture = begins("\xa1\xb2\xc3\xd4") || begins("\xd4\xc3\xb2\xa1") ||
                       begins("\xa1\xb2\x3c\x4d") || begins("\x4d\x3c\xb2\xa1") || begins("\x0a\x0d\x0d\x0a");
  const auto parse = [&]() -> Result<Flight> {
    if (!capture) return parseFlightCsv(bytes, where, defaultStepS, columns);
    const auto datagrams = parsePcap(bytes, where);
    if (!datagrams) return datagrams.findings();
    auto flight = flightFromDatagrams(*datagrams, where);
    Findings findings = datagrams.findings();
    findings.insert(findings.end(), flight.findings().begin(), flight.findings().end());
    if (!flight) return findings;
    return {std::move(*flight), std::move(findings)};
  };
  auto flight = parse();
  if (flight) (*flight).name = file.filename().string();
  return flight;
}

}  // namespace

Result<Flight> readFlight(const std::filesystem::path& file, double defaultStepS, const ColumnMap& columns) {
  return withinMemory(file, [&] { return readAnyFlight(file, defaultStepS, columns); });
}

AircraftState stateAt(const Flight& flight, double time) {
  const auto& states = flight.states;
  if (states.empty()) return {};
  const auto after = std::upper_bound(states.begin(), states.end(), time,
                                      [](double t, const AircraftState& state) { return t < state.time; });
  if (after == states.begin()) return states.front();
  if (after == states.end()) return states.back();
  const auto i = static_cast<std::size_t>(after - states.begin()) - 1;
  const AircraftState &a = states[i], &b = states[i + 1];
  const double fraction = (time - a.time) / (b.time - a.time);
  AircraftState state = a;
  state.time = time;
  if (!(fraction > 0) || breaksAfter(flight, i)) return state;
  state.position = blended(a.position, b.position, fraction);
  state.attitude = blended(a.attitude, b.attitude, fraction);
  if (a.head && b.head) state.head = blendedHead(*a.head, *b.head, fraction);
  if (a.aboveGround && b.aboveGround)
    state.aboveGround = *a.aboveGround + (*b.aboveGround - *a.aboveGround) * fraction;
  return state;
}

}  // namespace trimtab
