#include <sys/resource.h>

#include <cstdlib>
#include <cstring>
#include <map>
#include <random>

#include "scenery_tiles.h"

/// Every byte of a tile changed or cut in turn: refused or read, never worse.
namespace trimtab {
namespace {

struct Tally {
  std::size_t read = 0, refused = 0;
};

void feed(const std::string& bytes, bool zipped, Tally& tally) {
  const std::vector<char> exact(bytes.begin(), bytes.end());
  const std::string_view view(exact.data(), exact.size());
  Result<std::string> plain = zipped ? terrain::gunzip(view, "tile") : Result<std::string>(std::string(view));
  Findings findings = plain.findings();
  if (plain) {
    const std::vector<char> inner(plain->begin(), plain->end());
    const auto mesh = terrain::parseBtg({inner.data(), inner.size()}, "tile");
    if (mesh) {
      ASSERT_TRUE(test::isSound(*mesh));
      ++tally.read;
      return;
    }
    findings = mesh.findings();
  }
  ASSERT_TRUE(test::tellsWhy(findings)) << toString(findings);
  ++tally.refused;
}

Tally damaged(const std::string& bytes, bool zipped) {
  Tally tally;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int pattern : {0x01, 0x10, 0x80, 0xff}) {
      std::string changed = bytes;
      changed[i] = static_cast<char>(changed[i] ^ pattern);
      feed(changed, zipped, tally);
    }
    feed(bytes.substr(0, i), zipped, tally);
    feed(std::string(bytes).erase(i, 1), zipped, tally);
    if (::testing::Test::HasFatalFailure()) break;
  }
  return tally;
}

TEST(SceneryDamage, leavesNoByteOfASyntheticTileUntried) {
  for (const int version : {7, 10})
    for (const std::uint8_t kind : {std::uint8_t{10}, std::uint8_t{11}, std::uint8_t{12}}) {
      test::TileRecipe recipe;
      recipe.version = version;
      recipe.kind = kind;
      const Tally tally = damaged(test::gridTile(recipe), false);
      // A bit of a vertex makes another tile; a bit of a length makes none.
      EXPECT_GT(tally.read, 100U);
      EXPECT_GT(tally.refused, 100U);
    }
}

TEST(SceneryDamage, leavesNoByteOfASyntheticZipUntried) {
  const std::string packed = test::gzipped(test::gridTile({}));
  const Tally tally = damaged(packed, true);
  // What is not under the sum is the header's time, system and flags.
  EXPECT_LT(tally.read, 60U);
  EXPECT_GT(tally.refused, packed.size() * 5);
}

/// Every four bytes in turn as the largest numbers there are: the reader asks for no memory by them.
TEST(SceneryDamage, takesNoMemoryForACountThatLies) {
  const auto peakKiB = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
  };
  for (const int version : {7, 10}) {
    test::TileRecipe recipe;
    recipe.version = version;
    const std::string good = test::gridTile(recipe);
    Tally before;
    feed(good, false, before);
    const long peak = peakKiB();
    Tally tally;
    for (std::size_t i = 0; i + 4 <= good.size(); ++i)
      for (const std::uint32_t lie : {0xffffffffu, 0x7fffffffu, 0x10000000u, 0x00ffffffu}) {
        std::string changed = good;
        std::memcpy(&changed[i], &lie, 4);
        feed(changed, false, tally);
      }
    EXPECT_GT(tally.refused, good.size());
    EXPECT_LT(peakKiB() - peak, 16 * 1024) << "version " << version;
  }
}

/// A real tile cut and flipped at places all over it, the heaviest with them.
TEST(SceneryDamage, leavesLargeTilesHarmless) {
  for (const char* name : {"data/fg-cologne/3056410.btg",
                           "data/fg-debian-iceland-reykjanes/Terrain/w030n60/w022n64/2598528.btg.gz"}) {
    TRIMTAB_NEEDS_SHARED(name);
    const std::string packed = test::readFile(test::sharedDir() / name);
    const auto plain =
        std::string(name).ends_with(".gz") ? terrain::gunzip(packed, name) : Result<std::string>(packed);
    ASSERT_TRUE(plain);
    Tally tally;
    std::mt19937 random(11);
    for (int i = 0; i < 20; ++i) {
      std::string changed = *plain;
      for (int k = 0; k < 4; ++k) {
        char& byte = changed[random() % changed.size()];
        byte = static_cast<char>(byte ^ (1 << random() % 8));
      }
      feed(changed, false, tally);
      feed(plain->substr(0, random() % plain->size()), false, tally);
    }
    EXPECT_GE(tally.refused, 20U) << name;
  }
}

/// What the fuzzer starts from. TRIMTAB_WRITE_CORPUS=1 writes the files anew.
TEST(SceneryCorpus, isWhatTheWriterMakes) {
  const auto folder = test::sourceDir() / "tests/data/btg";
  std::map<std::string, std::string> files;
  for (const int version : {7, 10})
    for (const auto& [kind, name] :
         {std::pair{10, "triangles"}, std::pair{11, "strips"}, std::pair{12, "fans"}}) {
      test::TileRecipe recipe;
      recipe.version = version;
      recipe.kind = static_cast<std::uint8_t>(kind);
      recipe.cells = 2;
      files[std::string(name) + "-v" + std::to_string(version) + ".btg"] = test::gridTile(recipe);
    }
  test::BtgWriter points(7);
  points.places({{Degrees{50}, Degrees{7}, Metres{5}}});
  points.object(9, {{0, "RWY_WHITE_LIGHTS"}, {1, std::string(1, '\x1')}}, {points.indices({0})});
  files["points-v7.btg"] = points.bytes();
  for (const auto& [name, bytes] : files) {
    if (std::getenv("TRIMTAB_WRITE_CORPUS") != nullptr) test::writeFile(folder / name, bytes);
    EXPECT_EQ(test::readFile(folder / name), bytes) << name;
  }
  const auto zipped = terrain::gunzip(test::readFile(folder / "triangles-v7.btg.gz"), "corpus");
  if (std::getenv("TRIMTAB_WRITE_CORPUS") != nullptr)
    test::writeFile(folder / "triangles-v7.btg.gz", test::gzipped(files["triangles-v7.btg"]));
  else
    EXPECT_EQ(*zipped, files["triangles-v7.btg"]);
}

TEST(SceneryDamage, leavesNoByteOfTheSmallestRealTileUntried) {
  const char* const name = "data/fg-debian-iceland-reykjanes/Terrain/w030n60/w023n63/2582120.btg.gz";
  TRIMTAB_NEEDS_SHARED(name);
  const std::string packed = test::readFile(test::sharedDir() / name);
  const auto plain = terrain::gunzip(packed, name);
  ASSERT_TRUE(plain);
  const Tally unzipped = damaged(*plain, false);
  EXPECT_GT(unzipped.read, 100U);
  EXPECT_GT(unzipped.refused, 100U);
  EXPECT_GT(damaged(packed, true).refused, packed.size() * 5);
}

}  // namespace
}  // namespace trimtab
