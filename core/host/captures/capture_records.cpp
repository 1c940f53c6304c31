#include "capture_records.h"

#include <cmath>
#include <optional>

#include "trimtab/host/byte_order.h"

namespace trimtab::capture {
namespace {

constexpr std::size_t kFileHeader = 24, kRecordHeader = 16;
constexpr std::uint32_t kLongestRecord = 262144;

using Bytes = std::span<const std::byte>;

bool isKnown(std::uint32_t type) {
  for (const std::uint32_t known : {kNull, kEthernet, kRawBsd, kRaw, kLoop, kCooked, kIpv4, kIpv6, kCooked2})
    if (type == known) return true;
  return false;
}

std::string atByte(const std::string& where, std::size_t at) {
  return where + ":byte " + std::to_string(at);
}
Finding unknownLink(const std::string& place, std::uint32_t type) {
  return {Severity::error, place, "link type",
          "Ethernet (1), raw IP (101), Linux cooked (113, 276) or BSD loopback (0)", std::to_string(type)};
}
Finding tooLong(const std::string& place, std::uint32_t length) {
  return {Severity::error, place, "record length", "at most 262144 bytes", std::to_string(length)};
}
Finding cutFile(const std::string& place, const char* what, std::size_t expected, std::size_t left) {
  return {Severity::warning, place, what, std::to_string(expected) + " bytes",
          std::to_string(left) + ": the file was cut; what precedes is used"};
}

struct Classic {
  ByteOrder order;
  double fraction;  ///< seconds
};

Result<std::vector<Record>> readClassic(Bytes bytes, const std::string& where, Classic form) {
  const std::uint32_t linkType = wire::get<std::uint32_t>(bytes, 20, form.order) & 0xffffU;
  if (!isKnown(linkType)) return unknownLink(atByte(where, 20), linkType);
  std::vector<Record> records;
  Findings notes;
  for (std::size_t at = kFileHeader; at < bytes.size();) {
    const std::size_t left = bytes.size() - at;
    const auto number = [&](std::size_t offset) {
      return wire::get<std::uint32_t>(bytes, at + offset, form.order);
    };
    const std::uint32_t length = left >= kRecordHeader ? number(8) : 0;
    if (length > kLongestRecord) return tooLong(atByte(where, at), length);
    if (left < kRecordHeader + length) {
      notes.push_back(cutFile(atByte(where, at), "last record", kRecordHeader + length, left));
      break;
    }
    records.push_back({number(0) + number(4) * form.fraction, linkType,
                       bytes.subspan(at + kRecordHeader, length), number(12)});
    at += kRecordHeader + length;
  }
  return {std::move(records), std::move(notes)};
}

/// The blocks of pcapng (draft-ietf-opsawg-pcapng). A section has a byte order and interfaces of its own.
class NewFormat {
 public:
  NewFormat(Bytes bytes, const std::string& where) : bytes_(bytes), where_(where) {}

  Result<std::vector<Record>> read() {
    std::size_t at = 0;
    while (at < bytes_.size() && !error_) {
      const std::size_t left = bytes_.size() - at;
      if (left < kSmallest) {
        notes_.push_back(cutFile(atByte(where_, at), "last block", kSmallest, left));
        break;
      }
      const bool section = wire::get<std::uint32_t>(bytes_, at, ByteOrder::big) == kSection;
      if (section && !beginSection(at)) break;
      const auto type = number(at), length = number(at + 4);
      if (length < kSmallest || length % 4 != 0 || length > kLongestRecord * 4) {
        error_ = Finding{Severity::error, atByte(where_, at), "block length", "a multiple of 4, at least 12",
                         std::to_string(length)};
      } else if (length > left) {
        notes_.push_back(cutFile(atByte(where_, at), "last block", length, left));
        break;
      } else if (!section) {
        readBlock(type, at, length);
      }
      at += length;
    }
    if (!error_ && records_.empty() && unknownType_) error_ = unknownLink(where_, *unknownType_);
    if (error_) return *error_;
    const auto note = [this](std::size_t count, const char* what) {
      if (count > 0) notes_.push_back({Severity::note, where_, "", "", std::to_string(count) + what});
    };
    note(untimed_, " packets without a time (Simple Packet Blocks), passed over");
    note(ofUnknownLink_, " packets of interfaces with another link type, passed over");
    return {std::move(records_), std::move(notes_)};
  }

 private:
  static constexpr std::uint32_t kSection = 0x0a0d0d0a, kInterface = 1, kOldPacket = 2, kSimplePacket = 3,
                                 kPacket = 6;
  static constexpr std::size_t kSmallest = 12;
  struct Interface {
    std::uint32_t linkType = 0;
    double tickS = 1e-6, offsetS = 0;
  };

