#include "dis.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "dead_reckoning.h"
#include "limits.h"

namespace trimtab::dis {
namespace {

enum Offset : std::size_t {
  kTime = 4,
  kLength = 8,
  kSite = 12,
  kParameters = 19,
  kKind = 20,
  kVelocity = 36,
  kLocation = 48,
  kPsi = 72,
  kAppearance = 84,
  kAlgorithm = 88,
  kAcceleration = 104,
  kAngularVelocity = 116,
  kMarking = 129
};

std::string idText(const EntityId& id) {
  return std::to_string(id.site) + ':' + std::to_string(id.application) + ':' + std::to_string(id.entity);
}

std::string lowerCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::uint8_t byteAt(std::span<const std::byte> bytes, std::size_t offset) {
  return std::to_integer<std::uint8_t>(bytes[offset]);
}

std::string markingOf(std::span<const std::byte> pdu) {
  constexpr std::size_t kLongest = 11;
  std::string text;
  for (std::size_t i = 0; i < kLongest; ++i) {
    const std::uint8_t c = byteAt(pdu, kMarking + i);
    if (c == 0) break;
    text += c >= ' ' && c < 0x7f ? static_cast<char>(c) : '?';
  }
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

Vec3 vectorAt(const FieldReader& read, std::size_t offset) {
  return {read.raw<float>(offset), read.raw<float>(offset + 4), read.raw<float>(offset + 8)};
}

/// Says how the entity moves on, and how fast it is in ECEF. Both are unset if the numbers are none, or none
/// that an aircraft has, or if the algorithm is not one of 1 to 9: states are extrapolated, then.
struct Motion {
  std::optional<DeadReckoning> reckoning;
  std::optional<Vec3> velocity;
};

Motion motionAt(const FieldReader& read, std::size_t at, unsigned algorithm, const Mat3& ecefToBody) {
  constexpr double kFastest = 20e3, kHardest = 1e4, kQuickest = 100;  // m/s, m/s2, rad/s
  constexpr unsigned kStatic = 1, kFirstInBody = 6, kLast = 9;
  const Vec3 velocity = vectorAt(read, at + kVelocity), acceleration = vectorAt(read, at + kAcceleration),
             angular = vectorAt(read, at + kAngularVelocity);
  if (algorithm < kStatic || algorithm > kLast) return {};
  DeadReckoning reckoning;
  if (algorithm == kStatic) return {reckoning, Vec3{}};
  reckoning.inBodyAxes = algorithm >= kFirstInBody;
  // Names of the algorithms: fixed or rotating, of position or velocity (and so accelerated), world or body.
  reckoning.rotates = algorithm == 3 || algorithm == 4 || algorithm == 7 || algorithm == 8;
  const bool accelerates = algorithm == 4 || algorithm == 5 || algorithm == 8 || algorithm == 9;
  reckoning.velocity = velocity;
  if (accelerates) reckoning.acceleration = acceleration;
  if (reckoning.rotates) reckoning.angularVelocity = angular;
  const bool usable = length(velocity) <= kFastest && length(reckoning.acceleration) <= kHardest &&
                      length(reckoning.angularVelocity) <= kQuickest;
  if (!usable) return {};
  return {reckoning, reckoning.inBodyAxes ? transposed(ecefToBody) * velocity : velocity};
}

}  // namespace

std::string toString(const Entity& entity) {
  return idText(entity.id) + (entity.marking.empty() ? "" : ' ' + entity.marking);
}

bool matches(std::span<const std::byte> bytes) {
  std::size_t at = 0;
  while (bytes.size() - at >= kHeaderSize) {
    const unsigned version = byteAt(bytes, at);
    const auto length = wire::get<std::uint16_t>(bytes, at + kLength, ByteOrder::big);
    const bool isPdu = version >= 4 && version <= 7 && byteAt(bytes, at + 3) != 0 && length >= kHeaderSize &&
                       length <= bytes.size() - at;
    if (!isPdu) return false;
    at += length;
  }
  return at > 0 && at == bytes.size();
}

std::optional<PacketFault> parse(std::span<const std::byte> datagram, std::size_t at, Entity& entity) {
  const auto length = wire::get<std::uint16_t>(datagram, at + kLength, ByteOrder::big);
  if (length < kEntityStateSize)
    return PacketFault{at + kLength, "length of Entity State", "at least 144 bytes", std::to_string(length)};
  const std::span<const std::byte> pdu = datagram.subspan(at, length);
  if (const std::size_t whole = kEntityStateSize + kParameterSize * byteAt(pdu, kParameters); length < whole)
    return PacketFault{at + kParameters, "variable parameters",
                       "at most " + std::to_string((length - kEntityStateSize) / kParameterSize) + " in " +
                           std::to_string(length) + " bytes",
                       std::to_string(byteAt(pdu, kParameters))};
  FieldReader read(datagram, ByteOrder::big);
  entity = {};
  entity.id = {read.raw<std::uint16_t>(at + kSite), read.raw<std::uint16_t>(at + kSite + 2),
               read.raw<std::uint16_t>(at + kSite + 4)};
  entity.marking = markingOf(pdu);
  entity.isPlatform = byteAt(pdu, kKind) == 1;
  entity.ticks = read.raw<std::uint32_t>(at + kTime) & ~1U;
  // SISO-REF-010, appearance of platforms: bit 21 frozen, bit 23 deactivated.
  const auto appearance = read.raw<std::uint32_t>(at + kAppearance);
  const bool frozen = (appearance >> 21U & 1U) != 0;
  entity.isGone = (appearance >> 23U & 1U) != 0;

  constexpr double kFurthest = 1e7, kNearest = 6e6, kDegrees = unit::Radian::size / unit::Degree::size;
  const double x = read.number<double>(at + kLocation, "location x", -kFurthest, kFurthest, "m"),
               y = read.number<double>(at + kLocation + 8, "location y", -kFurthest, kFurthest, "m"),
               z = read.number<double>(at + kLocation + 16, "location z", -kFurthest, kFurthest, "m");
  const auto angle = [&](std::size_t offset, const char* field) {
    return Degrees{read.number<float>(at + offset, field, -limits::kTurn, limits::kTurn, "deg", kDegrees)};
  };
  const Degrees psi = angle(kPsi, "psi"), theta = angle(kPsi + 4, "theta"), phi = angle(kPsi + 8, "phi");
  if (read.fault()) return read.fault();
  const double fromCentre = trimtab::length(Vec3{x, y, z});
  const GeodeticPosition position = fromCentre > kNearest ? toGeodetic({x, y, z}) : GeodeticPosition{};
  const bool aloft =
      position.height.value() >= limits::kLowest && position.height.value() <= limits::kHighest;
  if (!(fromCentre > kNearest) || !aloft)
    return PacketFault{at + kLocation, "location", "a place of ECEF near the surface of the earth, metres",
                       std::to_string(std::llround(fromCentre)) + " m from its centre"};

  const Mat3 body = bodyAxes(psi.as<Radians>(), theta.as<Radians>(), phi.as<Radians>());
  entity.state.position = position;
  entity.state.attitude = attitudeOf(position, body);
  const Motion motion = motionAt(read, at, frozen ? 1U : byteAt(pdu, kAlgorithm), body);
  entity.state.deadReckoning = motion.reckoning;
  if (motion.velocity) entity.state.velocity = overGround(position, *motion.velocity);
  return std::nullopt;
}

bool OwnEntity::isOwn(const Entity& entity) {
  const bool own = [&] {
    if (wanted_.empty()) {
      if (!first_ && entity.isPlatform) first_ = entity.id;
      return first_ == entity.id;
    }
    return wanted_ == idText(entity.id) || wanted_ == std::to_string(entity.id.entity) ||
           lowerCase(wanted_) == lowerCase(entity.marking);
  }();
  constexpr std::size_t kMostOthers = 16;
  const auto known = std::find_if(others_.begin(), others_.end(),
                                  [&](const Entity& other) { return other.id == entity.id; });
  if (own && known != others_.end()) others_.erase(known);
  if (!own && known == others_.end() && others_.size() < kMostOthers) others_.push_back(entity);
  return own;
}

std::string OwnEntity::others() const {
  std::string text;
  for (const Entity& other : others_) text += (text.empty() ? "" : ", ") + toString(other);
  return text;
}

}  // namespace trimtab::dis
