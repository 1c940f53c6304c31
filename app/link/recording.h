#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "trimtab/host/flight.h"
#include "trimtab/preset/part_file.h"

namespace trimtab::link {

/// A recording while it is made: a capture beside the target, which has every datagram a few milliseconds
/// after it came. Whatever ends the program, `feed play` and the IG read it as it is.
class Recording {
 public:
  /// Refuses, before anything is received, a target that could not be written in the end, and one whose
  /// `.part` holds what a run that was cut off left, or something else.
  static Result<Recording> begin(const std::filesystem::path& target);

  /// Adds all of them or, if that fails, none.
  Result<Done> add(const std::vector<CapturedDatagram>& datagrams);
  /// Returns how many datagrams it has.
  std::uint64_t size() const { return size_; }

  /// Gives the recording its name; a flight is made from the capture unless the target ends in `.pcap`. If
  /// that fails, the capture is kept.
  Result<Done> finish();
  /// Removes the capture.
  void discard() { part_.discard(); }
  /// Adds to the findings where the datagrams so far are.
  Findings kept(Findings why) const;

 private:
  Recording(std::filesystem::path target, PartFile part)
      : target_(std::move(target)), part_(std::move(part)) {}

  std::filesystem::path target_;
  PartFile part_;
  std::uint64_t size_ = 0;
};

}  // namespace trimtab::link
