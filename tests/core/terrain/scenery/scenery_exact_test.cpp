#include <GeographicLib/Geocentric.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "plain_btg.h"
#include "scenery_tiles.h"

/// Every tile of the four sets, held against its file: each place to the bit, and the ground of its bucket.
namespace trimtab {
namespace {

namespace fs = std::filesystem;
using terrain::SceneryMesh;

struct Tile {
  fs::path file;
  test::PlainBtg plain;
  bool airport = false;
  std::vector<std::array<double, 3>> places;  ///< longitude, latitude, height by GeographicLib
};

std::vector<Tile> tilesOf(const char* folder) {
  std::vector<Tile> tiles;
  const auto files = terrain::sceneryFiles(test::sharedDir() / "data" / folder);
  for (const fs::path& file : *files) {
    if (file.extension() == ".stg") continue;
    Tile tile;
    tile.file = file;
    const std::string bytes = test::readFile(file), name = file.filename().string();
    tile.plain = test::decodedPlainly(file.extension() == ".gz" ? *terrain::gunzip(bytes, "") : bytes);
    tile.airport = name.find_first_not_of("0123456789") != name.find('.');
    for (std::size_t v = 0; v < tile.plain.offsets.size(); ++v) {
      const auto p = tile.plain.place(v);
      std::array<double, 3> g;
      GeographicLib::Geocentric::WGS84().Reverse(p[0], p[1], p[2], g[1], g[0], g[2]);
      tile.places.push_back(g);
    }
    tiles.push_back(std::move(tile));
  }
  return tiles;
}

/// A corner's longitude, latitude and height.
using Corner = std::array<double, 3>;

/// Square degrees from above. A triangle that the file has again counts once, and so do lines painted on
/// pavement.
double areaOf(const Tile& tile) {
  std::set<std::array<Corner, 3>> seen;
  double area = 0;
  for (const auto& t : tile.plain.triangles) {
    if (t.material.starts_with("lf_")) continue;
    std::array<Corner, 3> c{tile.places[t.vertex[0]], tile.places[t.vertex[1]], tile.places[t.vertex[2]]};
    const double signedArea =
        ((c[1][0] - c[0][0]) * (c[2][1] - c[0][1]) - (c[2][0] - c[0][0]) * (c[1][1] - c[0][1])) / 2;
    std::sort(c.begin(), c.end());
    if (seen.insert(c).second) area += signedArea;
  }
  return area;
}

struct Set {
  const char* folder;
  std::size_t tilesWithTheirAirports;
  std::size_t openHoles;  ///< whose airports are not in the set
};
struct ExactScenery : testing::TestWithParam<Set> {};

/// Kansai has one airport twice: as pavement, and as the lawn below it. Cologne has one that is of another
/// year than its tile, and leaves a ninth of its hole open.
bool isNoFilling(const fs::path& airport) {
  return airport.filename() == "RJBM2.btg.gz" || airport.filename() == "EDKB.btg.gz";
}

TEST_P(ExactScenery, hasEveryPlaceOfTheFileToTheBit) {
  TRIMTAB_NEEDS_SHARED(std::string("data/") + GetParam().folder);
  for (const Tile& tile : tilesOf(GetParam().folder)) {
    const auto read = terrain::readBtg(tile.file);
    ASSERT_TRUE(read) << toString(read.findings());
    const SceneryMesh& mesh = *read;
    EXPECT_EQ(mesh.trianglesInFile, tile.plain.trianglesInFile) << tile.file;
    EXPECT_EQ(mesh.degenerate, tile.plain.degenerate) << tile.file;
    ASSERT_EQ(mesh.triangles.size(), tile.plain.triangles.size()) << tile.file;
    ASSERT_EQ(mesh.vertices.size(), tile.plain.offsets.size()) << tile.file;
    std::size_t wrong = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const Vec3& p = mesh.vertices[v];
      wrong += std::array<double, 3>{p.x, p.y, p.z} != tile.plain.place(v);
      const GeodeticPosition g = toGeodetic(p);
      wrong += std::abs(g.height.value() - tile.places[v][2]) > 1e-6 ||
               std::abs(g.longitude.value() - tile.places[v][0]) > 1e-11 ||
               std::abs(g.latitude.value() - tile.places[v][1]) > 1e-11;
    }
    EXPECT_EQ(wrong, 0U) << tile.file;
    wrong = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      std::array<std::uint64_t, 3> ours;
      std::copy_n(mesh.triangles[t].vertex.begin(), 3, ours.begin());
      auto theirs = tile.plain.triangles[t].vertex;
      std::sort(ours.begin(), ours.end());
      std::sort(theirs.begin(), theirs.end());
      wrong +=
          ours != theirs || mesh.materials[mesh.triangles[t].material] != tile.plain.triangles[t].material;
    }
    EXPECT_EQ(wrong, 0U) << tile.file;
  }
}

