#include "recording.h"

#include "trimtab/preset/preset.h"

namespace trimtab::link {

Result<Recording> Recording::begin(const std::filesystem::path& target) {
  auto part = PartFile::open(target, pcapHeader());
  if (!part) return part.findings();
  return Recording(target, std::move(part).value());
}

Result<Done> Recording::add(const std::vector<CapturedDatagram>& datagrams) {
  const auto records = pcapRecords(datagrams, part_.path().string());
  if (!records) return records.findings();
  if (auto added = part_.append(*records); !added) return added;
  size_ += datagrams.size();
  return Done{};
}

Result<Done> Recording::finish() {
  if (target_.extension() == ".pcap") {
    auto done = part_.putInPlace();
    return done ? done : kept(done.findings());
  }
  const auto datagrams = readPcap(part_.path());
  if (!datagrams) return kept(datagrams.findings());
  const auto flight = flightFromDatagrams(*datagrams, "recording");
  if (!flight) return kept(flight.findings());
  const auto written = writeAtomically(target_, flightCsv(*flight));
  if (!written) return kept(written.findings());
  discard();
  Findings notes = written.findings();
  notes.insert(notes.end(), flight.findings().begin(), flight.findings().end());
  return {Done{}, std::move(notes)};
}

Findings Recording::kept(Findings why) const {
  why.push_back({Severity::note, part_.path().string(), "", "",
                 std::to_string(size_) + " datagrams are kept there: it plays as it is"});
  return why;
}

}  // namespace trimtab::link
