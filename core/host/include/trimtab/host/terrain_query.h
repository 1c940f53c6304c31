#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "trimtab/frame/ground_heights.h"
#include "trimtab/host/byte_order.h"
#include "trimtab/units/geodesy.h"

/// What a CIGI host asks about the terrain, and the packets that answer it: height above and of terrain
/// (HAT/HOT), and lines of sight.
namespace trimtab {

/// One request (CIGI 3.3, packets 24 to 26). The terrain alone can hide something: the image has no entities.
struct TerrainQuery {
  enum class Kind { height, segment, vector };
  /// What a request of heights wants to know.
  enum class Height : std::uint8_t { above_terrain, of_terrain, both };

  Kind kind = Kind::height;
  std::uint16_t id = 0;
  Height height = Height::above_terrain;
  bool extended = false;        ///< of lines of sight: with the place and the normal of the ground
  std::uint8_t everyFrame = 0;  ///< answered again at every so many frames of the image generator; 0: once
  std::uint32_t hostFrame = 0;
  ByteOrder order = ByteOrder::big;
  /// The point of a height, or the source of a line; unset if it is given relative to an entity whose place
  /// is unknown, or if it is no place on earth.
  std::optional<GeodeticPosition> from;
  std::optional<GeodeticPosition> to;  ///< the target of a segment, or where a vector's greatest range ends
  Metres nearest;                      ///< of a vector: ground is looked for from here on
};

/// Returns where the straight line from `from` to `to` first meets the ground, as metres from `from`; nullopt
/// if it meets none. The ground is looked up every half of its posts' distance, and the place is found to a
/// centimetre; ground that pierces the line between two look-ups is not seen. Where there are no data, there
/// is no ground.
std::optional<double> groundAlong(const GroundHeights& ground, const GeodeticPosition& from,
                                  const GeodeticPosition& to);

/// Returns the packet that answers a request (CIGI 3.3, packets 102 to 105), in the request's byte order. It
/// says that it holds nothing valid where `ground` is null or has no data.
std::vector<std::byte> answerOf(const TerrainQuery& query, const GroundHeights* ground);

}  // namespace trimtab
