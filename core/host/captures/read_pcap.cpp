#include <algorithm>

#include "capture_records.h"
#include "ip_packets.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"

namespace trimtab {

Result<std::vector<CapturedDatagram>> parsePcap(std::string_view text, const std::string& where) {
  const auto records = capture::readRecords(std::as_bytes(std::span(text)), where);
  if (!records) return records.findings();
  capture::IpPackets packets;
  std::vector<CapturedDatagram> datagrams;
  std::size_t longest = 0, kept = 0;
  for (const capture::Record& record : *records) {
    const std::size_t cutBefore = packets.cut();
    if (auto datagram = packets.add(record)) datagrams.push_back(std::move(*datagram));
    if (packets.cut() == cutBefore) continue;
    longest = std::max(longest, record.length);
    kept = std::max(kept, record.frame.size());
  }
  Findings notes = records.findings();
  const auto note = [&](Severity severity, std::size_t count, const std::string& what) {
    if (count > 0) notes.push_back({severity, where, "", "", std::to_string(count) + what});
  };
  note(Severity::warning, packets.cut(),
       " frames were cut by the capture, the longest of " + std::to_string(longest) + " bytes to " +
           std::to_string(kept) + ", and are passed over; capture whole frames (tcpdump -s 0)");
  note(Severity::warning, packets.fragmentsLeft(),
       " fragments of IP whose other parts are missing, passed over");
  note(Severity::note, packets.others(), " frames that are no whole UDP datagram, passed over");
  return {std::move(datagrams), std::move(notes)};
}

Result<std::vector<CapturedDatagram>> readPcap(const std::filesystem::path& file) {
  return withinMemory(file, [&]() -> Result<std::vector<CapturedDatagram>> {
    const Result<std::string> bytes = readWhole(file, kLargestRecording);
    if (!bytes) return bytes.findings();
    return parsePcap(*bytes, file.string());
  });
}

}  // namespace trimtab
