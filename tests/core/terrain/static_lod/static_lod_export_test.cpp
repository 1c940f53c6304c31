#include "trimtab/terrain/static_lod/export.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "static_lod_support.h"
#include "tests/support.h"
#include "trimtab/terrain/static_lod/error.h"
#include "trimtab/terrain/static_lod/level.h"

namespace trimtab::terrain {
namespace {

namespace fs = std::filesystem;

/// A triangle by the lattice places of its corners, the smallest first, and its material's name.
using Face = std::pair<std::array<Lattice, 3>, std::string>;

Face faceOf(std::array<Lattice, 3> corners, const std::string& material) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return {corners, material};
}

LatticeSurface surfaceOf(const SceneryMesh& mesh, const LocalFrame& frame) {
  LatticeSurface surface;
  const auto step = [](double metres) { return static_cast<std::int32_t>(std::lround(metres * 256)); };
  for (const Vec3 v : mesh.vertices) {
    const Vec3 p = frame.fromEcef(v);
    surface.vertices.push_back({step(p.x), step(p.y), step(p.z)});
  }
  for (const SceneryMesh::Triangle& t : mesh.triangles) {
    surface.triangles.push_back(t.vertex);
    surface.material.push_back(t.material);
  }
  return surface;
}

std::multiset<Face> facesOf(const LatticeSurface& surface, const std::vector<std::string>& materials) {
  std::multiset<Face> faces;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& t = surface.triangles[i];
    faces.insert(faceOf({surface.vertices[t[0]], surface.vertices[t[1]], surface.vertices[t[2]]},
                        materials[surface.material[i]]));
  }
  return faces;
}

/// The largest vertical distance of the vertices of one surface from another that lies above or below them.
double furthest(const LatticeSurface& from, const LatticeSurface& to) {
  const VerticalDistance distance(to.vertices, to.triangles);
  double worst = 0;
  for (const Lattice& p : from.vertices)
    if (const auto d = distance.metres(p, 0, static_cast<std::uint32_t>(to.triangles.size())))
      worst = std::max(worst, *d);
  return worst;
}

std::shared_ptr<const StaticLodTerrain> treesOf(const std::vector<SceneryMesh>& tiles, std::uint32_t n) {
  Vec3 middle{};
  for (const SceneryMesh& tile : tiles)
    middle = middle + tile.vertices.front() * (1 / static_cast<double>(tiles.size()));
  GeodeticPosition origin = toGeodetic(middle);
  origin.height = Metres{0};
  const auto built = buildStaticLod(tiles, LocalFrame(origin), {n, {}, false});
  EXPECT_TRUE(built) << toString(built.findings());
  return built ? *built : nullptr;
}

/// Writes the level, reads it back with the reader of scenery, and expects the level's own triangles.
Scenery expectReadBack(const StaticLodTerrain& trees, std::uint32_t level, const fs::path& output) {
  const auto done = exportScenery(trees, {level, output, {}}, "trees");
  EXPECT_TRUE(done) << toString(done.findings());
  auto read = readScenery(output);
  EXPECT_TRUE(read) << toString(read.findings());
  if (!done || !read) return {};
  EXPECT_TRUE(read.findings().empty()) << toString(read.findings());
  EXPECT_EQ(done->tiles + done->airports, read->tiles.size());
  EXPECT_EQ(read->tiles.size() + done->seas, trees.tiles.size());
  std::uint64_t triangles = 0;
  for (const SceneryMesh& mesh : read->tiles) {
    const auto tile = std::find_if(trees.tiles.begin(), trees.tiles.end(),
                                   [&](const StaticLodTile& t) { return t.name == mesh.name; });
    if (tile == trees.tiles.end()) {
      ADD_FAILURE() << mesh.name << " is no tile of the trees";
      continue;
    }
    const auto index = static_cast<std::size_t>(tile - trees.tiles.begin());
    const LatticeSurface ours = surfaceOfLevel(trees, index, level),
                         theirs = surfaceOf(mesh, trees.index.frame);
    EXPECT_TRUE(facesOf(ours, trees.materials) == facesOf(theirs, mesh.materials)) << mesh.name;
    EXPECT_EQ(mesh.degenerate, 0u) << mesh.name;
    triangles += mesh.triangles.size();

    const LatticeSurface source = surfaceOfLevel(trees, index, 0xffffffffu);
    double stated = 0;
    for (const std::uint32_t node : nodesOfLevel(trees, index, level))
      stated = std::max(stated, double{trees.index.maxErrorM[node]});
    EXPECT_LE(furthest(source, theirs), stated + 1e-6) << mesh.name;
    EXPECT_LE(furthest(theirs, source), stated + 1e-6) << mesh.name;
    EXPECT_LE(stated, done->maxErrorM) << mesh.name;
  }
  EXPECT_EQ(done->triangles, triangles);
  return std::move(read.value());
}

