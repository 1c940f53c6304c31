#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "packet_fault.h"
#include "trimtab/frame/frame.h"
#include "trimtab/frame/host_symbols.h"
#include "trimtab/host/decoder.h"
#include "trimtab/host/terrain_query.h"

/// CIGI 3.x as an image generator reads it: messages of packets `u8 id, u8 size, ...` in the sender's byte
/// order.
namespace trimtab::cigi3 {

enum PacketId : std::uint8_t {
  kIgControl = 1,
  kEntityControl = 2,
  kClampedEntityControl = 3,
  kAtmosphereControl = 10,
  kWeatherControl = 12,
  kViewControl = 16,
  kViewDefinition = 21,
  kHeightRequest = 24,
  kSegmentRequest = 25,
  kVectorRequest = 26,
  kStartOfFrame = 101
};
inline constexpr std::size_t kIgControlSize = 24, kOldIgControlSize = 16, kEntityControlSize = 48,
                             kClampedEntityControlSize = 24, kAtmosphereControlSize = 32,
                             kWeatherControlSize = 56, kViewControlSize = 32, kViewDefinitionSize = 32,
                             kStartOfFrameSize = 24, kHeightRequestSize = 32, kSegmentRequestSize = 64,
                             kVectorRequestSize = 56;
inline constexpr std::uint16_t kByteSwapMagic = 0x8000;
/// A timestamp counts ticks of 10 microseconds (dissectors label them microseconds) and wraps after 11.9
/// hours.
inline constexpr double kTickS = 1e-5;
inline constexpr std::uint16_t kOwnship = 0;
/// Layers of Weather Control that are precipitation; the others are fog, clouds, sleet, hail, sand and dust.
inline constexpr std::uint8_t kRainLayer = 4, kSnowLayer = 5;

/// Lists of what a host has beside what is followed hold at most so many, for people to choose from.
inline constexpr std::size_t kMostNamed = 16;

/// Which of a host's entities is the own aircraft, and which of its views is drawn.
struct Follow {
  std::uint16_t entity = kOwnship;
  std::optional<std::uint16_t> view;  ///< if unset, the first one
};

/// A layer of precipitation of global scope, as last heard.
struct Layer {
  bool enabled = false;
  int severity = 0;
  std::optional<Metres> visibility;
  std::optional<Wind> wind;  ///< unset if calm
};

/// Holds what the packets of a session add up to: a packet that is not sent again keeps its effect.
struct Session {
  std::optional<GeodeticPosition>
      position;  ///< of the own aircraft; its height counts from what `clamp` says
  Attitude attitude;
  GroundClamp clamp = GroundClamp::none;
  std::optional<Attitude> head;
  std::optional<std::uint16_t>
      headView;  ///< the view whose eyepoint is followed: the first one, if none is chosen
  std::optional<Metres> visibility;
  std::optional<Wind> atmosphereWind;
  std::optional<Layer> rain, snow;
  std::optional<HostView> view;
  std::optional<std::uint16_t> definedView;
  std::shared_ptr<const HostSymbols> symbols;  ///< null before the first is defined

  /// Returns what falls: the more severe of two enabled layers, or the snow if they are equal. It is unset
  /// until the host has sent either.
  std::optional<HostWeather> weather() const;
  /// Returns the wind in the layer that falls, unless it is calm there, else that of the atmosphere.
  std::optional<Wind> wind() const;
};

struct Message {
  ByteOrder order = ByteOrder::big;
  std::uint32_t frame = 0;
  std::optional<std::uint32_t> ticks;  ///< timestamp, where the host says that it is valid
  std::optional<PacketFault> fault;    ///< the message is refused
  std::optional<PacketFault> cutAt;    ///< packets from here on were dropped; those before count
  int regionalWeather = 0;             ///< Weather Control of a region or an entity: passed over
  int otherLayers = 0;                 ///< Weather Control of a layer that is not rain or snow: passed over
  int refusedPackets = 0;              ///< left out; all other packets count
  std::optional<PacketFault> refused;  ///< the first of them
  std::optional<PacketFault> ownship;  ///< the last of them that would have moved the own aircraft
  std::vector<std::uint16_t> otherEntities;  ///< moved by Entity Control, each once, the first few
  std::optional<std::size_t> otherEntityAt;  ///< offset of the first one's number
  std::vector<std::uint16_t> views;          ///< controlled or defined, each once, the first few
  std::vector<IgnoredPackets> ignored;       ///< of types that are not read, each type once
  std::vector<TerrainQuery> queries;
  int symbolPackets = 0;  ///< applied
};

/// Returns the byte order that the first packet's magic shows, if this looks like CIGI 3 at all.
std::optional<ByteOrder> byteOrder(std::span<const std::byte> bytes);
/// Reads one message into `session`. With a fault, nothing of it is read. A packet that is refused changes
/// nothing, and costs the message nothing else.
Message parse(std::span<const std::byte> bytes, Session& session, const Follow& follow = {});

}  // namespace trimtab::cigi3
