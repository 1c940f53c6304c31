#include <algorithm>
#include <cmath>
#include <numbers>

#include "packet_writer.h"
#include "trimtab/host/terrain_query.h"

namespace trimtab {
namespace {

/// Packets of an image generator (ICD 4.2.2 to 4.2.5) and their sizes in bytes.
constexpr std::uint8_t kHeight = 102, kHeights = 103, kSight = 104, kSightExtended = 105;
constexpr std::size_t kHeightSize = 16, kHeightsSize = 40, kSightSize = 16, kSightExtendedSize = 56;

/// A target that stands on the ground is seen: what is this near to the surface is not below it.
constexpr double kTouchM = 0.01;

/// A straight line over the ground, by metres from its beginning.
class Line {
 public:
  Line(const GroundHeights& ground, const GeodeticPosition& from, const GeodeticPosition& to)
      : ground_(ground), begin_(toEcef(from)), along_(toEcef(to) - begin_), length_(length(along_)) {}

  double lengthM() const { return length_; }
  GeodeticPosition at(double metres) const {
    return toGeodetic(length_ > 0 ? begin_ + along_ * (metres / length_) : begin_);
  }
  double heightAt(double metres) const { return at(metres).height.value(); }
  /// Returns the height over the ground; infinite where there is none.
  double clearance(double metres) const {
    const GeodeticPosition place = at(metres);
    const auto height = ground_.heightAt(place.latitude, place.longitude);
    return height ? (place.height - *height).value() : std::numeric_limits<double>::infinity();
  }

