#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <vector>

#include "capture_records.h"
#include "trimtab/host/flight.h"

namespace trimtab::capture {

/// Makes UDP datagrams of captured frames: takes tags and headers away, and puts the fragments of IP
/// together.
class IpPackets {
 public:
  /// Returns the datagram that a frame holds, or that it completes.
  std::optional<CapturedDatagram> add(const Record& record);
  /// How many frames were no UDP; were cut by the capture; and are fragments whose others did not come.
  std::size_t others() const { return others_; }
  std::size_t cut() const { return cut_; }
  std::size_t fragmentsLeft() const;

 private:
  /// What IP says of a packet's payload.
  struct Packet {
    std::string from, to;
    std::uint32_t id = 0;
    std::size_t offset = 0;
    bool more = false, isUdp = false;
    std::span<const std::byte> payload{};
    bool isFragment() const { return more || offset > 0; }
  };
  struct Gathered {
    std::vector<std::byte> bytes;
    std::map<std::size_t, std::size_t> pieces;  ///< where each begins, and its length
    std::optional<std::size_t> length;          ///< known once the last piece has come
    std::size_t frames = 0;
    bool isComplete() const;
  };
  static std::optional<Packet> ipv4(std::span<const std::byte> ip);
  static std::optional<Packet> ipv6(std::span<const std::byte> ip);
  std::optional<std::vector<std::byte>> gather(const Packet& packet);

  using Key = std::tuple<std::string, std::string, std::uint32_t>;
  std::map<Key, Gathered> gathered_;
  std::size_t others_ = 0, cut_ = 0, dropped_ = 0;
};

}  // namespace trimtab::capture