  std::uint32_t number(std::size_t at) const { return wire::get<std::uint32_t>(bytes_, at, order_); }
  std::uint16_t half(std::size_t at) const { return wire::get<std::uint16_t>(bytes_, at, order_); }

  bool beginSection(std::size_t at) {
    constexpr std::uint32_t kMagic = 0x1a2b3c4d;
    interfaces_.clear();
    for (const ByteOrder order : {ByteOrder::big, ByteOrder::little})
      if (wire::get<std::uint32_t>(bytes_, at + 8, order) == kMagic) {
        order_ = order;
        return true;
      }
    error_ = Finding{Severity::error, atByte(where_, at + 8), "byte-order magic of pcapng",
                     "1a2b3c4d in either order", "something else"};
    return false;
  }

  void readBlock(std::uint32_t type, std::size_t at, std::size_t length) {
    constexpr std::size_t kPacketHeader = 28, kTail = 4, kInterfaceHeader = 16;
    if (type == kInterface && length >= kInterfaceHeader + kTail) return addInterface(at, length);
    if (type == kSimplePacket) ++untimed_;
    if ((type != kPacket && type != kOldPacket) || length < kPacketHeader + kTail) return;
    const std::size_t index = type == kPacket ? number(at + 8) : half(at + 8);
    const std::uint32_t captured = number(at + 20);
    if (captured > length - kPacketHeader - kTail) {
      error_ = tooLong(atByte(where_, at), captured);
      return;
    }
    if (index >= interfaces_.size() || !isKnown(interfaces_[index].linkType)) {
      ++ofUnknownLink_;
      return;
    }
    const Interface& from = interfaces_[index];
    const double ticks = number(at + 12) * 4294967296.0 + number(at + 16);
    records_.push_back({from.offsetS + ticks * from.tickS, from.linkType,
                        bytes_.subspan(at + kPacketHeader, captured), number(at + 24)});
  }

  void addInterface(std::size_t at, std::size_t length) {
    constexpr std::uint16_t kResolution = 9, kOffset = 14;
    Interface added{.linkType = half(at + 8)};
    if (!isKnown(added.linkType)) unknownType_ = added.linkType;
    const std::size_t end = at + length - 4;
    for (std::size_t option = at + 16; option + 4 <= end && half(option) != 0;) {
      const std::size_t size = half(option + 2), value = option + 4;
      if (value + size > end) break;
      if (half(option) == kResolution && size == 1) {
        const auto power = std::to_integer<int>(bytes_[value]);
        added.tickS = (power & 0x80) != 0 ? std::exp2(-(power & 0x7f)) : std::pow(10.0, -power);
      }
      if (half(option) == kOffset && size == 8)
        added.offsetS = static_cast<double>(wire::get<std::int64_t>(bytes_, value, order_));
      option = value + (size + 3) / 4 * 4;
    }
    interfaces_.push_back(added);
  }

  Bytes bytes_;
  const std::string& where_;
  ByteOrder order_ = ByteOrder::big;
  std::vector<Interface> interfaces_;
  std::vector<Record> records_;
  Findings notes_;
  std::optional<Finding> error_;
  std::optional<std::uint32_t> unknownType_;
  std::size_t untimed_ = 0, ofUnknownLink_ = 0;
};

}  // namespace

Result<std::vector<Record>> readRecords(Bytes bytes, const std::string& where) {
  constexpr std::uint32_t kMicro = 0xa1b2c3d4, kMicroSwapped = 0xd4c3b2a1, kNano = 0xa1b23c4d,
                          kNanoSwapped = 0x4d3cb2a1, kNewFormat = 0x0a0d0d0a;
  if (bytes.size() < kFileHeader)
    return Finding{Severity::error, where, "", "a pcap file header of 24 bytes",
                   std::to_string(bytes.size()) + " bytes"};
  switch (wire::get<std::uint32_t>(bytes, 0, ByteOrder::big)) {
    case kNewFormat:
      return NewFormat(bytes, where).read();
    case kMicro:
      return readClassic(bytes, where, {ByteOrder::big, 1e-6});
    case kMicroSwapped:
      return readClassic(bytes, where, {ByteOrder::little, 1e-6});
    case kNano:
      return readClassic(bytes, where, {ByteOrder::big, 1e-9});
    case kNanoSwapped:
      return readClassic(bytes, where, {ByteOrder::little, 1e-9});
    default:
      return Finding{Severity::error, where + ":byte 0", "magic",
                     "a1b2c3d4 or a1b23c4d in either order, or 0a0d0d0a (pcapng)", "something else"};
  }
}

}  // namespace trimtab::capture
