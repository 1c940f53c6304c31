#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <set>

#include "static_lod_support.h"
#include "tests/support.h"
#include "trimtab/terrain/static_lod/error.h"
#include "trimtab/terrain/static_lod/export.h"
#include "trimtab/terrain/static_lod/level.h"

namespace trimtab::terrain {
namespace {

using TextureAt = std::function<TexturePlace(double x, double y, double middleX)>;

/// Gives corners the texture of their places; `middleX` is that of the triangle's middle.
void texture(SceneryMesh& mesh, const TextureAt& at) {
  const LocalFrame frame = test::testFrame();
  for (const SceneryMesh::Triangle& t : mesh.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = frame.fromEcef(mesh.vertices[t.vertex[k]]);
    TextureCorners corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = at(p[k].x, p[k].y, (p[0].x + p[1].x + p[2].x) / 3);
    mesh.texture.push_back(corners);
  }
}

struct Corner {
  Vec3 place;
  TexturePlace at;
};
/// The triangles of a level with their texture.
std::vector<std::array<Corner, 3>> texturedOf(const StaticLodTerrain& trees, std::size_t tile,
                                              std::uint32_t level) {
  const StaticLodTile& from = trees.tiles[tile];
  std::vector<std::array<Corner, 3>> all;
  for (const std::uint32_t node : nodesOfLevel(trees, tile, level)) {
    const StaticLodRange range = trees.ranges[node];
    for (std::size_t t = range.firstTriangle; t < std::size_t{range.firstTriangle} + range.triangles; ++t) {
      std::array<Corner, 3>& corners = all.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const StaticLodVertex& v = from.vertices[from.indices[3 * t + k]];
        corners[k].place =
            Vec3{v.x + 16.0 * from.origin[0], v.y + 16.0 * from.origin[1], v.z + 16.0 * from.origin[2]};
        corners[k].at = from.texture[from.indices[3 * t + k]];
      }
    }
  }
  return all;
}

double away(const TexturePlace& a, const TexturePlace& b) {
  return std::hypot(double{a[0]} - b[0], double{a[1]} - b[1]);
}

TexturePlace byKilometre(double x, double y, double) {
  return {static_cast<float>(x / 1000 + 3), static_cast<float>(y / 1000)};
}

TEST(StaticLodTexture, staysInItsPlaceWhereItIsLinear) {
  SceneryMesh mesh = test::tin("1", {});
  texture(mesh, byKilometre);
  const auto built = test::built({mesh}, 150);
  ASSERT_TRUE(built);
  const StaticLodTerrain& trees = **built;
  ASSERT_GT(trees.counts.levels, 3u);
  ASSERT_EQ(trees.tiles[0].texture.size(), trees.tiles[0].vertices.size());
  double worst = 0;
  std::size_t corners = 0;
  for (std::uint32_t level = 0; level < trees.counts.levels; ++level)
    for (const auto& triangle : texturedOf(trees, 0, level))
      for (const Corner& c : triangle) {
        worst = std::max(worst, away(c.at, byKilometre(c.place.x, c.place.y, 0)));
        ++corners;
      }
  EXPECT_GT(corners, 9000u);
  EXPECT_LT(worst, 5e-5) << "a twentieth of a metre";
}

/// Two charts in one material, with a seam between them at about x = 450: neither runs into the other.
TEST(StaticLodTexture, keepsBothSidesOfASeamApart) {
  constexpr double kSeamM = 450;  // not where the tile is split
  const auto left = [](double x, double y) { return TexturePlace{float(x / 100), float(y / 100)}; };
  const auto right = [](double x, double y) { return TexturePlace{float(50 - y / 70), float(x / 70)}; };
  test::TinOptions options;
  options.materials = 1;
  options.jitter = 0;
  // Gentle land: on steep land the height may be worth more than the seam.
  const auto gentle = [](double x, double y) { return 0.5 * std::sin(x / 83) * std::cos(y / 61); };
  SceneryMesh mesh = test::tin("1", options, gentle);
  texture(mesh,
          [&](double x, double y, double middle) { return middle < kSeamM ? left(x, y) : right(x, y); });
  const auto built = test::built({mesh}, 150);
  ASSERT_TRUE(built);
  const StaticLodTerrain& trees = **built;
  for (std::uint32_t level = 0; level < trees.counts.levels; ++level) {
    std::size_t torn = 0, across = 0, ofLeft = 0, ofRight = 0;
    for (const auto& triangle : texturedOf(trees, 0, level)) {
      bool isLeft = true, isRight = true;
      double low = 1e9, high = -1e9;
      for (const Corner& c : triangle) {
        isLeft = isLeft && away(c.at, left(c.place.x, c.place.y)) < 0.01;
        isRight = isRight && away(c.at, right(c.place.x, c.place.y)) < 0.01;
        low = std::min(low, c.place.x), high = std::max(high, c.place.x);
      }
      torn += !isLeft && !isRight;
      across += low < kSeamM - 10 && high > kSeamM + 10;
      ofLeft += isLeft;
      ofRight += isRight;
    }
    EXPECT_EQ(torn, 0u) << "level " << level;
    EXPECT_LT(across, 3u) << "level " << level;
    EXPECT_GT(ofLeft, 20u) << "level " << level;
    EXPECT_GT(ofRight, 20u) << "level " << level;
  }
}

/// On gentle land the texture says where vertices are needed.
TEST(StaticLodTexture, keepsVerticesWhereItIsNotLinear) {
  const auto wavy = [](double x, double y, double) {
    return TexturePlace{float(x > 600 ? 3 * std::sin(x / 40) : x / 100), float(y / 100)};
  };
  const auto gentle = [](double x, double y) { return 0.5 * std::sin(x / 83) * std::cos(y / 61); };
  test::TinOptions options;
  options.materials = 1;
  SceneryMesh mesh = test::tin("1", options, gentle);
  texture(mesh, wavy);
  const auto built = test::built({mesh}, 300);
  ASSERT_TRUE(built);
  const StaticLodTerrain& trees = **built;
  double sum = 0;
  std::size_t count = 0, curved = 0;
  for (const auto& t : texturedOf(trees, 0, 0)) {
    const Vec3 middle = (t[0].place + t[1].place + t[2].place) * (1.0 / 3);
    TexturePlace at{};
    for (const Corner& c : t)
      for (std::size_t k = 0; k < 2; ++k) at[k] += c.at[k] / 3;
    sum += std::pow(away(at, wavy(middle.x, middle.y, 0)), 2);
    ++count;
    curved += middle.x > 600;
  }
  // Without the texture's own terms the RMS is 1.25 units, and less than half of the middles are there.
  EXPECT_LT(std::sqrt(sum / static_cast<double>(count)), 0.7);
  EXPECT_GT(static_cast<double>(curved) / static_cast<double>(count), 0.55);
}

std::uint32_t versionOf(const std::filesystem::path& file) {
  std::uint32_t version = 0;
  std::memcpy(&version, test::readFile(file).data() + 8, 4);
  return version;
}

TEST(StaticLodTexture, isInFilesOnlyIfThereIsAny) {
  const SceneryMesh plain = test::tin("1", {});
  SceneryMesh textured = plain;
  texture(textured, byKilometre);
  const test::ScratchDir dir;
  const auto without = test::built({plain}, 300), with = test::built({textured}, 300);
  ASSERT_TRUE(without && with);
  ASSERT_TRUE(writeStaticLod(dir / "plain", **without) && writeStaticLod(dir / "textured", **with));
  EXPECT_EQ(versionOf(dir / "plain"), 2u);
  EXPECT_EQ(versionOf(dir / "textured"), 3u);
  EXPECT_TRUE((*without)->tiles[0].texture.empty());
  const auto read = readStaticLod(dir / "textured");
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_TRUE((*read)->tiles[0].texture == (*with)->tiles[0].texture);
  StaticLodTerrain broken = **with;
  broken.tiles[0].texture[7][1] = NAN;
  ASSERT_TRUE(writeStaticLod(dir / "broken", broken));
  EXPECT_FALSE(readStaticLod(dir / "broken"));
  broken.tiles[0].texture.resize(7);
  ASSERT_TRUE(writeStaticLod(dir / "broken", broken));
  EXPECT_FALSE(readStaticLod(dir / "broken"));
}

TEST(StaticLodTexture, refusesCoordinatesOfOtherTriangles) {
  SceneryMesh mesh = test::tin("1", {});
  texture(mesh, byKilometre);
  mesh.texture.pop_back();
  const auto built = test::built({mesh}, 300);
  ASSERT_FALSE(built);
  EXPECT_NE(toString(built.findings()).find("texture"), std::string::npos);
}

/// How many of a level's triangles have, at their middle, the texture of the source within a twentieth of
/// a unit.
struct Share {
  std::size_t alike = 0, all = 0;
  double of() const { return static_cast<double>(alike) / static_cast<double>(all); }
};
Share shareOf(const StaticLodTerrain& trees, std::uint32_t level) {
  const LatticeSurface source = surfaceOfLevel(trees, 0, 0xffffffffu),
                       surface = surfaceOfLevel(trees, 0, level);
  const auto textured = texturedOf(trees, 0, 0xffffffffu), drawn = texturedOf(trees, 0, level);
  const VerticalDistance over(source.vertices, source.triangles);
  Share share;
  for (std::size_t t = 0; t < drawn.size(); ++t) {
    Vec3 middle{};
    TexturePlace at{};
    for (const Corner& c : drawn[t]) {
      middle = middle + c.place * (1.0 / 3);
      for (std::size_t k = 0; k < 2; ++k) at[k] += c.at[k] / 3;
    }
    const Lattice p{static_cast<std::int32_t>(std::lround(middle.x * 256)),
                    static_cast<std::int32_t>(std::lround(middle.y * 256)), 0};
    const auto found = over.at(p);
    if (!found || source.material[*found] != surface.material[t]) continue;
    const auto& [a, b, c] = textured[*found];
    const Vec3 e = b.place - a.place, f = c.place - a.place, q = middle - a.place;
    const double scale = e.x * f.y - e.y * f.x, u = (q.x * f.y - q.y * f.x) / scale,
                 v = (e.x * q.y - e.y * q.x) / scale;
    TexturePlace expected{};
    for (std::size_t k = 0; k < 2; ++k)
      expected[k] = static_cast<float>(a.at[k] + u * (b.at[k] - a.at[k]) + v * (c.at[k] - a.at[k]));
    ++share.all;
    share.alike += away(at, expected) < 0.05;
  }
  return share;
}

TEST(StaticLodTexture, survivesOnRealLandAndAirports) {
  TRIMTAB_NEEDS_SHARED("data/fg-cologne");
  const auto folder = test::sharedDir() / "data/fg-cologne/Terrain/e000n50/e007n50";
  for (const char* name : {"EDDK.btg.gz", "EDKB.btg.gz", "3072816.btg.gz"}) {
    const auto mesh = readBtg(folder / name, true);
    ASSERT_TRUE(mesh) << toString(mesh.findings());
    ASSERT_EQ(mesh->texture.size(), mesh->triangles.size());
    EXPECT_TRUE(readBtg(folder / name)->texture.empty());
    GeodeticPosition origin = toGeodetic(mesh->vertices.front());
    origin.height = Metres{0};
    const std::vector<SceneryMesh> meshes{*mesh};
    const auto built = buildStaticLod(meshes, LocalFrame(origin), {2000, {}, false});
    ASSERT_TRUE(built) << toString(built.findings());
    const StaticLodTerrain& trees = **built;

    // The leaves have what the file has; what is written reads back.
    std::multiset<std::array<float, 6>> ours, theirs, file;
    const auto insert = [](std::multiset<std::array<float, 6>>& to, std::array<TexturePlace, 3> t) {
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      to.insert({t[0][0], t[0][1], t[1][0], t[1][1], t[2][0], t[2][1]});
    };
    for (const auto& t : texturedOf(trees, 0, 0xffffffffu)) insert(ours, {t[0].at, t[1].at, t[2].at});
    for (const TextureCorners& t : mesh->texture) insert(file, t);
    const auto back = parseBtg(btgBytes(btgOfLevel(trees, 0, 0xffffffffu)), name, true);
    ASSERT_TRUE(back) << toString(back.findings());
    for (const TextureCorners& t : back->texture) insert(theirs, t);
    EXPECT_TRUE(ours == theirs);
    EXPECT_TRUE(std::includes(file.begin(), file.end(), ours.begin(), ours.end()));
    EXPECT_EQ(ours.size() + trees.counts.degenerate + trees.counts.repeated, file.size());

    for (std::uint32_t level = 0; level < trees.counts.levels; ++level) {
      const Share share = shareOf(trees, level);
      std::printf("%s, level %u: %zu triangles, %.1f %% have the source's texture\n", name, level, share.all,
                  100 * share.of());
      EXPECT_GT(share.of(), 0.8) << name << " level " << level;
    }
  }
}

}  // namespace
}  // namespace trimtab::terrain
