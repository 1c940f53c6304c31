#include <cstring>
#include <functional>

#include "object_support.h"
#include "tests/support.h"
#include "trimtab/terrain/format/store.h"

namespace trimtab::terrain {
namespace {

template <class T>
std::string bytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

TEST(ObjectFile, bringsBackWhatWasWritten) {
  const test::ScratchDir dir;
  for (const bool textured : {false, true}) {
    const ObjectTerrain a = test::smallObjects(textured);
    const auto sum = writeObjects(dir / "objects", a);
    ASSERT_TRUE(sum);
    const auto read = readObjects(dir / "objects", hexadecimal(*sum));
    ASSERT_TRUE(read) << toString(read.findings());
    const ObjectTerrain& b = **read;
    EXPECT_EQ(a.index.frame.origin(), b.index.frame.origin());
    EXPECT_EQ(bytesOf(a.index.levels), bytesOf(b.index.levels));
    EXPECT_EQ(bytesOf(a.index.models), bytesOf(b.index.models));
    EXPECT_EQ(bytesOf(a.index.cells), bytesOf(b.index.cells));
    EXPECT_EQ(bytesOf(a.index.instances), bytesOf(b.index.instances));
    EXPECT_EQ(a.names, b.names);
    EXPECT_EQ(bytesOf(a.meshes), bytesOf(b.meshes));
    EXPECT_EQ(bytesOf(a.vertices), bytesOf(b.vertices));
    EXPECT_EQ(a.indices, b.indices);
    EXPECT_EQ(bytesOf(a.lights.cells), bytesOf(b.lights.cells));
    EXPECT_EQ(bytesOf(a.lights.points), bytesOf(b.lights.points));
    ASSERT_EQ(a.textures.size(), b.textures.size());
    if (textured) {
      EXPECT_EQ(a.textures[0].pixels, b.textures[0].pixels);
    }
    EXPECT_FALSE(readObjects(dir / "objects", hexadecimal(*sum + 1)));
  }
}

TEST(ObjectFile, countsWhatIsDrawnAtMostAndAtLeast) {
  const ObjectCounts counts = countObjects(test::smallObjects(true));
  EXPECT_EQ(counts.models, 2u);
  EXPECT_EQ(counts.levels, 3u);
  EXPECT_EQ(counts.instances, 5u);
  EXPECT_EQ(counts.textures, 1u);
  EXPECT_EQ(counts.triangles, 4u);
  EXPECT_EQ(counts.finestTriangles, 3u * 2 + 2 * 1);
  EXPECT_EQ(counts.coarsestTriangles, 5u);
  EXPECT_EQ(counts.lights, 3u);
}

TEST(ObjectFile, refusesEveryFlippedByteAndEveryCut) {
  const test::ScratchDir dir;
  ASSERT_TRUE(writeObjects(dir / "objects", test::smallObjects(false)));
  const std::string whole = test::readFile(dir / "objects");
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string bytes = whole;
    bytes[i] = static_cast<char>(bytes[i] ^ (1 << (i % 8)));
    test::writeFile(dir / "flipped", bytes);
    EXPECT_FALSE(readObjects(dir / "flipped")) << "byte " << i;
    test::writeFile(dir / "cut", whole.substr(0, i));
    EXPECT_FALSE(readObjects(dir / "cut")) << "cut at " << i;
  }
  test::writeFile(dir / "longer", whole + "x");
  EXPECT_FALSE(readObjects(dir / "longer"));
  EXPECT_FALSE(readObjects(dir / "absent"));
  EXPECT_FALSE(readObjects(dir.path()));
}

struct Lie {
  const char* fault;
  std::function<void(ObjectTerrain&)> tell;
};

/// One lie a row: the checksum is right, the numbers are not.
const std::vector<Lie> kLies{
    {"names of models", [](ObjectTerrain& o) { o.names.pop_back(); }},
    {"meshes of levels", [](ObjectTerrain& o) { o.meshes.pop_back(); }},
    {"levels of models", [](ObjectTerrain& o) { o.index.models[1].firstLevel = 1; }},
    {"levels of models", [](ObjectTerrain& o) { o.index.models[1].levels = 0; }},
    {"levels of models", [](ObjectTerrain& o) { o.index.models[1].levels = 0xffffffffu; }},
    {"radius of models", [](ObjectTerrain& o) { o.index.models[0].radiusM = NAN; }},
    {"radius of models", [](ObjectTerrain& o) { o.index.models[0].radiusM = 1e9f; }},
    {"errors of levels", [](ObjectTerrain& o) { o.index.levels[1].errorM = 0; }},
    {"errors of levels", [](ObjectTerrain& o) { o.index.levels[2].errorM = 1; }},
    {"errors of levels", [](ObjectTerrain& o) { o.index.levels[1].errorM = INFINITY; }},
    {"parts of meshes", [](ObjectTerrain& o) { o.meshes[1].firstVertex = 0; }},
    {"parts of meshes", [](ObjectTerrain& o) { o.meshes[1].firstIndex = 0xfffffffeu; }},
    {"parts of meshes", [](ObjectTerrain& o) { o.index.levels[2].vertices = 0xffffffffu; }},
    {"parts of meshes", [](ObjectTerrain& o) { o.meshes[0].bothSides = 7; }},
    {"parts of meshes",
     [](ObjectTerrain& o) {
       o.indices.insert(o.indices.end(), {0, 1, 2});
     }},
    {"triangles of levels", [](ObjectTerrain& o) { o.index.levels[0].triangles = 1; }},
    {"indices", [](ObjectTerrain& o) { o.indices[4] = 4; }},
    {"size of textures", [](ObjectTerrain& o) { o.textures[0].pixels.pop_back(); }},
    {"vertices beyond the radius of their model", [](ObjectTerrain& o) { o.vertices[2].z = 4; }},
    {"vertices beyond the radius of their model", [](ObjectTerrain& o) { o.vertices[9].z = NAN; }},
    {"textures of vertices", [](ObjectTerrain& o) { o.vertices[9].texture = 1; }},
    {"places in textures", [](ObjectTerrain& o) { o.vertices[9].place[1] = 0x7c00; }},
    {"models of instances", [](ObjectTerrain& o) { o.index.instances[4].model = 2; }},
    {"places of instances", [](ObjectTerrain& o) { o.index.instances[4].y = INFINITY; }},
    {"turns of instances",
     [](ObjectTerrain& o) {
       o.index.instances[4].turn = {0, 0, 0, 0};
     }},
    {"turns of instances",
     [](ObjectTerrain& o) {
       o.index.instances[4].turn = {9999, 0, 0, 32767};
     }},
    {"scales of instances", [](ObjectTerrain& o) { o.index.instances[4].scale = 0; }},
    {"scales of instances", [](ObjectTerrain& o) { o.index.instances[4].scale = NAN; }},
    {"cells", [](ObjectTerrain& o) { o.index.cells.clear(); }},
    {"root cell", [](ObjectTerrain& o) { o.index.cells[0].end = 2; }},
    {"root cell", [](ObjectTerrain& o) { o.index.cells[0].instances = 4; }},
    {"bounds of cells", [](ObjectTerrain& o) { o.index.cells[1].bounds.minX = 70; }},
    {"bounds of cells", [](ObjectTerrain& o) { o.index.cells[1].bounds.maxZ = INFINITY; }},
    {"origins of cells", [](ObjectTerrain& o) { o.index.cells[1].origin[0] = 1 << 30; }},
    {"radius or error of cells", [](ObjectTerrain& o) { o.index.cells[1].coarsestFromM = -1; }},
    {"ends of cells", [](ObjectTerrain& o) { o.index.cells[1].end = 1; }},
    {"ends of cells", [](ObjectTerrain& o) { o.index.cells[2].end = 9; }},
    {"instances of cells", [](ObjectTerrain& o) { o.index.cells[1].end = 3; }},
    {"instances of cells", [](ObjectTerrain& o) { o.index.cells[1].instances = 1; }},
    {"instances of cells", [](ObjectTerrain& o) { o.index.cells[2].firstInstance = 1; }},
    {"instances of cells", [](ObjectTerrain& o) { o.index.cells[2].instances = 2; }},
    {"instances of cells", [](ObjectTerrain& o) { o.index.cells[2].instances = 0xffffffffu; }},
    {"lights of cells", [](ObjectTerrain& o) { o.lights.cells.pop_back(); }},
    {"lights of cells", [](ObjectTerrain& o) { o.lights.cells[1].first = 1; }},
    {"lights of cells", [](ObjectTerrain& o) { o.lights.cells[1].count = 0; }},
    {"lights of cells", [](ObjectTerrain& o) { o.lights.cells[1].count = 2; }},
    {"lights of cells", [](ObjectTerrain& o) { o.lights.cells[0].count = 0xffffffffu; }},
    {"lights of cells",
     [](ObjectTerrain& o) {
       o.lights.points.insert(o.lights.points.begin(), 255, o.lights.points[0]);
       o.lights.cells[0].count = 257;
       o.lights.cells[1].first = 257;
     }},
    {"bounds of lights", [](ObjectTerrain& o) { o.lights.cells[0].bounds.maxZ = INFINITY; }},
    {"origins of lights", [](ObjectTerrain& o) { o.lights.cells[0].origin[2] = 1 << 30; }},
    {"places of lights", [](ObjectTerrain& o) { o.lights.points[1].y = NAN; }},
    {"places of lights", [](ObjectTerrain& o) { o.lights.points[2].x = 1; }},
    {"places of lights", [](ObjectTerrain& o) { o.lights.cells[1].bounds.minZ = 0.75f; }},
};

TEST(ObjectFile, refusesLiesByName) {
  const test::ScratchDir dir;
  for (const Lie& lie : kLies) {
    ObjectTerrain objects = test::smallObjects(true);
    lie.tell(objects);
    ASSERT_TRUE(writeObjects(dir / "objects", objects));
    const auto read = readObjects(dir / "objects");
    ASSERT_FALSE(read) << lie.fault;
    ASSERT_EQ(read.findings().size(), 1u);
    EXPECT_EQ(read.findings()[0].key, lie.fault) << "in row " << &lie - kLies.data();
  }
  ObjectTerrain many = test::smallObjects(true);
  many.textures.resize(256, many.textures[0]);
  ASSERT_TRUE(writeObjects(dir / "objects", many));
  EXPECT_FALSE(readObjects(dir / "objects"));
}

TEST(ObjectFile, ofVersion1HasNoLights) {
  const test::ScratchDir dir;
  ASSERT_TRUE(writeObjects(dir / "objects", test::smallObjects(false)));
  const std::string now = test::readFile(dir / "objects");
  ObjectTerrain dark = test::smallObjects(false);
  dark.lights = {};
  ASSERT_TRUE(writeObjects(dir / "objects", dark));
  std::string old = test::readFile(dir / "objects");
  // As it was written before: without the two lengths of nothing at the end.
  constexpr std::size_t kVersionAt = 8, kSizeAt = 12, kSumAt = 20, kHeader = 28;
  old.resize(old.size() - 16);
  const std::uint32_t version = 1;
  const std::uint64_t size = old.size() - kHeader, sum = checksum(std::string_view(old).substr(kHeader));
  std::memcpy(&old[kVersionAt], &version, sizeof version);
  std::memcpy(&old[kSizeAt], &size, sizeof size);
  std::memcpy(&old[kSumAt], &sum, sizeof sum);
  test::writeFile(dir / "old", old);
  const auto read = readObjects(dir / "old");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ((*read)->index.instances.size(), 5u);
  EXPECT_TRUE((*read)->lights.points.empty());
  std::string newer = now;
  newer[kVersionAt] = 3;
  test::writeFile(dir / "newer", newer);
  EXPECT_FALSE(readObjects(dir / "newer"));
}

TEST(ObjectFile, mayBeEmpty) {
  const test::ScratchDir dir;
  ASSERT_TRUE(writeObjects(dir / "objects", ObjectTerrain{}));
  const auto read = readObjects(dir / "objects");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ(countObjects(**read).instances, 0u);
}

}  // namespace
}  // namespace trimtab::terrain