 private:
  const GroundHeights& ground_;
  Vec3 begin_, along_;
  double length_;
};

/// Returns where `isPast` changes from false at `before` to true at `after`, to half a centimetre.
template <class F>
double border(double before, double after, const F& isPast) {
  constexpr double kFine = 0.005;
  while (std::abs(after - before) > kFine) {
    const double middle = (before + after) / 2;
    (isPast(middle) ? after : before) = middle;
  }
  return after;
}

struct Stretch {
  double begin, end;
};

/// Returns the part of a line that is not above `highest`; empty if there is none. The height over a convex
/// earth has one lowest place along a straight line.
Stretch below(const Line& line, double highest) {
  double left = 0, right = line.lengthM();
  while (right - left > 1) {
    const double third = (right - left) / 3;
    if (line.heightAt(left + third) < line.heightAt(right - third))
      right -= third;
    else
      left += third;
  }
  // A line that only climbs or sinks is lowest at one of its ends.
  double at = (left + right) / 2;
  for (const double end : {0.0, line.lengthM()})
    if (line.heightAt(end) < line.heightAt(at)) at = end;
  const auto isAbove = [&](double metres) { return line.heightAt(metres) > highest; };
  if (isAbove(at)) return {0, -1};
  return {isAbove(0) ? border(at, 0, isAbove) : 0,
          isAbove(line.lengthM()) ? border(at, line.lengthM(), isAbove) : line.lengthM()};
}

void putHead(PacketWriter& w, const TerrainQuery& query, unsigned flags) {
  w.put(2, query.id);
  w.put(4, bits(flags | (query.hostFrame & 15U) << 4U));
}

/// Writes azimuth and elevation of the ground's normal at `offset`.
void putNormal(PacketWriter& w, std::size_t offset, const GroundSlope& slope) {
  constexpr double kDegree = 180 / std::numbers::pi;
  const double steepness = std::hypot(slope.east, slope.north);
  w.putFloat(offset, steepness > 0 ? std::atan2(-slope.east, -slope.north) * kDegree : 0);
  w.putFloat(offset + 4, 90 - std::atan(steepness) * kDegree);
}

void answerHeight(PacketWriter& w, const TerrainQuery& query, const GroundHeights* ground) {
  const auto height =
      ground && query.from ? ground->heightAt(query.from->latitude, query.from->longitude) : std::nullopt;
  const double above = height ? (query.from->height - *height).value() : 0;
  const double of = height ? height->value() : 0;
  if (query.height == TerrainQuery::Height::both) {
    w.begin(kHeights, kHeightsSize);
    putHead(w, query, height ? 1 : 0);
    w.put(8, above);
    w.put(16, of);
    const auto slope = height ? slopeAt(*ground, query.from->latitude, query.from->longitude) : std::nullopt;
    putNormal(w, 28, slope.value_or(GroundSlope{}));
    return;
  }
  const bool ofTerrain = query.height == TerrainQuery::Height::of_terrain;
  w.begin(kHeight, kHeightSize);
  putHead(w, query, (height ? 1U : 0U) | (ofTerrain ? 2U : 0U));
  w.put(8, ofTerrain ? of : above);
}

void answerSight(PacketWriter& w, const TerrainQuery& query, const GroundHeights* ground) {
  const bool known = ground && query.from && query.to, isSegment = query.kind == TerrainQuery::Kind::segment;
  std::optional<double> hit;
  double range = 0;
  if (known) {
    const Line line(*ground, *query.from, *query.to);
    const double nearest = std::min(query.nearest.value(), line.lengthM());
    hit = groundAlong(*ground, nearest > 0 ? line.at(nearest) : *query.from, *query.to);
    // A vector that is under ground where it begins to look meets none from above.
    if (hit && !isSegment && *hit == 0) hit.reset();
    range = hit ? nearest + *hit : line.lengthM();
  }
  const bool isVisible = known && isSegment && !hit;
  if (!query.extended) {
    w.begin(kSight, kSightSize);
    putHead(w, query, (hit ? 1U : 0U) | (isVisible ? 4U : 0U));
    w.put(5, std::uint8_t{1});
    w.put(8, hit ? range : 0.0);
    return;
  }
  w.begin(kSightExtended, kSightExtendedSize);
  putHead(w, query, (hit || isVisible ? 1U : 0U) | (hit ? 4U : 0U) | (isVisible ? 8U : 0U));
  w.put(5, std::uint8_t{1});
  if (!hit && !isVisible) return;
  const GeodeticPosition place = Line(*ground, *query.from, *query.to).at(range);
  w.put(8, range);
  w.put(16, place.latitude.value());
  w.put(24, place.longitude.value());
  w.put(32, place.height.value());
  if (!hit) return;
  w.put(43, std::uint8_t{255});  // opaque
  putNormal(w, 48, slopeAt(*ground, place.latitude, place.longitude).value_or(GroundSlope{}));
}

}  // namespace

std::optional<double> groundAlong(const GroundHeights& ground, const GeodeticPosition& from,
                                  const GeodeticPosition& to) {
  const Line line(ground, from, to);
  Stretch part{0, line.lengthM()};
  if (const auto highest = ground.highest()) part = below(line, highest->value());
  if (part.end < part.begin) return std::nullopt;
  const double wanted = (part.end - part.begin) / (ground.postDistance().value() / 2);
  const auto steps = static_cast<std::uint32_t>(std::clamp(std::ceil(wanted), 1.0, 1e6));
  double before = part.begin;
  for (std::uint32_t i = 0; i <= steps; ++i) {
    const double here = part.begin + (part.end - part.begin) * i / steps;
    const double clearance = line.clearance(here);
    if (clearance < -kTouchM) {
      if (i == 0) return here;
      return border(before, here, [&line](double metres) { return line.clearance(metres) < 0; });
    }
    before = here;
  }
  return std::nullopt;
}

std::vector<std::byte> answerOf(const TerrainQuery& query, const GroundHeights* ground) {
  PacketWriter w(query.order);
  if (query.kind == TerrainQuery::Kind::height)
    answerHeight(w, query, ground);
  else
    answerSight(w, query, ground);
  return w.take();
}

}  // namespace trimtab
