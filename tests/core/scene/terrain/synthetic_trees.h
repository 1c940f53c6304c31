#pragma once

#include <map>
#include <memory>

#include "synthetic_terrain.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/static_lod/static_lod.h"

namespace trimtab::test {

/// A synthetic terrain with static trees on the same posts: leaves are its finest level, triangle for
/// triangle; a node above them is a fan from its middle post to every post of its border, which is what
/// document E keeps.
class TreeTerrain final : public terrain::Database {
 public:
  static constexpr int kLeafCells = 8;

  explicit TreeTerrain(std::shared_ptr<const SyntheticTerrain> ground) : ground_(std::move(ground)) {
    auto trees = std::make_shared<terrain::StaticLodTerrain>();
    trees->index.frame = ground_->index().frame;
    trees->materials = {"Grass"};
    const int tiles = (ground_->posts() - 1) / kCells;
    for (int row = 0; row < tiles; ++row)
      for (int column = 0; column < tiles; ++column) addTile(*trees, column * kCells, row * kCells);
    trees_ = std::move(trees);
  }

  const terrain::TerrainInfo& info() const override { return ground_->info(); }
  const TerrainIndex& index() const override { return ground_->index(); }
  void buildTile(std::uint32_t node, terrain::TileMesh& mesh) const override {
    ground_->buildTile(node, mesh);
  }
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    return ground_->heightAt(latitude, longitude);
  }
  std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres radius) const override {
    return ground_->highestWithin(latitude, longitude, radius);
  }
  std::shared_ptr<const terrain::StaticLodTerrain> staticLod() const override { return trees_; }
  const SyntheticTerrain& surface() const { return *ground_; }

 private:
  static constexpr int kCells = TerrainIndex::kTileCells;

  struct Rectangle {
    int x0, y0, x1, y1;  ///< posts
  };

  struct Builder {
    terrain::StaticLodTerrain& terrain;
    terrain::StaticLodTile& tile;
    const SyntheticTerrain& ground;
    terrain::TileMesh mesh;
    Rectangle whole;
    std::map<std::pair<int, int>, std::uint32_t> vertexAt;

    std::uint32_t vertex(int x, int y) {
      const auto [at, fresh] = vertexAt.try_emplace({x, y}, static_cast<std::uint32_t>(tile.vertices.size()));
      if (!fresh) return at->second;
      const terrain::TileVertex& v =
          mesh.vertices[static_cast<std::size_t>((y - whole.y0) * terrain::TileMesh::kSide + x - whole.x0)];
      tile.vertices.push_back({v.x,
                               v.y,
                               v.z,
                               {v.normal[0], v.normal[1], v.normal[2]},
                               0,
                               {v.colour[0], v.colour[1], v.colour[2], 255}});
      return at->second;
    }
    /// `borders`: bit i, the edge from corner i to the next lies on the node's border.
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, unsigned borders) {
      tile.indices.insert(tile.indices.end(), {a, b, c});
      tile.locked.push_back(static_cast<std::uint8_t>(borders));
      tile.material.push_back(0);
    }
    void full(const Rectangle& r) {
      for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) {
          const std::uint32_t sw = vertex(x, y), se = vertex(x + 1, y), nw = vertex(x, y + 1),
                              ne = vertex(x + 1, y + 1);
          const unsigned south = y == r.y0, north = y + 1 == r.y1, west = x == r.x0, east = x + 1 == r.x1;
          if ((x + y) % 2 == 0) {
            triangle(sw, se, ne, south | east << 1);
            triangle(sw, ne, nw, north << 1 | west << 2);
          } else {
            triangle(sw, se, nw, south | west << 2);
            triangle(se, ne, nw, east | north << 1);
          }
        }
    }
    void fan(const Rectangle& r) {
      const std::uint32_t middle = vertex((r.x0 + r.x1) / 2, (r.y0 + r.y1) / 2);
      for (int x = r.x0; x < r.x1; ++x) {
        triangle(vertex(x, r.y0), vertex(x + 1, r.y0), middle, 1);
        triangle(vertex(x + 1, r.y1), vertex(x, r.y1), middle, 1);
      }
      for (int y = r.y0; y < r.y1; ++y) {
        triangle(vertex(r.x1, y), vertex(r.x1, y + 1), middle, 1);
        triangle(vertex(r.x0, y + 1), vertex(r.x0, y), middle, 1);
      }
    }
    std::uint32_t node(const Rectangle& r, std::uint32_t tileNumber, int depth) {
      StaticLodIndex& index = terrain.index;
      const auto self = static_cast<std::uint32_t>(index.size());
      index.nodes.push_back({{}, tileNumber, 0, static_cast<std::uint8_t>(depth), false});
      index.bounds.push_back(kNoBox);
      index.rmsErrorM.push_back(0);
      index.maxErrorM.push_back(0);
      index.borderErrorM.push_back(0);
      index.slopeMax.push_back(1e3f);
      const auto first = static_cast<std::uint32_t>(tile.indices.size() / 3);
      const bool leaf = r.x1 - r.x0 <= kLeafCells && r.y1 - r.y0 <= kLeafCells;
      leaf ? full(r) : fan(r);
      const auto count = static_cast<std::uint32_t>(tile.indices.size() / 3) - first;
      index.nodes[self].triangles = count;
      terrain.ranges.push_back({first, count});
      for (int y = r.y0; y <= r.y1; ++y)
        for (int x = r.x0; x <= r.x1; ++x) {
          const Vec3 p = ground.post(x, y);
          index.bounds[self] = united(index.bounds[self], around(p));
        }
      if (leaf) return self;
      Rectangle low = r, high = r;
      if (r.x1 - r.x0 >= r.y1 - r.y0)
        low.x1 = high.x0 = (r.x0 + r.x1) / 2;
      else
        low.y1 = high.y0 = (r.y0 + r.y1) / 2;
      const std::uint32_t a = node(low, tileNumber, depth + 1), b = node(high, tileNumber, depth + 1);
      index.nodes[self].children = {a, b};
      // No measure, but monotone, and larger where the ground is steeper: what a distance needs.
      const Box& box = index.bounds[self];
      index.rmsErrorM[self] =
          std::max({index.rmsErrorM[a], index.rmsErrorM[b], 0.1f * (box.maxZ - box.minZ)});
      index.maxErrorM[self] = 3 * index.rmsErrorM[self];
      return self;
    }
  };

  void addTile(terrain::StaticLodTerrain& trees, int x, int y) {
    const auto number = static_cast<std::uint32_t>(trees.tiles.size());
    terrain::StaticLodTile tile;
    tile.name = std::to_string(number);
    Builder builder{trees, tile, *ground_, {}, {x, y, x + kCells, y + kCells}, {}};
    const TerrainIndex::Level& finest = index().levels.front();
    ground_->buildTile(finest.firstNode + static_cast<std::uint32_t>(y / kCells) * finest.columns +
                           static_cast<std::uint32_t>(x / kCells),
                       builder.mesh);
    std::copy_n(builder.mesh.origin, 3, tile.origin);
    trees.index.roots.push_back(builder.node(builder.whole, number, 0));
    trees.tiles.push_back(std::move(tile));
  }

  std::shared_ptr<const SyntheticTerrain> ground_;
  std::shared_ptr<const terrain::StaticLodTerrain> trees_;
};

}  // namespace trimtab::test
