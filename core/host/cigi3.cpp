#include "cigi3.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "limits.h"
#include "symbol_packets.h"
#include "terrain_query_packets.h"

namespace trimtab::cigi3 {
namespace {

std::uint8_t byteAt(std::span<const std::byte> bytes, std::size_t offset) {
  return std::to_integer<std::uint8_t>(bytes[offset]);
}

/// Reader of one packet whose fault offsets count from the start of the datagram.
struct Packet {
  std::span<const std::byte> datagram;
  std::size_t start;
  FieldReader read;

  Packet(std::span<const std::byte> all, std::size_t at, ByteOrder order)
      : datagram(all), start(at), read(all, order) {}
  std::uint8_t u8(std::size_t offset) const { return byteAt(datagram, start + offset); }
  bool bit(std::size_t offset, int n) const { return ((u8(offset) >> n) & 1) != 0; }
  template <class T>
  T raw(std::size_t offset) const {
    return read.raw<T>(start + offset);
  }
  template <class T>
  double number(std::size_t offset, const char* field, double lowest, double highest, const char* unit) {
    return read.number<T>(start + offset, field, lowest, highest, unit);
  }
  double angle(std::size_t offset, const char* field, double limit) {
    return number<float>(offset, field, -limit, limit, "deg");
  }
};

std::optional<PacketFault> readIgControl(std::span<const std::byte> bytes, Message& message) {
  if (bytes.size() < 8)
    return PacketFault{bytes.size(), "CIGI message", "at least 8 bytes", std::to_string(bytes.size())};
  const std::uint8_t id = byteAt(bytes, 0), size = byteAt(bytes, 1), major = byteAt(bytes, 2);
  if (id == kStartOfFrame)
    return PacketFault{0, "CIGI packet id", "1 (IG Control: a host)",
                       "101 (Start of Frame: an image generator)"};
  if (id != kIgControl) return PacketFault{0, "CIGI packet id", "1 (IG Control)", std::to_string(id)};
  if (major != 3) return PacketFault{2, "CIGI major version", "3", std::to_string(major)};
  if (size != kIgControlSize && size != kOldIgControlSize)
    return PacketFault{1, "size of IG Control", "24 (16 before version 3.2)", std::to_string(size)};
  if (bytes.size() < size)
    return PacketFault{bytes.size(), "length", std::to_string(size) + " bytes of IG Control",
                       std::to_string(bytes.size())};
  const auto order = byteOrder(bytes);
  if (!order)
    return PacketFault{6, "byte-swap magic", "80 00 or 00 80",
                       std::to_string(byteAt(bytes, 6)) + " " + std::to_string(byteAt(bytes, 7))};
  message.order = *order;
  message.frame = wire::get<std::uint32_t>(bytes, 8, *order);
  if ((byteAt(bytes, 4) & 4) != 0) message.ticks = wire::get<std::uint32_t>(bytes, 12, *order);
  return std::nullopt;
}

using Refusal = std::optional<PacketFault>;

void noteOnce(std::vector<std::uint16_t>& list, std::uint16_t number) {
  if (list.size() < kMostNamed && std::find(list.begin(), list.end(), number) == list.end())
    list.push_back(number);
}

/// Reports whether a packet is of an entity beside the own aircraft, and notes it.
bool isOther(const Packet& p, const Follow& follow, Message& message) {
  const auto entity = p.raw<std::uint16_t>(2);
  if (entity == follow.entity) return false;
  if (!message.otherEntityAt) message.otherEntityAt = p.start + 2;
  noteOnce(message.otherEntities, entity);
  return true;
}

/// Reads a latitude and a longitude; hosts write longitudes of either turn.
GeodeticPosition placeAt(Packet& p, std::size_t latitudeAt, std::size_t longitudeAt) {
  const double latitude =
      p.number<double>(latitudeAt, "latitude", -limits::kLatitude, limits::kLatitude, "deg");
  const double longitude = p.number<double>(longitudeAt, "longitude", -limits::kTurn, limits::kTurn, "deg");
  return {Degrees{limits::clampedLatitude(latitude)}, wrapped180(Degrees{longitude}), Metres{0}};
}

Refusal readEntityControl(Packet& p, Session& session) {
  constexpr unsigned kDestroyed = 2;
  if ((p.u8(4) & 3U) == kDestroyed) {
    session.position.reset();
    return {};
  }
  if (p.bit(4, 2))
    return PacketFault{p.start + 4, "attach state of the own aircraft", "detached (a geodetic position)",
                       "attached", "let the host send where the aircraft is, not where it hangs"};
  // What is 3 in the bits of Ground/Ocean Clamp is not defined, and taken for a clamp.
  constexpr GroundClamp kClamps[] = {GroundClamp::none, GroundClamp::level, GroundClamp::conformal,
                                     GroundClamp::conformal};
  const double roll = p.angle(12, "roll", limits::kTurn);
  const double pitch = p.angle(16, "pitch", limits::kPitch);
  const double yaw = p.angle(20, "yaw", limits::kTurn);
  GeodeticPosition place = placeAt(p, 24, 32);
  place.height = Metres{p.number<double>(40, "altitude", limits::kLowest, limits::kHighest, "m")};
  if (p.read.fault()) return p.read.fault();
  session.clamp = kClamps[(p.u8(4) >> 5U) & 3U];
  session.position = place;
  session.attitude = {wrapped360(Degrees{yaw}), Degrees{limits::clampedPitch(pitch)},
                      wrapped180(Degrees{roll})};
  return {};
}

/// Conformal Clamped Entity Control (ICD 4.1.3): place and heading. Height, pitch and roll follow from the
/// ground, and from what an Entity Control of a clamped aircraft said before.
Refusal readClampedEntityControl(Packet& p, Session& session) {
  const double yaw = p.angle(4, "yaw", limits::kTurn);
  GeodeticPosition place = placeAt(p, 8, 16);
  if (p.read.fault()) return p.read.fault();
  if (session.clamp == GroundClamp::none || !session.position)
    session.attitude = {};
  else
    place.height = session.position->height;
  session.clamp = GroundClamp::conformal;
  session.position = place;
  session.attitude.heading = wrapped360(Degrees{yaw});
  return {};
}

Refusal readViewControl(Packet& p, Session& session, const Follow& follow, Message& message) {
  const auto view = p.raw<std::uint16_t>(2);
  const bool group = p.u8(4) != 0;
  if (p.raw<std::uint16_t>(6) != follow.entity) return {};
  if (!group) noteOnce(message.views, view);
  if (!group && follow.view.value_or(session.headView.value_or(view)) != view) return {};
  const bool roll = p.bit(5, 3), pitch = p.bit(5, 4), yaw = p.bit(5, 5);
  if (!roll && !pitch && !yaw) return {};
  Attitude head = session.head.value_or(Attitude{});
  if (roll) head.roll = wrapped180(Degrees{p.angle(20, "view roll", limits::kTurn)});
  if (pitch) head.pitch = Degrees{limits::clampedPitch(p.angle(24, "view pitch", limits::kPitch))};
  if (yaw) head.heading = wrapped180(Degrees{p.angle(28, "view yaw", limits::kTurn)});
  if (p.read.fault()) return p.read.fault();
  if (!group) session.headView = view;
  session.head = head;
  return {};
}

Refusal readViewDefinition(Packet& p, Session& session, const Follow& follow, Message& message) {
  const auto view = p.raw<std::uint16_t>(2);
  const bool group = p.u8(4) != 0;
  if (!group) noteOnce(message.views, view);
  if (!group && follow.view.value_or(session.definedView.value_or(view)) != view) return {};
  if ((p.u8(5) & 0x3dU) == 0) return {};
  HostView shape = session.view.value_or(HostView{});
  if (p.bit(5, 0)) shape.nearDistance = Metres{p.number<float>(8, "near plane", 1e-6, limits::kHighest, "m")};
  // Half-angles of a quarter turn or more have no picture plane.
  constexpr double kWidest = 89.9;
  if (p.bit(5, 2)) shape.left = Degrees{p.angle(16, "left half-angle", kWidest)};
  if (p.bit(5, 3)) shape.right = Degrees{p.angle(20, "right half-angle", kWidest)};
  if (p.bit(5, 4)) shape.top = Degrees{p.angle(24, "top half-angle", kWidest)};
  if (p.bit(5, 5)) shape.bottom = Degrees{p.angle(28, "bottom half-angle", kWidest)};
  if (p.read.fault()) return p.read.fault();
  if (!group) session.definedView = view;
  session.view = shape;
  return {};
}

/// Reads the wind at offsets 36 of Weather Control and 12 of Atmosphere Control: horizontal speed, vertical
/// speed, direction. CIGI 3.3 does not say whether the direction is where the wind blows from or to; we take
/// aviation's *from*. It changes nothing but how drops drift, so a wind that is no wind is passed over
/// instead of refusing its message.
std::optional<Wind> windAt(const Packet& p, std::size_t offset) {
  constexpr double kFastest = 200;  // m/s; no storm on Earth reaches it
  const double speed = p.raw<float>(offset), up = p.raw<float>(offset + 4), from = p.raw<float>(offset + 8);
  const bool isWind =
      std::abs(speed) <= kFastest && std::abs(up) <= kFastest && std::abs(from) <= limits::kTurn;
  if (!isWind) return std::nullopt;
  return Wind{MetresPerSecond{speed}, wrapped360(Degrees{from}), MetresPerSecond{up}};
}

bool isCalm(const Wind& wind) {
  return wind.speed.value() == 0 && wind.up.value() == 0;
}

Refusal readAtmosphereControl(Packet& p, Session& session) {
  const double visibility = p.number<float>(8, "global visibility", 0, limits::kVisibility, "m");
  if (p.read.fault()) return p.read.fault();
  session.visibility = visibility > 0 ? std::optional(Metres{visibility}) : std::nullopt;
  session.atmosphereWind = windAt(p, 12);
  return {};
}

Refusal readWeatherControl(Packet& p, Session& session, Message& message) {
  const unsigned scope = p.u8(7) & 3U;
  const std::uint8_t layer = p.u8(4);
  if (scope != 0) {
    ++message.regionalWeather;
    return {};
  }
  if (layer != kRainLayer && layer != kSnowLayer) {
    ++message.otherLayers;
    return {};
  }
  Layer heard;
  heard.enabled = p.bit(6, 0);
  if (heard.enabled) {
    heard.severity = (p.u8(7) >> 2U) & 7;
    if (heard.severity > HostWeather::kMostSevere)
      return PacketFault{p.start + 7, "severity", "0..5", std::to_string(heard.severity)};
    const double visibility = p.number<float>(12, "layer visibility", 0, limits::kVisibility, "m");
    if (p.read.fault()) return p.read.fault();
    if (visibility > 0) heard.visibility = Metres{visibility};
    heard.wind = windAt(p, 36);
    if (heard.wind && isCalm(*heard.wind)) heard.wind.reset();
  }
  (layer == kRainLayer ? session.rain : session.snow) = heard;
  return {};
}

/// Returns the size that a packet that we read must have; 0 for all others.
std::size_t sizeOf(std::uint8_t id) {
  switch (id) {
    case kEntityControl:
      return kEntityControlSize;
    case kClampedEntityControl:
      return kClampedEntityControlSize;
    case kAtmosphereControl:
      return kAtmosphereControlSize;
    case kWeatherControl:
      return kWeatherControlSize;
    case kViewControl:
      return kViewControlSize;
    case kViewDefinition:
      return kViewDefinitionSize;
    case kHeightRequest:
      return kHeightRequestSize;
    case kSegmentRequest:
      return kSegmentRequestSize;
    case kVectorRequest:
      return kVectorRequestSize;
    default:
      return 0;
  }
}

void ignore(std::vector<IgnoredPackets>& ignored, std::uint8_t id) {
  const auto known =
      std::find_if(ignored.begin(), ignored.end(), [id](const IgnoredPackets& i) { return i.id == id; });
  if (known == ignored.end())
    ignored.push_back({id, 1});
  else
    ++known->count;
}

/// Reads a packet of one of the types that sizeOf() knows. What is refused has changed nothing.
Refusal readPacket(Packet& p, Session& session, const Follow& follow, Message& message) {
  const std::uint8_t id = p.u8(0);
  const bool moves = id == kEntityControl || id == kClampedEntityControl;
  if (moves && isOther(p, follow, message)) return {};
  Refusal refusal;
  if (const std::size_t expected = sizeOf(id), size = p.u8(1); size != expected)
    refusal = PacketFault{p.start + 1, "size of packet " + cigiPacketName(id), std::to_string(expected),
                          std::to_string(size)};
  else if (id == kEntityControl)
    refusal = readEntityControl(p, session);
  else if (id == kClampedEntityControl)
    refusal = readClampedEntityControl(p, session);
  else if (id == kAtmosphereControl)
    refusal = readAtmosphereControl(p, session);
  else if (id == kWeatherControl)
    refusal = readWeatherControl(p, session, message);
  else if (id == kViewControl)
    refusal = readViewControl(p, session, follow, message);
  else if (id == kViewDefinition)
    refusal = readViewDefinition(p, session, follow, message);
  else
    message.queries.push_back(readTerrainQuery(p.datagram, p.start, message, session, follow));
  if (refusal && moves) message.ownship = refusal;
  return refusal;
}

}  // namespace

std::optional<HostWeather> Session::weather() const {
  if (!rain && !snow) return std::nullopt;
  const bool rains = rain && rain->enabled, snows = snow && snow->enabled;
  if (snows && (!rains || snow->severity >= rain->severity))
    return HostWeather{Precipitation::snow, snow->severity, snow->visibility};
  if (rains) return HostWeather{Precipitation::rain, rain->severity, rain->visibility};
  return HostWeather{};
}

std::optional<Wind> Session::wind() const {
  const std::optional<HostWeather> falls = weather();
  const std::optional<Layer>& layer = falls && falls->precipitation == Precipitation::snow ? snow : rain;
  const bool inLayer = falls && falls->precipitation != Precipitation::none && layer && layer->wind;
  return inLayer ? layer->wind : atmosphereWind;
}

std::optional<ByteOrder> byteOrder(std::span<const std::byte> bytes) {
  if (bytes.size() < 8) return std::nullopt;
  if (wire::get<std::uint16_t>(bytes, 6, ByteOrder::big) == kByteSwapMagic) return ByteOrder::big;
  if (wire::get<std::uint16_t>(bytes, 6, ByteOrder::little) == kByteSwapMagic) return ByteOrder::little;
  return std::nullopt;
}

Message parse(std::span<const std::byte> bytes, Session& session, const Follow& follow) {
  Message message;
  message.fault = readIgControl(bytes, message);
  if (message.fault) return message;

  SymbolEdit symbols(session.symbols);
  for (std::size_t at = byteAt(bytes, 1); at < bytes.size();) {
    const std::size_t left = bytes.size() - at;
    const std::size_t size = left >= 2 ? byteAt(bytes, at + 1) : 0;
    if (size == 0 || size % 8 != 0 || size > left) {
      message.cutAt = PacketFault{at + 1, "packet size",
                                  "a multiple of 8 within the " + std::to_string(left) + " bytes left",
                                  left >= 2 ? std::to_string(size) : "the end"};
      break;
    }
    const std::uint8_t id = byteAt(bytes, at);
    Refusal refusal;
    if (sizeOf(id) != 0) {
      Packet packet(bytes, at, message.order);
      refusal = readPacket(packet, session, follow, message);
    } else if (isSymbolPacket(id)) {
      refusal = symbols.apply(bytes, at, message.order);
      message.symbolPackets += !refusal;
    } else {
      ignore(message.ignored, id);
    }
    // The aircraft must fly on, whatever one packet says.
    message.refusedPackets += refusal.has_value();
    if (refusal && !message.refused) message.refused = std::move(refusal);
    at += size;
  }
  // A host may define all its symbols again in every message: what is equal stays the same store.
  const auto& after = symbols.symbols();
  if (!session.symbols || (after != session.symbols && *after != *session.symbols)) session.symbols = after;
  return message;
}

}  // namespace trimtab::cigi3
