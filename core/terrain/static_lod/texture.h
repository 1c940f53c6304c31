#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "edges.h"
#include "quadric.h"
#include "trimtab/terrain/static_lod/lattice.h"

/// Texture coordinates while a tile is simplified. Each corner of a triangle has its own, because they may
/// jump along a seam; corners at one vertex with the same coordinates are a *wedge* (Hoppe, "New Quadric
/// Metric for Simplifying Meshes with Appearance Attributes", 1999).
namespace trimtab::terrain {

/// Texture coordinates as a linear function of the place seen from above, metres.
struct TextureMap {
  std::array<double, 2> x{}, y{}, at0{};  ///< per coordinate: change by metre east and north, value at 0

  std::array<double, 2> at(double px, double py) const {
    return {at0[0] + x[0] * px + y[0] * py, at0[1] + x[1] * px + y[1] * py};
  }
};
/// Returns the map of a triangle; unset if it is a sliver seen from above, or faces down.
std::optional<TextureMap> textureMapOf(const std::array<Vec3, 3>& places, const TextureCorners& texture);

/// Reports whether texture coordinates jump at an edge between two triangles. Returns false without any.
bool isSeam(const LatticeTile& tile, const EdgeUse& a, const EdgeUse& b);

/// Adds, per wedge of a vertex, the variance of the coordinates that the maps of its triangles predict for a
/// place, as square metres on the ground, times `weight` and the wedge's area. It is zero while they are one
/// linear map. Does nothing if the tile has no texture coordinates.
void addTextureQuadrics(const LatticeTile& tile, const Lattice& origin, double weight,
                        std::span<Quadric> quadrics);

/// A corner at either end of an edge that collapses.
struct WedgeCorner {
  std::uint32_t corner = 0;  ///< three times the triangle plus 0 to 2
  bool second = false;       ///< it is at the second end of the edge
  bool goes = false;         ///< its triangle goes; that has corners at both ends
};
/// Gives corners at the ends of a collapsed edge the texture coordinates of the new place. Wedges of both
/// ends that a triangle which goes has become one. If the new vertex is an end (`end`: 0 or 1), its wedges
/// stay and the other's take theirs; else, and where the end has no wedge to take, the new coordinates are
/// those that the triangles' maps predict, weighted by the square of their area. `places` has, per corner,
/// its triangle's places before the collapse.
class WedgeCollapse {
 public:
  void run(std::span<const WedgeCorner> corners, std::optional<bool> end, Vec3 place,
           std::span<const std::array<Vec3, 3>> places, std::vector<TextureCorners>& texture);

 private:
  struct Wedge {
    bool second = false;
    TexturePlace at{};
    std::uint32_t parent = 0;
  };
  std::uint32_t rootOf(std::uint32_t wedge) const;
  std::vector<Wedge> wedges_;
  std::vector<std::uint32_t> wedgeOf_;  ///< per corner
};

}  // namespace trimtab::terrain
