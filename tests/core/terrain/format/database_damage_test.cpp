#include "tests/core/terrain/bake/bake_support.h"
#include "trimtab/terrain/format/store.h"

/// What a damaged database says.
namespace trimtab::terrain {
namespace {

/// A database with every file that one without scenery can have.
class DamagedDatabase : public BakeFixture {
 protected:
  DamagedDatabase() { options_.imagery = test::writeRaster(dir_ / "rgb.tif", test::anyColours(90, 70)); }
};

TEST_F(DamagedDatabase, findsAFlippedByteInAnyFile) {
  ASSERT_TRUE(bake(options_));
  for (const char* name : {kImageName, kImageSumsName}) ASSERT_TRUE(fs::exists(dir_ / "db" / name)) << name;
  for (const std::string& name : test::namesIn(dir_ / "db")) {
    const fs::path file = dir_ / "db" / name;
    const std::string whole = test::readFile(file);
    int unseen = 0;
    for (int k = 0; k < 40; ++k) {
      const std::size_t at = whole.size() * static_cast<std::size_t>(k) / 40;
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << k % 8));
      test::writeFile(file, damaged);
      const auto opened = Database::open(dir_ / "db");
      if (opened) useAll(**opened);
      const Findings findings = opened ? (*opened)->checkAll() : opened.findings();
      if (findings.empty()) {
        // Between the blobs of a page file are up to fifteen bytes that nobody reads.
        EXPECT_EQ(file.extension(), ".pages") << name << " byte " << at;
        EXPECT_EQ(whole[at], 0);
        ++unseen;
        continue;
      }
      EXPECT_EQ(findings.front().where, file.string());
      EXPECT_FALSE(findings.front().expected.empty());
      EXPECT_FALSE(findings.front().found.empty());
    }
    EXPECT_LE(unseen, 3) << name;
    fs::remove(file);
    test::writeFile(file, whole);
  }
  EXPECT_TRUE(Database::open(dir_ / "db"));
}

TEST_F(DamagedDatabase, tellsNoHeightWhereItsRowsAreDamaged) {
  ASSERT_TRUE(bake(options_));
  const fs::path file = dir_ / "db/heights.f32";
  std::string bytes = test::readFile(file);
  bytes[100] = static_cast<char>(bytes[100] ^ 16);
  fs::remove(file);
  test::writeFile(file, bytes);
  const auto opened = Database::open(dir_ / "db");
  ASSERT_TRUE(opened) << toString(opened.findings());
  EXPECT_TRUE((*opened)->damage().empty());
  const GeodeticPosition at = (*opened)->info().southWest;
  EXPECT_FALSE((*opened)->heightAt(at.latitude, at.longitude));
  EXPECT_FALSE((*opened)->highestWithin(at.latitude, at.longitude, Metres{1000}));
  const Findings damage = (*opened)->damage();
  ASSERT_EQ(damage.size(), 1u);
  EXPECT_EQ(damage[0].where, file.string());
  EXPECT_NE(damage[0].key.find("rows 0 to"), std::string::npos);
  EXPECT_NE(damage[0].expected.find("checksum"), std::string::npos);
}

TEST_F(DamagedDatabase, saysThatItsColoursAreDamagedWhenATileIsBuiltOfThem) {
  ASSERT_TRUE(bake(options_));
  const fs::path file = dir_ / "db" / kImageName;
  const std::string whole = test::readFile(file);
  std::string bytes = whole;
  bytes[100] = static_cast<char>(bytes[100] ^ 16);
  test::writeFile(file, bytes);
  const auto opened = Database::open(dir_ / "db");
  ASSERT_TRUE(opened) << toString(opened.findings());
  EXPECT_TRUE((*opened)->damage().empty());
  TileMesh mesh;
  (*opened)->buildTile(0, mesh);
  const Findings damage = (*opened)->damage();
  ASSERT_EQ(damage.size(), 1u) << toString(damage);
  EXPECT_EQ(damage[0].where, file.string());
  EXPECT_NE(damage[0].key.find("rows 0 to"), std::string::npos);
}

/// What a copy over an open database does: it cuts a file short and then fills it again.
TEST_F(DamagedDatabase, cutShortWhileItIsOpenIsDamageAndNoCrash) {
  ASSERT_TRUE(bake(options_));
  const fs::path folder = dir_ / "db";
  for (const std::uintmax_t left : {std::uintmax_t{0}, std::uintmax_t{5000}}) {
    const fs::path copy = dir_ / ("cut-" + std::to_string(left));
    fs::copy(folder, copy);
    const auto opened = Database::open(copy);
    ASSERT_TRUE(opened) << toString(opened.findings());
    for (const char* name : {kHeightsName, kPatchesName, kGroundName}) fs::resize_file(copy / name, left);
    useAll(**opened);
    const GeodeticPosition at = (*opened)->info().northEast;
    EXPECT_FALSE((*opened)->heightAt(at.latitude, at.longitude));
    const std::string damage = toString((*opened)->damage());
    EXPECT_NE(damage.find("cut short"), std::string::npos) << damage;
    EXPECT_NE(damage.find(kHeightsName), std::string::npos) << damage;
    const std::string all = toString((*opened)->checkAll());
    for (const char* name : {kHeightsName, kPatchesName, kGroundName})
      EXPECT_NE(all.find(name), std::string::npos) << all;
  }
}

