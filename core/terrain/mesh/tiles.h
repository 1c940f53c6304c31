#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "greedy.h"

namespace trimtab::terrain {

/// Calls `work(i)` for 0 <= i < count on so many threads, this one among them.
void onThreads(unsigned threads, std::uint32_t count, const std::function<void(std::uint32_t)>& work);

/// A field in tiles of about 100 posts, each its own greedy mesh; sides are simplified once for both tiles at
/// them. Caches hold a tile, and tiles need no word of each other: so it is faster even on one core.
class MeshTiles {
 public:
  /// `nearer`: in shares of a tolerance, that which tiles are to be taken to when all are refined.
  MeshTiles(const HeightField& field, std::size_t mostTriangles, double nearer, unsigned threads);

  /// Refines to `tolerance` the tiles that are taken. One that is finer already begins anew.
  void refine(double tolerance);
  /// Adds triangles where tiles are furthest off, up to `most` in all; sides stay as they are. No post gets
  /// further off than `bound`, which holds before.
  void add(std::size_t most, double bound);
  /// All tiles, or as a sample an eighth of them, to learn what a tolerance costs. What share that is.
  double take(bool sample);

  std::int32_t width() const { return static_cast<std::int32_t>((field_.columns - 1) / across_); }
  std::int32_t height() const { return static_cast<std::int32_t>((field_.rows - 1) / up_); }
  std::size_t triangles() const;
  double maxErrorM() const;
  std::size_t count() const { return tiles_.size(); }
  const GreedyMesh& tile(std::size_t index) const { return tiles_[index].mesh; }
  /// Calls `work` for each tile with its index, in parallel; what it does to the mesh ends refinement: all
  /// begin anew after it. Inner vertices may lose all their triangles.
  void eachTile(const std::function<void(GreedyMesh&, std::size_t)>& work);
  /// All tiles as one mesh, in places of the field: their triangles one tile after the other.
  Triangulation join() const;

 private:
  /// Posts of a side between its ends: those whose key is above a tolerance keep all others within it.
  struct Side {
    PolygonMesher::Point from, to;
    std::vector<double> key;  ///< one a post from `from` to `to`
  };
  static constexpr double kNotBegun = -HUGE_VAL;
  struct Tile {
    GreedyMesh mesh;
    bool taken = true;
    double tolerance = kNotBegun;         ///< that it is refined to
    std::uint32_t sides[4];               ///< south, east, north, west
    std::vector<std::int32_t> vertex[4];  ///< of each post of a side, in the side's order; -1: none
  };
  void begin(Tile& tile, double tolerance);
  void addSides(Tile& tile, double tolerance);
  std::uint32_t horizontal(std::uint32_t i, std::uint32_t j) const { return j * across_ + i; }
  std::uint32_t vertical(std::uint32_t i, std::uint32_t j) const {
    return across_ * (up_ + 1) + j * (across_ + 1) + i;
  }

  HeightField field_;
  double sideShare_;  ///< of the tolerance of tiles that of their sides
  unsigned threads_;
  std::uint32_t across_ = 1, up_ = 1;
  std::vector<std::uint32_t> columns_, rows_;  ///< of the lines between tiles
  std::vector<Side> sides_;
  std::vector<Tile> tiles_;
};

}  // namespace trimtab::terrain
