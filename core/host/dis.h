#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "packet_fault.h"
#include "trimtab/frame/frame.h"

/// DIS (IEEE 1278.1): protocol data units (PDU) in big-endian order. An Entity State PDU says where an entity
/// is and how it moves on, at most some five times a second.
namespace trimtab::dis {

inline constexpr std::size_t kHeaderSize = 12, kEntityStateSize = 144, kParameterSize = 16;
inline constexpr std::uint8_t kEntityStateType = 1;
/// A time stamp counts an hour in 2^31 steps. It stands in the upper 31 bits, so that the whole number counts
/// it in 2^32.
inline constexpr double kTickS = 3600.0 / 4294967296.0;

struct EntityId {
  std::uint16_t site = 0, application = 0, entity = 0;
  friend bool operator==(const EntityId&, const EntityId&) = default;
};

struct Entity {
  EntityId id;
  std::string marking;  ///< up to 11 characters
  bool isPlatform = false;
  bool isGone = false;  ///< it has been taken out of the exercise
  std::uint32_t ticks = 0;
  AircraftState state;  ///< all but time and packet
};

/// "17:2:5 VIPER1"
std::string toString(const Entity& entity);

/// Reports whether this is a PDU of protocol version 4 to 7, of any type, or several in a row, and nothing
/// else.
bool matches(std::span<const std::byte> bytes);
/// Reads the Entity State PDU that begins at `at`, whose length the caller has checked against the datagram.
std::optional<PacketFault> parse(std::span<const std::byte> datagram, std::size_t at, Entity& entity);

/// Chooses the own aircraft among the entities of one sender.
class OwnEntity {
 public:
  /// `wanted` is an id as "17:2:5", its last number alone, a marking in any case, or empty for the first
  /// platform that comes.
  explicit OwnEntity(std::string wanted = {}) : wanted_(std::move(wanted)) {}
  bool isOwn(const Entity& entity);
  /// Forgets which one was first.
  void restart() { first_.reset(); }
  /// "17:2:5 VIPER1, 17:2:6 VIPER2": those that came and are not the own aircraft.
  std::string others() const;
  const std::string& wanted() const { return wanted_; }

 private:
  std::string wanted_;
  std::optional<EntityId> first_;
  std::vector<Entity> others_;
};

}  // namespace trimtab::dis