/// A bucket's tile with a hole in which an airport lies, both of their own names.
std::vector<SceneryMesh> tileWithAirport() {
  const auto inside = [](std::uint32_t c, std::uint32_t r) { return c >= 15 && c < 25 && r >= 10 && r < 20; };
  test::TinOptions land, airport;
  land.hole = inside;
  airport.hole = [inside](std::uint32_t c, std::uint32_t r) { return !inside(c, r); };
  airport.jitter = 0.2;
  const long bucket = bucketAt(Degrees{36.001}, Degrees{128.001}).index;
  return {test::tin(std::to_string(bucket), land), test::tin("EDNY", airport)};
}

TEST(StaticLodExport, writesTheTrianglesOfEachLevelWithTheirMaterials) {
  const std::vector<SceneryMesh> tiles = tileWithAirport();
  const auto trees = treesOf(tiles, 200);
  ASSERT_TRUE(trees);
  ASSERT_GT(trees->counts.levels, 2u);
  const test::ScratchDir dir;
  for (std::uint32_t level = 0; level < trees->counts.levels; ++level) {
    const fs::path output = dir / std::to_string(level);
    const Scenery read = expectReadBack(*trees, level, output);
    ASSERT_EQ(read.tiles.size(), 2u);
    EXPECT_FALSE(read.tiles[0].airport);
    EXPECT_TRUE(read.tiles[1].airport);
    EXPECT_EQ(read.tiles[0].version, 7);
    const std::string name = tiles[0].name;
    EXPECT_EQ(test::readFile(output / "Terrain/e120n30/e128n36" / (name + ".stg")),
              "OBJECT_BASE " + name + ".btg\nOBJECT EDNY.btg\n");
  }
}

TEST(StaticLodExport, writesTheSameBytesAgain) {
  const auto trees = treesOf(tileWithAirport(), 200);
  ASSERT_TRUE(trees);
  const test::ScratchDir dir;
  const pid_t child = ::fork();
  if (child == 0) {
    // Killed after its first tile.
    const auto kill = [](double done, const std::string&) {
      return done == 0 || ::kill(::getpid(), SIGKILL) != 0;
    };
    static_cast<void>(exportScenery(*trees, {1, dir / "a", kill}, "trees"));
    ::_exit(1);
  }
  ::waitpid(child, nullptr, 0);
  ASSERT_EQ(test::namesIn(dir.path()).size(), 2u) << "a folder and its mark";
  for (const char* name : {"a", "b/"})
    ASSERT_TRUE(exportScenery(*trees, {1, dir / name, {}}, "trees")) << name;
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(dir / "a")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    const fs::path other = (dir / "b") / fs::relative(entry.path(), dir / "a").string();
    EXPECT_EQ(test::readFile(entry.path()), test::readFile(other)) << other;
  }
  EXPECT_EQ(files, 3u);
  EXPECT_EQ(std::distance(fs::directory_iterator(dir.path()), fs::directory_iterator()), 2)
      << "litter is taken away";
}

TEST(StaticLodExport, usesWideIndicesForTilesOfManyVertices) {
  test::TinOptions options;
  options.columns = options.rows = 260;
  const SceneryMesh mesh = test::tin("3072816", options);
  ASSERT_GT(mesh.vertices.size(), 0xffffu);
  BtgSurface surface{mesh, {}, textureByPlace(mesh.vertices)};
  surface.normals.assign(mesh.vertices.size(), {0, 0, 1});
  const std::string bytes = btgBytes(surface);
  const auto zipped = gunzip(gzip(bytes), "zipped");
  ASSERT_TRUE(zipped);
  EXPECT_EQ(*zipped, bytes);
  const auto read = parseBtg(bytes, "3072816.btg");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ(read->version, 10);
  ASSERT_EQ(read->vertices.size(), mesh.vertices.size());
  EXPECT_EQ(read->triangles.size(), mesh.triangles.size());
  double worst = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    worst = std::max(worst, length(read->vertices[i] - mesh.vertices[i]));
  EXPECT_LT(worst, 0.001);
}

TEST(StaticLodExport, hasOneTextureUnitForEachKilometre) {
  const LocalFrame frame({Degrees{36.5}, Degrees{128.5}, Metres{0}});
  const auto texture =
      textureByPlace({frame.toEcef({0, 0, 0}), frame.toEcef({1000, 0, 0}), frame.toEcef({0, 1000, 0})});
  EXPECT_NEAR(texture[1][0] - texture[0][0], 1, 0.01);
  EXPECT_NEAR(texture[1][1] - texture[0][1], 0, 0.01);
  EXPECT_NEAR(texture[2][0] - texture[0][0], 0, 0.01);
  EXPECT_NEAR(texture[2][1] - texture[0][1], 1, 0.01);
}