/// Holes of a tile: components of the edges that one triangle alone has, but for those on the bucket's
/// border.
constexpr double kLeastHole = 3e-9;  ///< 30 m^2: below are cracks between two of a tile's triangles
struct Hole {
  double area = 0;  ///< square degrees
  double west = 180, south = 90, east = -180, north = -90;
};
std::vector<Hole> holesOf(const Tile& tile, const terrain::Bucket& bucket) {
  std::map<std::array<std::uint64_t, 2>, int> open;
  for (const auto& t : tile.plain.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = t.vertex[k], b = t.vertex[(k + 1) % 3];
      if (a < b)
        ++open[{a, b}];
      else
        --open[{b, a}];
    }
  const auto onBorder = [&](std::uint64_t a, std::uint64_t b) {
    const Corner &p = tile.places[a], &q = tile.places[b];
    const auto both = [&](std::size_t axis, double line) {
      return std::abs(p[axis] - line) < 1e-6 && std::abs(q[axis] - line) < 1e-6;
    };
    return both(0, bucket.west.value()) || both(0, bucket.east.value()) || both(1, bucket.south.value()) ||
           both(1, bucket.north.value());
  };
  std::map<std::uint64_t, std::uint64_t> group;
  const auto root = [&](std::uint64_t v) {
    group.try_emplace(v, v);
    while (group[v] != v) v = group[v];
    return v;
  };
  std::vector<std::array<std::uint64_t, 2>> edges;  // as the tile's triangles go: a hole on their right
  for (const auto& [edge, count] : open) {
    if (count == 0 || onBorder(edge[0], edge[1])) continue;
    for (int i = 0; i < std::abs(count); ++i)
      edges.push_back(count > 0 ? edge : std::array{edge[1], edge[0]});
    group[root(edge[0])] = root(edge[1]);
  }
  std::map<std::uint64_t, Hole> holes;
  for (const auto& [a, b] : edges) {
    const Corner &from = tile.places[root(a)], &p = tile.places[a], &q = tile.places[b];
    Hole& hole = holes[root(a)];
    hole.area -= ((p[0] - from[0]) * (q[1] - from[1]) - (q[0] - from[0]) * (p[1] - from[1])) / 2;
    hole.west = std::min(hole.west, p[0]), hole.east = std::max(hole.east, p[0]);
    hole.south = std::min(hole.south, p[1]), hole.north = std::max(hole.north, p[1]);
  }
  std::vector<Hole> all;
  for (auto& [v, hole] : holes) all.push_back(std::move(hole));
  return all;
}

/// Tiles that share an airport count together: its ground is a hole in each of them. Holes whose airports
/// the set does not have count by their outline; so many there are.
TEST_P(ExactScenery, coversTheGroundOfItsBuckets) {
  TRIMTAB_NEEDS_SHARED(std::string("data/") + GetParam().folder);
  const std::vector<Tile> tiles = tilesOf(GetParam().folder);
  std::map<long, std::size_t> ofBucket;
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (!tiles[i].airport) ofBucket[std::stol(tiles[i].file.filename().string())] = i;
  std::vector<std::size_t> group(tiles.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (group[i] != i) i = group[i];
    return i;
  };
  std::vector<Corner> airports;
  std::map<std::size_t, std::array<double, 2>> sums;  // covered, due
  std::map<std::size_t, std::string> names;
  std::size_t absent = 0;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (!tiles[i].airport) continue;
    if (isNoFilling(tiles[i].file)) continue;
    for (const Corner& p : tiles[i].places) {
      airports.push_back(p);
      const auto under = ofBucket.find(terrain::bucketAt(Degrees{p[1]}, Degrees{p[0]}).index);
      if (under == ofBucket.end()) continue;
      group[root(under->second)] = root(i);
    }
  }
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (isNoFilling(tiles[i].file)) continue;
    auto& [ground, due] = sums[root(i)];
    names[root(i)] += " " + tiles[i].file.filename().string();
    ground += areaOf(tiles[i]);
    if (tiles[i].airport) continue;
    const auto bucket = terrain::bucketOf(std::stol(tiles[i].file.filename().string()));
    due += (bucket.east - bucket.west).value() * (bucket.north - bucket.south).value();
    for (const Hole& hole : holesOf(tiles[i], bucket)) {
      const bool filled = std::any_of(airports.begin(), airports.end(), [&](const Corner& p) {
        return p[0] > hole.west && p[0] < hole.east && p[1] > hole.south && p[1] < hole.north;
      });
      if (filled || !(hole.area > kLeastHole)) continue;
      ++absent;
      ground += hole.area;
    }
  }
  std::size_t covered = 0;
  for (const auto& [i, sum] : sums) {
    if (sum[1] == 0) continue;  // an airport whose tile is not there
    ++covered;
    EXPECT_NEAR(sum[0] / sum[1], 1, 1e-4) << names[i];
  }
  EXPECT_EQ(covered, GetParam().tilesWithTheirAirports);
  EXPECT_EQ(absent, GetParam().openHoles);
}

INSTANTIATE_TEST_SUITE_P(Sets, ExactScenery,
                         testing::Values(Set{"fg-cologne", 3, 3}, Set{"fg-debian-hawaii-bigisland", 67, 1},
                                         Set{"fg-debian-iceland-reykjanes", 21, 5},
                                         Set{"fg-kansai-e135n35", 25, 0}),
                         [](const auto& set) {
                           std::string name = set.param.folder;
                           std::erase_if(name,
                                         [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

}  // namespace
}  // namespace trimtab
