#include "cigi3.h"

#include <cmath>
#include <string>

#include "limits.h"
#include "symbol_packets.h"

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

void readEntityControl(Packet& p, Session& session, Message& message) {
  if (const auto entity = p.raw<std::uint16_t>(2); entity != kOwnship) {
    if (message.otherEntities++ == 0)
      message.otherEntity = PacketFault{p.start + 2, "entity", "0, the ownship", std::to_string(entity),
                                        "let the host send its own aircraft as entity 0"};
    return;
  }
  constexpr unsigned kDestroyed = 2;
  if ((p.u8(4) & 3U) == kDestroyed) {
    session.position.reset();
    return;
  }
  if (p.bit(4, 2)) {
    message.fault =
        PacketFault{p.start + 4, "attach state of the ownship", "detached (a geodetic position)", "attached"};
    return;
  }
  const double roll = p.angle(12, "roll", limits::kTurn);
  const double pitch = p.angle(16, "pitch", limits::kPitch);
  const double yaw = p.angle(20, "yaw", limits::kTurn);
  const double latitude = p.number<double>(24, "latitude", -limits::kLatitude, limits::kLatitude, "deg");
  const double longitude = p.number<double>(32, "longitude", -limits::kLongitude, limits::kLongitude, "deg");
  const double altitude = p.number<double>(40, "altitude", limits::kLowest, limits::kHighest, "m");
  session.position = {Degrees{limits::clampedLatitude(latitude)}, wrapped180(Degrees{longitude}),
                      Metres{altitude}};
  session.attitude = {wrapped360(Degrees{yaw}), Degrees{limits::clampedPitch(pitch)},
                      wrapped180(Degrees{roll})};
}

void readViewControl(Packet& p, Session& session) {
  const auto view = p.raw<std::uint16_t>(2);
  const bool group = p.u8(4) != 0;
  if (p.raw<std::uint16_t>(6) != kOwnship) return;
  if (!group && session.headView.value_or(view) != view) return;
  const bool roll = p.bit(5, 3), pitch = p.bit(5, 4), yaw = p.bit(5, 5);
  if (!roll && !pitch && !yaw) return;
  Attitude head = session.head.value_or(Attitude{});
  if (roll) head.roll = wrapped180(Degrees{p.angle(20, "view roll", limits::kTurn)});
  if (pitch) head.pitch = Degrees{limits::clampedPitch(p.angle(24, "view pitch", limits::kPitch))};
  if (yaw) head.heading = wrapped180(Degrees{p.angle(28, "view yaw", limits::kTurn)});
  if (!group) session.headView = view;
  session.head = head;
}

void readViewDefinition(Packet& p, Session& session) {
  const auto view = p.raw<std::uint16_t>(2);
  const bool group = p.u8(4) != 0;
  if (!group && session.definedView.value_or(view) != view) return;
  if ((p.u8(5) & 0x3dU) == 0) return;
  HostView shape = session.view.value_or(HostView{});
  if (p.bit(5, 0)) shape.nearDistance = Metres{p.number<float>(8, "near plane", 1e-6, limits::kHighest, "m")};
  // Half-angles of a quarter turn or more have no picture plane.
  constexpr double kWidest = 89.9;
  if (p.bit(5, 2)) shape.left = Degrees{p.angle(16, "left half-angle", kWidest)};
  if (p.bit(5, 3)) shape.right = Degrees{p.angle(20, "right half-angle", kWidest)};
  if (p.bit(5, 4)) shape.top = Degrees{p.angle(24, "top half-angle", kWidest)};
  if (p.bit(5, 5)) shape.bottom = Degrees{p.angle(28, "bottom half-angle", kWidest)};
  if (!group) session.definedView = view;
  session.view = shape;
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

void readAtmosphereControl(Packet& p, Session& session) {
  const double visibility = p.number<float>(8, "global visibility", 0, limits::kVisibility, "m");
  session.visibility = visibility > 0 ? std::optional(Metres{visibility}) : std::nullopt;
  session.atmosphereWind = windAt(p, 12);
}

void readWeatherControl(Packet& p, Session& session, Message& message) {
  const unsigned scope = p.u8(7) & 3U;
  const std::uint8_t layer = p.u8(4);
  if (scope != 0) {
    ++message.regionalWeather;
    return;
  }
  if (layer != kRainLayer && layer != kSnowLayer) {
    ++message.otherLayers;
    return;
  }
  Layer heard;
  heard.enabled = p.bit(6, 0);
  if (heard.enabled) {
    heard.severity = (p.u8(7) >> 2U) & 7;
    if (heard.severity > HostWeather::kMostSevere)
      message.fault = PacketFault{p.start + 7, "severity", "0..5", std::to_string(heard.severity)};
    const double visibility = p.number<float>(12, "layer visibility", 0, limits::kVisibility, "m");
    if (visibility > 0) heard.visibility = Metres{visibility};
    heard.wind = windAt(p, 36);
    if (heard.wind && isCalm(*heard.wind)) heard.wind.reset();
  }
  (layer == kRainLayer ? session.rain : session.snow) = heard;
}

/// A symbol packet that is refused costs its message nothing else: the ownship must fly on.
void readSymbols(std::span<const std::byte> bytes, std::size_t at, SymbolEdit& symbols, Message& message) {
  std::optional<PacketFault> fault = symbols.apply(bytes, at, message.order);
  ++(fault ? message.refusedSymbols : message.symbolPackets);
  if (fault && !message.symbolFault) message.symbolFault = std::move(fault);
}

/// Returns the size that a packet that we read must have; 0 for all others.
std::size_t sizeOf(std::uint8_t id) {
  switch (id) {
    case kEntityControl:
      return kEntityControlSize;
    case kAtmosphereControl:
      return kAtmosphereControlSize;
    case kWeatherControl:
      return kWeatherControlSize;
    case kViewControl:
      return kViewControlSize;
    case kViewDefinition:
      return kViewDefinitionSize;
    default:
      return 0;
  }
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

Message parse(std::span<const std::byte> bytes, Session& session) {
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
    if (const std::size_t expected = sizeOf(id); expected != 0) {
      if (size != expected) {
        message.fault = PacketFault{at + 1, "size of packet " + std::to_string(id), std::to_string(expected),
                                    std::to_string(size)};
        return message;
      }
      Packet packet(bytes, at, message.order);
      if (id == kEntityControl) readEntityControl(packet, session, message);
      if (id == kAtmosphereControl) readAtmosphereControl(packet, session);
      if (id == kWeatherControl) readWeatherControl(packet, session, message);
      if (id == kViewControl) readViewControl(packet, session);
      if (id == kViewDefinition) readViewDefinition(packet, session);
      if (!message.fault) message.fault = packet.read.fault();
      if (message.fault) return message;
    }
    if (isSymbolPacket(id)) readSymbols(bytes, at, symbols, message);
    at += size;
  }
  // A host may define all its symbols again in every message: what is equal stays the same store.
  const auto& after = symbols.symbols();
  if (!session.symbols || (after != session.symbols && *after != *session.symbols)) session.symbols = after;
  return message;
}

}  // namespace trimtab::cigi3
