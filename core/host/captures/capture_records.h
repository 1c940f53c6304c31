#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::capture {

enum LinkType : std::uint32_t {
  kNull = 0,
  kEthernet = 1,
  kRawBsd = 12,
  kRaw = 101,
  kLoop = 108,
  kCooked = 113,
  kIpv4 = 228,
  kIpv6 = 229,
  kCooked2 = 276
};

/// A frame as it was captured.
struct Record {
  double time = 0;  ///< seconds, UTC
  std::uint32_t linkType = 0;
  std::span<const std::byte> frame;
  std::size_t length = 0;  ///< of the frame on the line; more than `frame` has if the capture cut it
};

/// Reads the frames of a classic pcap file or of a pcapng file. They point into `bytes`. A file that was cut
/// is used up to there, and the findings say so; `where` names it in them.
Result<std::vector<Record>> readRecords(std::span<const std::byte> bytes, const std::string& where);

}  // namespace trimtab::capture
