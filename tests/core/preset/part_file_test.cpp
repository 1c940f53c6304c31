#include "trimtab/preset/part_file.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/support.h"

namespace trimtab {
namespace {

namespace fs = std::filesystem;
using test::readFile;
using ::testing::HasSubstr;

class Part : public ::testing::Test {
 protected:
  Result<PartFile> open() const { return PartFile::open(target_, "header\n"); }

  test::ScratchDir dir_;
  const fs::path target_ = dir_ / "t.csv", part_ = dir_ / "t.csv.part";
};

TEST_F(Part, growsBesideTheOldFileUntilItIsWhole) {
  test::writeFile(target_, "the old one");
  auto file = open();
  ASSERT_TRUE(file) << toString(file.findings());
  ASSERT_TRUE(file->append("row\n"));
  EXPECT_EQ(readFile(target_), "the old one");
  EXPECT_EQ(readFile(part_), "header\nrow\n") << "a crash leaves it";
  ASSERT_TRUE(file->putInPlace());
  EXPECT_EQ(readFile(target_), "header\nrow\n");
  EXPECT_FALSE(fs::exists(part_));
}

TEST_F(Part, neverWritesOverWhatIsThere) {
  for (const char* there : {"", "header", "header\nrow\n", "notes", "another\n"}) {
    test::writeFile(part_, there);
    const auto file = open();
    ASSERT_FALSE(file) << there;
    EXPECT_EQ(file.findings().front().where, part_.string());
    EXPECT_THAT(toString(file.findings()), HasSubstr("give it another name"));
    EXPECT_EQ(readFile(part_), there);
  }
  fs::remove(part_);
  test::writeFile(dir_ / "notes", "header\n");
  fs::create_symlink("notes", part_);
  EXPECT_FALSE(open()) << "a link may lead anywhere";
  fs::remove(part_);
  ASSERT_EQ(::mkfifo(part_.c_str(), 0600), 0);
  EXPECT_FALSE(open()) << "nor is a pipe waited for";
}

TEST_F(Part, goesOnFromAHeaderAloneOneAtATime) {
  test::writeFile(part_, "header\n");
  auto file = open();
  ASSERT_TRUE(file) << toString(file.findings());
  EXPECT_THAT(toString(open().findings()), HasSubstr("another program writes"));
  ASSERT_TRUE(file->append("row\n"));
  EXPECT_EQ(readFile(part_), "header\nrow\n");
  file->discard();
  EXPECT_FALSE(fs::exists(part_));
}

TEST_F(Part, neitherMovesNorRemovesAnotherFile) {
  auto file = open();
  ASSERT_TRUE(file);
  fs::rename(part_, dir_ / "mine");
  test::writeFile(part_, "notes");
  EXPECT_FALSE(file->putInPlace());
  file->discard();
  EXPECT_EQ(readFile(part_), "notes");
  EXPECT_FALSE(fs::exists(target_));
}

TEST_F(Part, refusesATargetThatCannotBeReplaced) {
  fs::create_directory(target_);
  EXPECT_THAT(toString(open().findings()), HasSubstr("a folder"));
  EXPECT_THAT(toString(PartFile::open("/dev/null", "").findings()), HasSubstr("a device"));
  EXPECT_THAT(toString(PartFile::open(dir_ / "none/t.csv", "").findings()), HasSubstr("none/t.csv"));
  EXPECT_FALSE(fs::exists(part_));
}

}  // namespace
}  // namespace trimtab
