#include "trimtab/terrain/format/page_file.h"

#include <cstring>
#include <random>
#include <thread>

#include "tests/support.h"

namespace trimtab::terrain {
namespace {

std::vector<std::byte> blobOf(std::uint32_t seed, std::size_t size) {
  std::mt19937 random(seed);
  std::vector<std::byte> blob(size);
  for (std::byte& b : blob) b = static_cast<std::byte>(random());
  return blob;
}
bool same(std::span<const std::byte> a, std::span<const std::byte> b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

class Pages : public ::testing::Test {
 protected:
  void write(const std::vector<std::pair<std::uint64_t, std::size_t>>& blobs) {
    auto writer = PageFileWriter::create(file_);
    ASSERT_TRUE(writer) << toString(writer.findings());
    for (const auto& [key, size] : blobs)
      ASSERT_TRUE((*writer)->add(key, blobOf(static_cast<std::uint32_t>(key), size)));
    ASSERT_TRUE((*writer)->finish());
  }
  test::ScratchDir dir_;
  std::filesystem::path file_ = dir_ / "x.pages";
};

TEST_F(Pages, givesEveryBlobBack) {
  write({{7, 1000}, {3, 0}, {0xfffffffffull, 70001}, {4, 1}});
  const auto pages = PageFile::open(file_);
  ASSERT_TRUE(pages) << toString(pages.findings());
  EXPECT_EQ((*pages)->size(), 4u);
  for (const auto& [key, size] : std::vector<std::pair<std::uint64_t, std::size_t>>{
           {7, 1000}, {3, 0}, {0xfffffffffull, 70001}, {4, 1}}) {
    EXPECT_EQ((*pages)->bytesOf(key), size);
    const auto blob = (*pages)->read(key);
    ASSERT_TRUE(blob);
    EXPECT_TRUE(same(*blob, blobOf(static_cast<std::uint32_t>(key), size)));
  }
  EXPECT_FALSE((*pages)->has(5));
  const auto absent = (*pages)->read(5);
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.findings().front().where, file_.string());
  EXPECT_TRUE((*pages)->checkAll());
  EXPECT_EQ((*pages)->bytes(), std::filesystem::file_size(file_));
}

TEST_F(Pages, leaveWhatOthersPutBesideThem) {
  for (const char* name : {".x.pages.part-4000000-0", ".x.pages.trimtab-notes"})
    test::writeFile(dir_ / name, "of others");
  auto first = PageFileWriter::create(file_);
  ASSERT_TRUE(first);
  ASSERT_TRUE((*first)->add(1, blobOf(1, 100)));
  write({{2, 200}});
  EXPECT_EQ(test::namesIn(dir_.path()),
            (std::vector<std::string>{".x.pages.part-4000000-0", ".x.pages.trimtab-notes", "x.pages"}));
  ASSERT_TRUE((*first)->finish());
  const auto pages = PageFile::open(file_);
  ASSERT_TRUE(pages);
  EXPECT_TRUE((*pages)->has(1));
}

TEST_F(Pages, mayBeNone) {
  write({});
  const auto pages = PageFile::open(file_);
  ASSERT_TRUE(pages) << toString(pages.findings());
  EXPECT_EQ((*pages)->size(), 0u);
  EXPECT_TRUE((*pages)->checkAll());
}

TEST_F(Pages, leaveNothingUnfinishedAndKeepWhatWasThere) {
  write({{1, 10}});
  const std::string before = test::readFile(file_);
  {
    auto writer = PageFileWriter::create(file_);
    ASSERT_TRUE(writer && (*writer)->add(2, blobOf(2, 50)));
  }
  EXPECT_EQ(test::readFile(file_), before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir_.path()), {}), 1);
  EXPECT_FALSE(PageFileWriter::create(dir_ / "absent" / "y.pages"));
  auto twice = PageFileWriter::create(file_);
  ASSERT_TRUE(twice && (*twice)->add(2, blobOf(2, 50)) && (*twice)->add(2, blobOf(3, 50)));
  const auto finished = (*twice)->finish();
  ASSERT_FALSE(finished);
  EXPECT_NE(toString(finished.findings()).find("blob 2"), std::string::npos);
}

TEST_F(Pages, areWrittenByManyThreads) {
  auto writer = PageFileWriter::create(file_);
  ASSERT_TRUE(writer);
  std::vector<std::thread> threads;
  for (std::uint32_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::uint32_t k = t; k < 200; k += 4) EXPECT_TRUE((*writer)->add(k, blobOf(k, 100 + k * 37)));
    });
  for (std::thread& t : threads) t.join();
  ASSERT_TRUE((*writer)->finish());
  const auto pages = PageFile::open(file_);
  ASSERT_TRUE(pages);
  for (std::uint32_t k = 0; k < 200; ++k) {
    const auto blob = (*pages)->read(k);
    ASSERT_TRUE(blob && same(*blob, blobOf(k, 100 + k * 37))) << k;
  }
}

/// A reader that maps its file must not read past it, whatever the file says of itself.
TEST_F(Pages, sayWhereEveryFlippedByteIs) {
  write({{7, 100}, {3, 40}, {9, 64}});
  const std::string whole = test::readFile(file_);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << at % 8));
    test::writeFile(dir_ / "damaged", damaged);
    const auto pages = PageFile::open(dir_ / "damaged");
    const Result<Done> checked = pages ? (*pages)->checkAll() : Result<Done>(pages.findings());
    // Between blobs are zeros that nobody reads.
    const bool between = at >= 64 && at < whole.size() - 96 && whole[at] == 0 && checked;
    if (between) continue;
    ASSERT_FALSE(checked) << at;
    const Finding& finding = checked.findings().front();
    EXPECT_EQ(finding.where, (dir_ / "damaged").string());
    EXPECT_FALSE(finding.key.empty() || finding.expected.empty() || finding.found.empty()) << at;
  }
}

TEST_F(Pages, refuseEveryOtherLength) {
  write({{7, 100}, {3, 40}});
  const std::string whole = test::readFile(file_);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    test::writeFile(dir_ / "short", whole.substr(0, size));
    EXPECT_FALSE(PageFile::open(dir_ / "short")) << size;
  }
  test::writeFile(dir_ / "short", whole + "x");
  EXPECT_FALSE(PageFile::open(dir_ / "short"));
  EXPECT_FALSE(PageFile::open(dir_ / "absent"));
  EXPECT_FALSE(PageFile::open(dir_.path()));
}

}  // namespace
}  // namespace trimtab::terrain
