#include <cmath>
#include <map>
#include <set>

#include "scenery_tiles.h"

namespace trimtab {
namespace {

using terrain::SceneryMesh;
using test::BtgWriter;
using test::TileRecipe;

Result<SceneryMesh> parse(const std::string& bytes) {
  // From memory of exactly its size, so that a sanitizer sees a read beyond.
  const std::vector<char> exact(bytes.begin(), bytes.end());
  return terrain::parseBtg({exact.data(), exact.size()}, "tiles/3056410.btg");
}

/// A triangle as its corners' places, first the smallest: the same for files that number them otherwise.
using Corners = std::array<std::array<double, 3>, 3>;
std::multiset<Corners> cornersOf(const SceneryMesh& mesh) {
  std::multiset<Corners> all;
  for (const auto& t : mesh.triangles) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& v = mesh.vertices[t.vertex[i]];
      corners[i] = {v.x, v.y, v.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    all.insert(corners);
  }
  return all;
}

TEST(Btg, readsAllVersionsAlike) {
  TileRecipe recipe;
  recipe.heightM = [](double lon, double lat) { return 200 + 3000 * (lon - 7) + 1000 * (lat - 50.5); };
  const auto narrow = parse(test::gridTile(recipe));
  recipe.version = 10;
  const auto wide = parse(test::gridTile(recipe));
  recipe.version = 6;
  const auto old = parse(test::gridTile(recipe));
  ASSERT_TRUE(old) << toString(old.findings());
  EXPECT_EQ(old->version, 6);
  ASSERT_TRUE(narrow && wide) << toString(narrow.findings()) << toString(wide.findings());
  EXPECT_EQ(narrow->version, 7);
  EXPECT_EQ(wide->version, 10);
  EXPECT_EQ(narrow->name, "3056410");
  EXPECT_FALSE(narrow->airport);
  EXPECT_EQ(narrow->triangles.size(), 32U);
  EXPECT_EQ(narrow->materials, (std::vector<std::string>{"Lake", "EvergreenForest"}));
  EXPECT_EQ(cornersOf(*narrow), cornersOf(*wide));
  EXPECT_EQ(cornersOf(*narrow), cornersOf(*old));
  const GeodeticPosition corner = toGeodetic(narrow->vertices[0]);
  EXPECT_NEAR(corner.latitude.value(), 50.5, 1e-7);
  EXPECT_NEAR(corner.longitude.value(), 7, 1e-7);
  EXPECT_NEAR(corner.height.value(), 200, 0.01);
}

TEST(Btg, readsBeyondSixteenBitsInVersionTen) {
  TileRecipe recipe;
  recipe.version = 10;
  recipe.cells = 280;  // 78,961 vertices
  const auto mesh = parse(test::gridTile(recipe));
  ASSERT_TRUE(mesh) << toString(mesh.findings());
  EXPECT_EQ(mesh->vertices.size(), 281U * 281U);
  EXPECT_EQ(mesh->triangles.size(), 2U * 280 * 280);
  std::uint32_t highest = 0;
  for (const auto& t : mesh->triangles)
    for (const std::uint32_t v : t.vertex) highest = std::max(highest, v);
  EXPECT_EQ(highest, 281U * 281U - 1);
}

TEST(Btg, takesStripsAndFansForTheTrianglesTheyStandFor) {
  TileRecipe recipe;
  const auto fans = [&] {
    recipe.kind = 12;
    return parse(test::gridTile(recipe));
  }();
  const auto single = [&] {
    recipe.kind = 10;
    return parse(test::gridTile(recipe));
  }();
  const auto strips = [&] {
    recipe.kind = 11;
    return parse(test::gridTile(recipe));
  }();
  ASSERT_TRUE(fans && single && strips);
  EXPECT_EQ(cornersOf(*fans), cornersOf(*single));
  // A strip of four splits its cell the other way: as many triangles, all of them up, the same ground.
  ASSERT_EQ(strips->triangles.size(), single->triangles.size());
  EXPECT_EQ(strips->facingDown, 0U);
  const auto area = [](const SceneryMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
      const Vec3 a = mesh.vertices[t.vertex[0]];
      const Vec3 n = cross(mesh.vertices[t.vertex[1]] - a, mesh.vertices[t.vertex[2]] - a);
      sum += dot(n, normalized(a)) / 2;
    }
    return sum;
  };
  EXPECT_NEAR(area(*strips) / area(*single), 1, 1e-6);
}

TEST(Btg, turnsTheOddTrianglesOfALongStrip) {
  BtgWriter writer(7);
  std::vector<GeodeticPosition> places;
  std::vector<std::size_t> order;
  for (int i = 0; i < 9; ++i) {
    places.push_back({Degrees{50.0 - 0.01 * (i % 2)}, Degrees{7 + 0.005 * i}, Metres{0}});
    order.push_back(static_cast<std::size_t>(i));
  }
  writer.places(places).object(11, {{0, "Road"}, {1, std::string(1, '\x1')}}, {writer.indices(order)});
  const auto mesh = parse(writer.bytes());
  ASSERT_TRUE(mesh) << toString(mesh.findings());
  EXPECT_EQ(mesh->triangles.size(), 7U);
  EXPECT_EQ(mesh->facingDown, 0U);
}

TEST(Btg, turnsAMeshThatFacesDownAsAWhole) {
  for (const bool down : {false, true}) {
    BtgWriter writer(7);
    writer.places({{Degrees{50}, Degrees{7}, Metres{0}},
                   {Degrees{50}, Degrees{7.1}, Metres{0}},
                   {Degrees{50.1}, Degrees{7.1}, Metres{0}},
                   {Degrees{50.1}, Degrees{7}, Metres{0}}});
    const std::vector<std::size_t> order =
        down ? std::vector<std::size_t>{0, 2, 1, 0, 3, 2} : std::vector<std::size_t>{0, 1, 2, 0, 2, 3};
    writer.object(10, {{1, std::string(1, '\x1')}}, {writer.indices(order)});
    const auto mesh = parse(writer.bytes());
    ASSERT_TRUE(mesh) << toString(mesh.findings());
    EXPECT_EQ(mesh->facingDown, 0U);
    for (const auto& t : mesh->triangles) {
      const Vec3 a = mesh->vertices[t.vertex[0]];
      EXPECT_GT(dot(cross(mesh->vertices[t.vertex[1]] - a, mesh->vertices[t.vertex[2]] - a), a), 0);
    }
  }
}

TEST(Btg, findsVerticesAmongTheColumnsOfTheIndexMask) {
  // Vertices, normals, colours and two sets of texture coordinates, and two attributes: seven columns.
  BtgWriter writer(10);
  writer.places({{Degrees{50}, Degrees{7}, Metres{5}},
                 {Degrees{50}, Degrees{7.1}, Metres{5}},
                 {Degrees{50.1}, Degrees{7.1}, Metres{5}}});
  writer.object(2, {}, {std::string(3 * 5, '\x7f')});
  writer.object(4, {}, {std::string(16 * 2, '\0')});
  writer.object(3, {}, {std::string(8 * 4, '\0')});
  std::vector<std::size_t> rows;
  for (const std::size_t v : {0, 1, 2}) rows.insert(rows.end(), {v, 4, 1, 3, 2, 900, 901});
  writer.object(10, {{0, "Town"}, {1, std::string(1, '\x1f')}, {2, BtgWriter::raw(std::uint32_t{0x101})}},
                {writer.indices(rows)});
  const auto mesh = parse(writer.bytes());
  ASSERT_TRUE(mesh) << toString(mesh.findings());
  ASSERT_EQ(mesh->triangles.size(), 1U);
  EXPECT_EQ(mesh->triangles[0].vertex, (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(Btg, dropsTrianglesThatRepeatAVertexAndCountsThem) {
  BtgWriter writer(7);
  writer.places({{Degrees{50}, Degrees{7}, Metres{0}},
                 {Degrees{50}, Degrees{7.1}, Metres{0}},
                 {Degrees{50.1}, Degrees{7.1}, Metres{0}},
                 {Degrees{50}, Degrees{7.1}, Metres{0}}});  // the place of vertex 1 under another number
  writer.object(10, {{1, std::string(1, '\x1')}},
                {writer.indices({0, 1, 2, 0, 1, 1, 2, 2, 2, 1, 3, 2, 0, 3, 2})});
  const auto mesh = parse(writer.bytes());
  ASSERT_TRUE(mesh) << toString(mesh.findings());
  EXPECT_EQ(mesh->trianglesInFile, 5U);
  EXPECT_EQ(mesh->degenerate, 3U);
  EXPECT_EQ(mesh->triangles.size(), 2U);
}

TEST(Btg, skipsPointsAndKindsItDoesNotKnow) {
  TileRecipe recipe;
  std::string bytes = test::gridTile(recipe);
  BtgWriter more(7);
  more.object(9, {{0, "RWY_LIGHTS"}, {1, std::string(1, '\x3')}}, {""}).object(77, {{5, "?"}}, {"anything"});
  bytes += more.bytes().substr(10);
  bytes[8] = static_cast<char>(bytes[8] + 2);
  const auto mesh = parse(bytes);
  ASSERT_TRUE(mesh) << toString(mesh.findings());
  EXPECT_EQ(mesh->triangles.size(), 32U);
  ASSERT_EQ(mesh.findings().size(), 1U);
  EXPECT_EQ(mesh.findings()[0].severity, Severity::warning);
  EXPECT_EQ(mesh.findings()[0].found, "77, skipped");
}

struct Bad {
  const char* name;
  std::string bytes;
  const char* where;  ///< end of the finding's place
  const char* key;
};

TEST(Btg, saysWhereAFileIsWrongAndWhatItExpected) {
  const std::string good = test::gridTile({});
  const std::vector<GeodeticPosition> three{{Degrees{50}, Degrees{7}, Metres{0}},
                                            {Degrees{50}, Degrees{7.1}, Metres{0}},
                                            {Degrees{50.1}, Degrees{7.1}, Metres{0}}};
  const BtgWriter::Property vertices{1, std::string(1, '\x1')};
  const auto with = [&](std::uint8_t kind, const std::vector<BtgWriter::Property>& properties,
                        const std::string& element) {
    return BtgWriter(7).places(three).object(kind, properties, {element}).bytes();
  };
  const BtgWriter n(7);
  const auto changed = [&](std::size_t at, std::string to) {
    return std::string(good).replace(at, to.size(), to);
  };
  // Header 10 bytes; sphere 5 + 4 + 28; vertices 5 + 4 + 36; then the object under test at
  // 92, its property at 97, its element at 103.
  const Bad table[] = {
      {"empty", "", ":0", "magic number"},
      {"other magic", changed(2, "XX"), ":0", "magic number"},
      {"version 5", changed(0, "\x05"), ":0", "version"},
      {"version 9", changed(0, "\x09"), ":0", "version"},
      {"ends in the header", good.substr(0, 9), ":8", "number of objects"},
      {"ends in an element", good.substr(0, 60), ":52", "element length"},
      {"more objects than bytes", changed(8, "\xff\xff"), "", "type"},
      {"index beyond the vertices", with(10, {vertices}, n.indices({0, 1, 3})), ":111", "index of vertices"},
      {"no texture coordinates", with(10, {}, n.indices({0, 0, 1, 1, 2, 2})), "", "index of texture"},
      {"half a triangle", with(10, {vertices}, n.indices({0, 1})), ":103", "length"},
      {"half an index", with(11, {vertices}, n.indices({0, 1, 2}) + "x"), ":103", "length"},
      {"no vertex column", with(10, {{1, std::string(1, '\x8')}}, n.indices({0, 1, 2})), "", "index types"},
      {"empty mask", with(10, {{1, std::string(1, '\0')}}, n.indices({0, 1, 2})), "", "index types"},
      {"wide mask", with(10, {{1, "\x1\x1"}}, n.indices({0, 1, 2})), "", "index types"},
      {"control characters", with(10, {{0, "Ro\nad"}, vertices}, n.indices({0, 1, 2})), ":97", "material"},
      {"endless name", with(10, {{0, std::string(1000, 'x')}, vertices}, ""), "", "material"},
      {"short sphere", BtgWriter(7).object(0, {}, {"1234"}).bytes(), "", "length"},
      {"sphere in space", BtgWriter(7).object(0, {}, {BtgWriter::raw(1e9) + std::string(20, '\0')}).bytes(),
       "", "bounding sphere"},
      {"no sphere",
       BtgWriter(7)
           .object(1, {}, {std::string(36, '\0')})
           .object(10, {vertices}, {n.indices({0, 1, 2})})
           .bytes(),
       "", "bounding sphere"},
      {"half a vertex", BtgWriter(7).object(1, {}, {std::string(13, '\0')}).bytes(), "", "length"},
      {"vertex in space",
       BtgWriter(7).places(three).object(1, {}, {BtgWriter::raw(1e6f) + std::string(8, '\0')}).bytes(), ":92",
       "vertex 3"},
      {"vertex not a number",
       BtgWriter(7)
           .places(three)
           .object(1, {}, {BtgWriter::raw(std::nanf("")) + std::string(8, '\0')})
           .bytes(),
       "", "vertex 3"},
  };
  for (const Bad& bad : table) {
    const auto mesh = parse(bad.bytes);
    EXPECT_FALSE(mesh) << bad.name;
    ASSERT_TRUE(test::tellsWhy(mesh.findings())) << bad.name << ": " << toString(mesh.findings());
    const Finding& last = mesh.findings().back();
    EXPECT_NE(last.key.find(bad.key), std::string::npos) << bad.name << ": " << toString(last);
    EXPECT_TRUE(last.where.ends_with(bad.where)) << bad.name << ": " << toString(last);
  }
}

TEST(Gunzip, givesBackWhatGzipPackedAndRefusesTheRest) {
  const std::string tile = test::gridTile({});
  const auto whole = terrain::gunzip(test::gzipped(tile), "a");
  ASSERT_TRUE(whole);
  EXPECT_EQ(*whole, tile);
  const auto two = terrain::gunzip(test::gzipped("one, ") + test::gzipped("two"), "a");
  ASSERT_TRUE(two);
  EXPECT_EQ(*two, "one, two");
  const std::string packed = test::gzipped(tile);
  for (std::size_t length = 0; length < packed.size(); ++length) {
    const auto cut = terrain::gunzip(packed.substr(0, length), "a");
    EXPECT_FALSE(cut) << length;
    EXPECT_TRUE(test::tellsWhy(cut.findings()));
  }
}

TEST(Gunzip, stopsABombAtItsLimit) {
  std::string zeros = test::gzipped(std::string(std::size_t{1} << 24, '\0'));
  std::string bomb;
  for (int i = 0; i < 17; ++i) bomb += zeros;  // 272 MiB from 280 kB
  const auto out = terrain::gunzip(bomb, "bomb");
  ASSERT_FALSE(out);
  EXPECT_EQ(out.findings()[0].key, "unzipped size");
}

}  // namespace
}  // namespace trimtab
