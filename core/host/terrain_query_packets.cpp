#include "terrain_query_packets.h"

#include <cmath>
#include <numbers>

#include "limits.h"

namespace trimtab::cigi3 {
namespace {

struct Request {
  std::span<const std::byte> datagram;
  std::size_t start;
  ByteOrder order;
  const Session& session;
  const Follow& follow;

  std::uint8_t u8(std::size_t offset) const {
    return std::to_integer<std::uint8_t>(datagram[start + offset]);
  }
  bool bit(std::size_t offset, int n) const { return ((u8(offset) >> n) & 1) != 0; }
  template <class T>
  T raw(std::size_t offset) const {
    return wire::get<T>(datagram, start + offset, order);
  }

  /// Returns metres forward, right and down of the own aircraft in metres east, north and up of it.
  Vec3 turned(const LocalFrame& frame, Vec3 body) const {
    // The axes of an eye are right, up and backward.
    return transposed(eyeAxes(frame, *session.position, session.attitude)) * Vec3{body.y, -body.z, -body.x};
  }

  /// Reports whether points may be given relative to `entity`. A clamped aircraft's height is known only
  /// where the terrain is.
  bool isKnown(std::uint16_t entity) const {
    return entity == follow.entity && session.position && session.clamp == GroundClamp::none;
  }

  /// Reads the point at `offset`: latitude, longitude and altitude, or offsets from `entity`.
  std::optional<GeodeticPosition> point(std::size_t offset, bool ofEntity, std::uint16_t entity,
                                        bool wantsAltitude = true) const {
    const double x = raw<double>(offset), y = raw<double>(offset + 8);
    const double z = wantsAltitude || ofEntity ? raw<double>(offset + 16) : 0;
    const auto isNear = [](double metres) { return std::abs(metres) <= limits::kHighest; };
    if (ofEntity) {
      if (!isKnown(entity) || !isNear(x) || !isNear(y) || !isNear(z)) return std::nullopt;
      const LocalFrame frame(*session.position);
      return frame.toGeodetic(turned(frame, {x, y, z}));
    }
    const bool onEarth = std::abs(x) <= limits::kLatitude && std::abs(y) <= limits::kTurn &&
                         z >= limits::kLowest && z <= limits::kHighest;
    if (!onEarth) return std::nullopt;
    return GeodeticPosition{Degrees{limits::clampedLatitude(x)}, wrapped180(Degrees{y}), Metres{z}};
  }

  /// Reads the direction and range of a vector from `query.from`, on the axes that its point is given on.
  void readVector(TerrainQuery& query, bool ofEntity) const {
    const double azimuth = raw<float>(8), elevation = raw<float>(12);
    const double nearest = raw<float>(16), farthest = raw<float>(20);
    const bool isRay = std::abs(azimuth) <= limits::kTurn && std::abs(elevation) <= limits::kPitch &&
                       nearest >= 0 && farthest >= nearest && farthest <= limits::kHighest;
    if (!isRay || !query.from) return query.from.reset();
    constexpr double kRadian = std::numbers::pi / 180;
    const double level = farthest * std::cos(elevation * kRadian);
    const double ahead = level * std::cos(azimuth * kRadian), aside = level * std::sin(azimuth * kRadian);
    const double up = farthest * std::sin(elevation * kRadian);
    const LocalFrame frame(*query.from);
    query.to = frame.toGeodetic(ofEntity ? turned(frame, {ahead, aside, -up}) : Vec3{aside, ahead, up});
    query.nearest = Metres{nearest};
  }
};

TerrainQuery::Height heightAsked(unsigned bits) {
  using Height = TerrainQuery::Height;
  return bits == 0 ? Height::above_terrain : bits == 1 ? Height::of_terrain : Height::both;
}

}  // namespace

TerrainQuery readTerrainQuery(std::span<const std::byte> datagram, std::size_t at, const Message& message,
                              const Session& session, const Follow& follow) {
  const Request r{datagram, at, message.order, session, follow};
  TerrainQuery query;
  query.id = r.raw<std::uint16_t>(2);
  query.hostFrame = message.frame;
  query.order = message.order;
  const auto entity = r.raw<std::uint16_t>(6);
  switch (r.u8(0)) {
    case kHeightRequest:
      query.kind = TerrainQuery::Kind::height;
      query.height = heightAsked(r.u8(4) & 3U);
      query.everyFrame = r.u8(5);
      query.from = r.point(8, r.bit(4, 2), entity, query.height != TerrainQuery::Height::of_terrain);
      break;
    case kSegmentRequest: {
      const auto target = r.bit(4, 4) ? r.raw<std::uint16_t>(62) : entity;
      query.kind = TerrainQuery::Kind::segment;
      query.extended = r.bit(4, 0);
      query.everyFrame = r.u8(60);
      query.from = r.point(8, r.bit(4, 1), entity);
      query.to = r.point(32, r.bit(4, 2), target);
      break;
    }
    default:
      query.kind = TerrainQuery::Kind::vector;
      query.extended = r.bit(4, 0);
      query.everyFrame = r.u8(52);
      query.from = r.point(24, r.bit(4, 1), entity);
      r.readVector(query, r.bit(4, 1));
  }
  return query;
}

}  // namespace trimtab::cigi3