TEST(StaticLodExport, namesFoldersAsFlightGearDoes) {
  for (const auto& [latitude, longitude, folder] : {std::tuple{50.9, 7.1, "e000n50/e007n50"},
                                                    {35.2, 135.9, "e130n30/e135n35"},
                                                    {-0.5, -0.5, "w010s10/w001s01"},
                                                    {19.5, -155.6, "w160n10/w156n19"},
                                                    {-33.9, 151.2, "e150s40/e151s34"},
                                                    {-10.0, -10.0, "w010s10/w010s10"}})
    EXPECT_EQ(bucketFolder(bucketAt(Degrees{latitude}, Degrees{longitude}).index), folder);
}

TEST(StaticLodExport, refusesWhatItCannotWriteAndLeavesNothing) {
  const std::vector<SceneryMesh> tiles = tileWithAirport();
  const auto trees = treesOf(tiles, 200);
  ASSERT_TRUE(trees);
  const test::ScratchDir dir;
  const auto refused = [&](const StaticLodTerrain& of, const SceneryExport& options,
                           const std::string& said) {
    const auto done = exportScenery(of, options, "db");
    EXPECT_FALSE(done);
    EXPECT_NE(toString(done.findings()).find(said), std::string::npos) << toString(done.findings());
  };
  refused(*trees, {99, dir / "x", {}},
          "db: level: expected 0 to " + std::to_string(trees->counts.levels - 1) + ", found 99");
  refused(*trees, {0, dir / "x", [](double, const std::string&) { return false; }}, "cancelled");
  StaticLodTerrain twice = *trees;
  twice.tiles[1].name = twice.tiles[0].name;
  refused(twice, {0, dir / "x", {}}, "a second tile of this name");
  twice.tiles[1].name = "../EDNY";
  refused(twice, {0, dir / "x", {}}, "found a path");
  EXPECT_TRUE(fs::is_empty(dir.path()));
  test::writeFile(dir / "file", "");
  refused(*trees, {0, dir.path(), {}}, "one that holds something");
  refused(*trees, {0, dir / "file", {}}, "a file");
}

/// The tiles of a set that have airports, and their airports. FlightGear shows no airport in a bucket
/// without a tile.
std::vector<SceneryMesh> someTilesOf(const char* set) {
  const auto list = listScenery(test::sharedDir() / "data" / set);
  EXPECT_TRUE(list);
  std::vector<SceneryMesh> meshes;
  std::set<std::string> buckets;
  const auto read = [&](const SceneryList::File& file) {
    auto mesh = readBtg(file.path);
    EXPECT_TRUE(mesh) << toString(mesh.findings());
    meshes.push_back(std::move(mesh.value()));
    meshes.back().airport = file.airport;
  };
  for (const SceneryList::File& file : list->files) {
    if (!file.airport) continue;
    read(file);
    const GeodeticPosition place = toGeodetic(meshes.back().vertices.front());
    buckets.insert(std::to_string(bucketAt(place.latitude, place.longitude).index) + ".btg.gz");
  }
  for (const SceneryList::File& file : list->files)
    if (buckets.count(file.path.filename().string()) > 0) read(file);
  EXPECT_GT(meshes.size(), buckets.size());
  return meshes;
}

struct RealExport : testing::TestWithParam<const char*> {};

TEST_P(RealExport, readsBackAsTheLevelWithinItsStatedError) {
  TRIMTAB_NEEDS_SHARED(std::string("data/") + GetParam());
  const auto trees = treesOf(someTilesOf(GetParam()), 2000);
  ASSERT_TRUE(trees);
  const test::ScratchDir dir;
  for (const std::uint32_t level : {0u, 2u}) expectReadBack(*trees, level, dir / std::to_string(level));
}

/// The height above the ellipsoid of the highest triangle at a place.
std::optional<double> heightAt(const std::vector<SceneryMesh>& meshes, const GeodeticPosition& place) {
  const Vec3 foot = toEcef({place.latitude, place.longitude, Metres{0}});
  const Vec3 up = eastNorthUp(place.latitude, place.longitude).row[2];
  std::optional<double> highest;
  for (const SceneryMesh& mesh : meshes)
    for (const SceneryMesh::Triangle& t : mesh.triangles) {
      const Vec3 a = mesh.vertices[t.vertex[0]], b = mesh.vertices[t.vertex[1]] - a,
                 c = mesh.vertices[t.vertex[2]] - a, p = cross(up, c), from = foot - a, q = cross(from, b);
      const double scale = dot(b, p);
      if (std::abs(scale) < 1e-9) continue;
      const double u = dot(from, p) / scale, v = dot(up, q) / scale;
      if (u < 0 || v < 0 || u + v > 1) continue;
      const double height = dot(c, q) / scale;
      if (!highest || height > *highest) highest = height;
    }
  return highest;
}

