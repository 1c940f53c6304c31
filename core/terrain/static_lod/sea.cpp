#include "trimtab/terrain/static_lod/sea.h"
#include "trimtab/frame/box_union.h"
#include "trimtab/terrain/format/static_lod_terrain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace trimtab::terrain {
namespace {

/// A bucket's cells a side: 1.4 km at most, whose middle lies 4 cm below the sphere.
constexpr int kCells = 16;
constexpr double kApronDegrees = 0.0015, kApronM = 12;
constexpr int kSamples = 9;

std::vector<Bucket> openSea(std::span<const SceneryMesh> tiles, const HeightSource& heights) {
  std::set<std::string> there;
  for (const SceneryMesh& tile : tiles) there.insert(tile.name);
  const PostGrid& posts = heights.posts();
  const double east = posts.longitude(posts.columns - 1), north = posts.latitude(posts.rows - 1);
  const auto isSea = [&](const Bucket& b) {
    for (int y = 0; y < kSamples; ++y)
      for (int x = 0; x < kSamples; ++x) {
        const auto within = [](double low, double high, int i) {
          return low + (high - low) * (i + 0.5) / kSamples;
        };
        const double column = (within(b.west.value(), b.east.value(), x) - posts.west) / posts.stepLongitude,
                     row = (within(b.south.value(), b.north.value(), y) - posts.south) / posts.stepLatitude;
        if (!(column >= 0 && row >= 0 && column <= posts.columns - 1 && row <= posts.rows - 1)) return false;
        float height = 0;
        heights.read({static_cast<std::uint32_t>(std::lround(column)),
                      static_cast<std::uint32_t>(std::lround(row)), 1, 1},
                     1, {&height, 1});
        if (height != 0) return false;
      }
    return true;
  };
  std::vector<Bucket> sea;
  for (double latitude = posts.south + 1.0 / 16; latitude < north; latitude += 0.125)
    for (double longitude = posts.west + 1e-6; longitude < east;) {
      const Bucket bucket = bucketNear(Degrees{latitude}, Degrees{longitude});
      const double width = (bucket.east - bucket.west).value();
      if (bucket.index < 0 || !(width > 0)) break;
      if (!there.contains(std::to_string(bucket.index)) && isSea(bucket)) sea.push_back(bucket);
      longitude += width;
    }
  return sea;
}

void append(StaticLodTerrain& trees, const Bucket& bucket, std::uint16_t material) {
  constexpr int kPoints = kCells + 3;  // the apron's ring with it
  const LocalFrame& frame = trees.index.frame;
  const auto place = [&](int column, int row) {
    const auto along = [](double low, double high, int i) {
      if (i == 0) return low - kApronDegrees;
      if (i == kPoints - 1) return high + kApronDegrees;
      return low + (high - low) * (i - 1) / kCells;
    };
    const bool apron = column == 0 || row == 0 || column == kPoints - 1 || row == kPoints - 1;
    return frame.fromGeodetic({Degrees{along(bucket.south.value(), bucket.north.value(), row)},
                               Degrees{along(bucket.west.value(), bucket.east.value(), column)},
                               Metres{apron ? -kApronM : 0}});
  };
  StaticLodTile tile;
  tile.name = "sea-" + std::to_string(bucket.index);
  const Vec3 middle = place(kPoints / 2, kPoints / 2);
  const std::array<double, 3> m{middle.x, middle.y, middle.z};
  for (std::size_t i = 0; i < 3; ++i) tile.origin[i] = static_cast<std::int32_t>(std::floor(m[i] / 16));
  const auto colour = materialColour("Ocean");
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Box box = kNoBox;
  for (int row = 0; row < kPoints; ++row)
    for (int column = 0; column < kPoints; ++column) {
      const Vec3 p = place(column, row);
      const auto lattice = [](double x) { return std::round(x * 256) / 256; };
      const Vec3 at{lattice(p.x), lattice(p.y), lattice(p.z)};
      const GeodeticPosition here = frame.toGeodetic(p);
      const Vec3 up = frame.ecefToLocal() * eastNorthUp(here.latitude, here.longitude).row[2];
      const auto unit = [](double x) { return static_cast<std::int8_t>(std::lround(127 * x)); };
      tile.vertices.push_back({static_cast<float>(at.x - 16.0 * tile.origin[0]),
                               static_cast<float>(at.y - 16.0 * tile.origin[1]),
                               static_cast<float>(at.z - 16.0 * tile.origin[2]),
                               {unit(up.x), unit(up.y), unit(up.z)},
                               0,
                               {colour[0], colour[1], colour[2], 255}});
      const auto down = [](double v) { return std::nextafter(static_cast<float>(v), -kFar); };
      const auto upwards = [](double v) { return std::nextafter(static_cast<float>(v), kFar); };
      box = united(box, {down(at.x), down(at.y), down(at.z), upwards(at.x), upwards(at.y), upwards(at.z)});
    }
  for (int row = 0; row + 1 < kPoints; ++row)
    for (int column = 0; column + 1 < kPoints; ++column) {
      const auto sw = static_cast<std::uint32_t>(row * kPoints + column), nw = sw + kPoints;
      const unsigned south = row == 0, west = column == 0, north = row + 2 == kPoints,
                     east = column + 2 == kPoints;
      tile.indices.insert(tile.indices.end(), {sw, sw + 1, nw + 1, sw, nw + 1, nw});
      tile.locked.push_back(static_cast<std::uint8_t>(south | east << 1));
      tile.locked.push_back(static_cast<std::uint8_t>(north << 1 | west << 2));
      tile.material.insert(tile.material.end(), 2, material);
    }
  const auto triangles = static_cast<std::uint32_t>(tile.material.size());
  StaticLodIndex& index = trees.index;
  index.roots.push_back(static_cast<std::uint32_t>(index.size()));
  StaticLodIndex::Node node;
  node.tile = static_cast<std::uint32_t>(trees.tiles.size());
  node.triangles = triangles;
  index.nodes.push_back(node);
  index.bounds.push_back(box);
  index.rmsErrorM.push_back(0);
  index.maxErrorM.push_back(0);
  index.borderErrorM.push_back(0);
  index.slopeMax.push_back(1);
  trees.ranges.push_back({0, triangles});
  trees.counts.distinctFaces += triangles;
  trees.tiles.push_back(std::move(tile));
}

}  // namespace

std::shared_ptr<const StaticLodTerrain> withOpenSea(std::shared_ptr<const StaticLodTerrain> trees,
                                                    std::span<const SceneryMesh> tiles,
                                                    const HeightSource& heights) {
  const std::vector<Bucket> sea = openSea(tiles, heights);
  if (sea.empty()) return trees;
  auto whole = std::make_shared<StaticLodTerrain>(*trees);
  const auto ocean = std::find(whole->materials.begin(), whole->materials.end(), "Ocean");
  const auto material = static_cast<std::uint16_t>(ocean - whole->materials.begin());
  if (ocean == whole->materials.end()) whole->materials.push_back("Ocean");
  for (const Bucket& bucket : sea) append(*whole, bucket, material);
  countStaticLod(*whole);
  return whole;
}

}  // namespace trimtab::terrain
