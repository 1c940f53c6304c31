#include "recording.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"

namespace trimtab::link {
namespace {

namespace fs = std::filesystem;

Finding wrong(const fs::path& where, std::string expected, std::string found) {
  return {Severity::error, where.string(), "", std::move(expected), std::move(found)};
}

}  // namespace

Result<Recording> Recording::begin(const fs::path& target) {
  const fs::path unfinished = fs::path(target) += ".part";
  std::error_code failed;
  if (const fs::path folder = fs::absolute(target).parent_path(); !fs::is_directory(folder, failed))
    return wrong(target, "a folder that exists", folder.string());
  const fs::file_status there = fs::status(target, failed);
  if (fs::exists(there) && !fs::is_regular_file(there))
    return wrong(target, "a file's name", "a folder or a device");
  if (fs::exists(there) && ::access(target.c_str(), W_OK) != 0)
    return wrong(target, "room and permission to write it", std::generic_category().message(errno));
  // With a header and nothing behind it, it is worth nothing.
  constexpr std::uintmax_t kHeader = 24;
  if (fs::exists(unfinished, failed) && fs::file_size(unfinished, failed) > kHeader)
    return wrong(unfinished, "no recording that was cut off",
                 "one that plays as it is: give it another name, or remove it");
  auto capture = PcapWriter::open(unfinished);
  if (!capture) return capture.findings();
  return Recording(target, unfinished, std::move(capture).value());
}

Result<Done> Recording::finish() {
  if (auto closed = capture_.close(); !closed) return kept(closed.findings());
  if (target_.extension() == ".pcap") {
    auto done = putInPlace(unfinished_, target_);
    return done ? done : kept(done.findings());
  }
  const auto datagrams = readPcap(unfinished_);
  if (!datagrams) return kept(datagrams.findings());
  const auto flight = flightFromDatagrams(*datagrams, "recording");
  if (!flight) return kept(flight.findings());
  if (const auto written = writeAtomically(target_, flightCsv(*flight)); !written)
    return kept(written.findings());
  discard();
  return {Done{}, flight.findings()};
}

void Recording::discard() {
  std::error_code ignored;
  fs::remove(unfinished_, ignored);
}

Findings Recording::kept(Findings why) const {
  why.push_back({Severity::note, unfinished_.string(), "", "",
                 std::to_string(size()) + " datagrams are kept there: it plays as it is"});
  return why;
}

}  // namespace trimtab::link