/// FlightGear's own program that says how high the ground of its scenery is; empty if it is not installed.
std::string fgelev() {
  if (const char* named = std::getenv("TRIMTAB_FGELEV")) return named;
  if (test::run("command -v fgelev").exitCode == 0) return "fgelev";
  return fs::exists("/usr/games/fgelev") ? "/usr/games/fgelev" : "";
}

TEST_P(RealExport, hasTheSameHeightsInFlightGear) {
  TRIMTAB_NEEDS_SHARED(std::string("data/") + GetParam());
  const std::string program = fgelev();
  if (program.empty()) GTEST_SKIP() << "needs fgelev, of FlightGear (or its path in TRIMTAB_FGELEV)";
  const std::vector<SceneryMesh> source = someTilesOf(GetParam());
  const auto trees = treesOf(source, 2000);
  ASSERT_TRUE(trees);
  const test::ScratchDir dir;
  // It asks for settings and materials; heights need none of them.
  fs::create_directories(dir / "root/Materials/default");
  for (const char* file : {"root/defaults.xml", "root/Materials/default/materials.xml"})
    test::writeFile(dir / file, "<?xml version=\"1.0\"?><PropertyList/>");

  std::mt19937 random(7);
  std::vector<GeodeticPosition> places;
  std::string asked;
  for (const SceneryMesh& mesh : source)
    for (int i = 0; i < 20; ++i) {
      const auto& t = mesh.triangles[random() % mesh.triangles.size()].vertex;
      const Vec3 sum = mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]];
      places.push_back(toGeodetic(sum * (1.0 / 3)));
      char line[96];
      std::snprintf(line, sizeof line, "%zu %.9f %.9f\n", places.size() - 1, places.back().longitude.value(),
                    places.back().latitude.value());
      asked += line;
    }
  test::writeFile(dir / "places", asked);

  for (const std::uint32_t level : {0u, 2u}) {
    const fs::path output = dir / std::to_string(level);
    const auto done = exportScenery(*trees, {level, output, {}}, "trees");
    ASSERT_TRUE(done) << toString(done.findings());
    std::vector<SceneryMesh> drawn;
    for (std::size_t i = 0; i < trees->tiles.size(); ++i) {
      const LatticeSurface surface = surfaceOfLevel(*trees, i, level);
      SceneryMesh& mesh = drawn.emplace_back();
      for (const Lattice& p : surface.vertices)
        mesh.vertices.push_back(trees->index.frame.toEcef(p.metres()));
      for (const auto& t : surface.triangles) mesh.triangles.push_back({t, 0});
    }
    const test::Ran ran = test::run(program + " --fg-root " + (dir / "root").string() + " --fg-scenery " +
                                    output.string() + " < " + (dir / "places").string());
    // It exits with 1 at the end of its input, so only its answers say whether it read the scenery.
    std::map<std::size_t, double> heights;
    std::istringstream answers(ran.out);
    for (std::string line; std::getline(answers, line);) {
      std::size_t number = 0;
      double height = 0;
      if (std::sscanf(line.c_str(), "%zu: %lf", &number, &height) == 2) heights[number] = height;
    }
    ASSERT_EQ(heights.size(), places.size()) << ran.out << ran.err;
    double worstOfLevel = 0, worstOfSource = 0;
    for (const auto& [number, height] : heights) {
      const auto ofLevel = heightAt(drawn, places[number]), ofSource = heightAt(source, places[number]);
      ASSERT_TRUE(ofLevel && ofSource) << number;
      worstOfLevel = std::max(worstOfLevel, std::abs(height - *ofLevel));
      worstOfSource = std::max(worstOfSource, std::abs(height - *ofSource));
    }
    // Over the original files, at the same places, its answers are up to 0.1 m from the exact ones: it looks
    // for the ground with floats.
    constexpr double kOfFgelevM = 0.25;
    EXPECT_LT(worstOfLevel, kOfFgelevM);
    EXPECT_LE(worstOfSource, done->maxErrorM + kOfFgelevM);
    std::printf(
        "%s, level %u, %zu places: fgelev within %.4f m of the level and %.3f m of the source; stated %.3f "
        "m\n",
        GetParam(), level, places.size(), worstOfLevel, worstOfSource, done->maxErrorM);
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, RealExport, testing::Values("fg-cologne", "fg-kansai-e135n35"),
                         [](const auto& set) {
                           std::string name = set.param;
                           std::erase_if(name,
                                         [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
                           return name;
                         });

}  // namespace
}  // namespace trimtab::terrain
