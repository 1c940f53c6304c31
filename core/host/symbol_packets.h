#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "packet_fault.h"
#include "trimtab/frame/host_symbols.h"

/// The symbol packets of CIGI 3.3 (ICD 4.1.29 to 4.1.35), read and applied to a store of symbols.
namespace trimtab::cigi3 {

enum SymbolPacketId : std::uint8_t {
  kSurfaceDefinition = 29,
  kTextDefinition = 30,
  kCircleDefinition = 31,
  kLineDefinition = 32,
  kSymbolClone = 33,
  kSymbolControl = 34,
  kShortSymbolControl = 35
};
/// Sizes in bytes; definitions of circles, lines and text are followed by their arcs, points and characters.
inline constexpr std::size_t kSurfaceDefinitionSize = 56, kTextHeaderSize = 12, kShapeHeaderSize = 16,
                             kArcSize = 24, kPointSize = 8, kSymbolCloneSize = 8, kSymbolControlSize = 40,
                             kShortSymbolControlSize = 16;
/// Numbers of surfaces and symbols beyond this are refused: no host means them, and their products stay
/// finite.
inline constexpr double kFurthestUnit = 1e6;

constexpr bool isSymbolPacket(std::uint8_t id) {
  return id >= kSurfaceDefinition && id <= kShortSymbolControl;
}

/// Applies the symbol packets of one message. The store is copied when the first of them changes something;
/// what is held elsewhere never changes.
class SymbolEdit {
 public:
  /// `symbols` may be null.
  explicit SymbolEdit(std::shared_ptr<const HostSymbols> symbols) : now_(std::move(symbols)) {}

  /// Applies the packet at `at`, whose size byte the caller has checked against the datagram. Returns a fault
  /// if the packet is refused; it has then changed nothing.
  std::optional<PacketFault> apply(std::span<const std::byte> datagram, std::size_t at, ByteOrder order);
  /// Returns the store after all packets so far; the one from the beginning if none has changed anything.
  const std::shared_ptr<const HostSymbols>& symbols() const { return now_; }

 private:
  struct Packet;
  HostSymbols& edit();
  void put(const HostSymbol& symbol);
  void destroy(std::uint16_t id);
  void destroySurface(std::uint16_t id);
  void define(Packet& packet, HostShape shape);
  void readSurface(Packet& packet);
  void readText(Packet& packet);
  void readCircles(Packet& packet);
  void readLines(Packet& packet);
  void readClone(Packet& packet);
  void readControl(Packet& packet);
  void readShortControl(Packet& packet);
  void control(Packet& packet, HostSymbol symbol);
  bool closesCycle(std::uint16_t id, std::uint16_t parent) const;

  std::shared_ptr<const HostSymbols> now_;
  std::shared_ptr<HostSymbols> edited_;  ///< the same as `now_` once something has changed
};

}  // namespace trimtab::cigi3
