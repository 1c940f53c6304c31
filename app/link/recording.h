#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "trimtab/host/flight.h"

namespace trimtab::link {

/// A recording while it is made: a capture beside the target, which has every datagram a few milliseconds
/// after it came. Whatever ends the program, `feed play` and the IG read it as it is.
class Recording {
 public:
  /// Refuses, before anything is received, a target that could not be written in the end, and a capture of a
  /// run that was cut off.
  static Result<Recording> begin(const std::filesystem::path& target);

  Result<Done> add(const std::vector<CapturedDatagram>& datagrams) { return capture_.add(datagrams); }
  std::uint64_t size() const { return capture_.size(); }

  /// Gives the recording its name; a flight is made from the capture unless the target ends in `.pcap`. If
  /// that fails, the capture is kept.
  Result<Done> finish();
  /// Removes the capture.
  void discard();
  /// Adds to the findings where the datagrams so far are.
  Findings kept(Findings why) const;

 private:
  Recording(std::filesystem::path target, std::filesystem::path unfinished, PcapWriter capture)
      : target_(std::move(target)), unfinished_(std::move(unfinished)), capture_(std::move(capture)) {}

  std::filesystem::path target_, unfinished_;
  PcapWriter capture_;
};

}  // namespace trimtab::link