/// Rows that left memory are checked again, as their file may have changed.
TEST_F(DamagedDatabase, keepsNoMoreRowsThanItMayAndChecksThemWhenTheyComeBack) {
  constexpr std::uint32_t kRows = 4096;
  constexpr std::size_t kRowBytes = 1024;
  const std::uint32_t perBlock = CheckedRows::rowsPerBlock(kRowBytes);
  std::vector<std::byte> bytes(kRows * kRowBytes);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i / kRowBytes * 7 + i);
  const auto write = [&] {
    test::writeFile(dir_ / "rows", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  write();
  CheckedRows::Sums sums(kRowBytes);
  sums.add(bytes);
  const auto file = StoredFile::open(dir_ / "rows");
  ASSERT_TRUE(file);
  const CheckedRows rows(*file, kRowBytes, kRows, sums.finish(), {}, 2 * perBlock * kRowBytes);
  const auto isWhole = [&](std::uint32_t row) {
    CheckedRows::Reader reader(rows);
    const std::byte* at = reader.row(row);
    return at && std::equal(at, at + kRowBytes, &bytes[row * kRowBytes]);
  };
  for (std::uint32_t row = 0; row < kRows; row += 37) EXPECT_TRUE(isWhole(row)) << row;
  bytes[0] ^= std::byte{1};
  write();
  EXPECT_FALSE(isWhole(1)) << "the first block had left memory";
  EXPECT_TRUE(isWhole(kRows - 1));
  ASSERT_EQ(rows.damage().size(), 1u);
  rows.checkAll();
  EXPECT_EQ(rows.damage().size(), 1u) << "damage is told once";
}

TEST_F(DamagedDatabase, refusesATruncatedLongerOrAbsentFile) {
  ASSERT_TRUE(bake(options_));
  for (const std::string& name : test::namesIn(dir_ / "db")) {
    const fs::path file = dir_ / "db" / name;
    const std::string whole = test::readFile(file);
    for (const std::string& damaged : {std::string(), whole.substr(0, 1), whole.substr(0, whole.size() / 2),
                                       whole.substr(0, whole.size() - 1), whole + "x"}) {
      if (name == "manifest.json" && damaged == whole + "x") continue;
      fs::remove(file);
      test::writeFile(file, damaged);
      const auto opened = Database::open(dir_ / "db");
      ASSERT_FALSE(opened) << name << " of " << damaged.size() << " bytes";
      EXPECT_EQ(opened.findings().front().where, file.string());
    }
    fs::remove(file);
    const auto opened = Database::open(dir_ / "db");
    ASSERT_FALSE(opened) << name;
    EXPECT_EQ(opened.findings().front().where, file.string());
    test::writeFile(file, whole);
  }
}

TEST_F(DamagedDatabase, refusesAnotherVersionSayingWhich) {
  ASSERT_TRUE(bake(options_));
  std::string text = test::readFile(dir_ / "db/manifest.json");
  const std::string old = "\"version\": 2";
  text.replace(text.find(old), old.size(), "\"version\": 7");
  test::writeFile(dir_ / "db/manifest.json", text);
  const auto opened = Database::open(dir_ / "db");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.findings().front().key, "version");
  EXPECT_EQ(opened.findings().front().found, "7");
}

TEST_F(DamagedDatabase, ofVersionOneStillOpens) {
  const auto opened = Database::open(test::sourceDir() / "tests/data/terrain/version-1");
  ASSERT_TRUE(opened) << toString(opened.findings());
  EXPECT_EQ((*opened)->info().columns, 40u);
  EXPECT_EQ((*opened)->index().size(), 5u);
  EXPECT_EQ((*opened)->patches(), nullptr);
  EXPECT_EQ((*opened)->ground(), nullptr);
  // As the source was made: 300 + 80 sin(column / 5) + 60 cos(row from north / 4), to a centimetre.
  const auto height = (*opened)->heightAt(Degrees{50 + 0.001 * (34 - 8)}, Degrees{10 + 0.001 * 15});
  ASSERT_TRUE(height);
  EXPECT_NEAR(height->value(), 300 + 80 * std::sin(3.0) + 60 * std::cos(2.0), 0.01);
  EXPECT_TRUE((*opened)->checkAll().empty());
  useAll(**opened);
}

TEST_F(DamagedDatabase, opensNothingThatIsNoDatabase) {
  EXPECT_FALSE(Database::open(dir_ / "nowhere"));
  EXPECT_FALSE(Database::open(source_));
  fs::create_directory(dir_ / "other");
  test::writeFile(dir_ / "other/manifest.json", "[1, 2]");
  EXPECT_FALSE(Database::open(dir_ / "other"));
  test::writeFile(dir_ / "other/manifest.json", "{\"format\": \"something\"}");
  const auto opened = Database::open(dir_ / "other");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.findings().front().key, "format");
}

}  // namespace
}  // namespace trimtab::terrain
