#include "trimtab/preset/unfinished.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

namespace fs = std::filesystem;
using test::ScratchDir;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

bool isTile(const fs::path& inFolder) {
  return inFolder == "tiles" || inFolder.extension() == ".tile";
}

class UnfinishedWork : public ::testing::Test {
 protected:
  /// What a program leaves that is killed while it makes a folder. Returns the folder's name.
  std::string leaveAFolder() const {
    const pid_t child = ::fork();
    if (child == 0) {
      auto made = Unfinished::folder(target_, isTile);
      fs::create_directory(made->path() / "tiles");
      test::writeFile(made->path() / "tiles/1.tile", "half");
      ::kill(::getpid(), SIGKILL);
    }
    ::waitpid(child, nullptr, 0);
    return nameLeft();
  }
  /// The same while it replaces a file.
  std::string leaveAFile() const {
    const std::string name = leaveAFolder();
    fs::remove_all(dir_ / name);
    test::writeFile(dir_ / name, "half");
    return name;
  }
  std::string nameLeft() const {
    for (const auto& entry : fs::directory_iterator(dir_.path()))
      if (entry.path().extension() == ".mark") return entry.path().stem().string();
    return {};
  }
  std::vector<std::string> names() const { return test::namesIn(dir_.path()); }

  ScratchDir dir_;
  const fs::path target_ = dir_ / "a";
};

TEST_F(UnfinishedWork, hasNoNameBeforeItIsNew) {
  auto made = Unfinished::file(target_);
  ASSERT_TRUE(made) << toString(made.findings());
  ASSERT_TRUE(made->append("whole"));
  EXPECT_THAT(names(), IsEmpty());
  EXPECT_EQ(test::readFile(made->path()), "whole") << "it can be opened all the same";
  ASSERT_TRUE(made->putInPlace());
  EXPECT_THAT(names(), ElementsAre("a"));
  ASSERT_TRUE(made->append(" and more"));
  EXPECT_EQ(test::readFile(target_), "whole and more");
}

TEST_F(UnfinishedWork, replacesWhatCameMeanwhile) {
  auto made = Unfinished::file(target_);
  ASSERT_TRUE(made && made->append("new"));
  test::writeFile(target_, "old");
  ::chmod(target_.c_str(), 0640);
  ASSERT_TRUE(made->putInPlace());
  EXPECT_EQ(test::readFile(target_), "new");
  struct stat status {};
  ASSERT_EQ(::stat(target_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
  EXPECT_THAT(names(), ElementsAre("a")) << "its mark is gone while it is still open";
}

TEST_F(UnfinishedWork, replacesNoFolderPipeOrDevice) {
  fs::create_directory(target_);
  ASSERT_EQ(::mkfifo((dir_ / "pipe").c_str(), 0600), 0);
  for (const fs::path& target : {target_, dir_ / "pipe", fs::path("/dev/null")})
    EXPECT_THAT(toString(Unfinished::file(target).findings()), HasSubstr("a file's name")) << target;
}

TEST_F(UnfinishedWork, ofAProgramThatWasKilledIsCleared) {
  leaveAFile();
  EXPECT_EQ(names().size(), 2u);
  const auto written = writeAtomically(target_, "new");
  EXPECT_TRUE(written);
  EXPECT_THAT(written.findings(), IsEmpty());
  EXPECT_THAT(names(), ElementsAre("a"));
  leaveAFolder();
  EXPECT_THAT(clearUnfinished(target_, isTile), IsEmpty());
  EXPECT_THAT(names(), ElementsAre("a"));
}

TEST_F(UnfinishedWork, ofALivingProgramIsLeftAlone) {
  auto made = Unfinished::folder(target_, isTile);
  ASSERT_TRUE(made);
  const auto before = names();
  EXPECT_THAT(clearUnfinished(target_, isTile), IsEmpty());
  EXPECT_EQ(names(), before);
  // Somebody else's process has the number of one that ended.
  const std::string mark = made->path().string() + ".mark", text = test::readFile(mark);
  fs::remove(mark);
  test::writeFile(mark, text);
  EXPECT_THAT(clearUnfinished(target_, isTile), IsEmpty()) << "it lives, locked or not";
  EXPECT_EQ(names(), before);
  const std::size_t started = text.find("started ") + 8;
  test::writeFile(mark, text.substr(0, started) + "1" + text.substr(text.find(' ', started)));
  EXPECT_THAT(clearUnfinished(target_, isTile), IsEmpty());
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(UnfinishedWork, isNotWhatOnlyHasItsName) {
  const std::string ours = leaveAFile();
  const std::string mark = test::readFile(dir_ / (ours + ".mark"));
  fs::remove(dir_ / ours);
  fs::remove(dir_ / (ours + ".mark"));
  test::writeFile(dir_ / ".a.trimtab-backup", "the user's");
  test::writeFile(dir_ / ".a.trimtab-1-0", "the user's");
  test::writeFile(dir_ / ".a.trimtab-1-0.mark", mark);
  test::writeFile(dir_ / ".a.trimtab-2-0.mark", "");
  fs::create_directory(dir_ / ".a.part-2026-11-27");
  test::writeFile(dir_ / ".a.part-2026-11-27/thesis.txt", "the user's");
  test::writeFile(dir_ / ".ab.trimtab-backup", "of another file");
  const auto before = names();
  const auto written = writeAtomically(target_, "new");
  ASSERT_TRUE(written);
  for (const std::string& name : before) EXPECT_TRUE(fs::exists(dir_ / name)) << name;
  EXPECT_EQ(written.findings().size(), 5u) << toString(written.findings());
  for (const Finding& finding : written.findings()) EXPECT_EQ(finding.severity, Severity::warning);
  for (const char* name :
       {".a.trimtab-backup", ".a.trimtab-1-0", ".a.trimtab-2-0.mark", ".a.part-2026-11-27"})
    EXPECT_THAT(toString(written.findings()), HasSubstr(name));
}

TEST_F(UnfinishedWork, keepsWhatOthersPutIntoItsFolder) {
  const std::string folder = leaveAFolder();
  test::writeFile(dir_ / folder / "thesis.txt", "the user's");
  fs::create_symlink("thesis.txt", dir_ / folder / "link.tile");
  const Findings findings = clearUnfinished(target_, isTile);
  EXPECT_THAT(toString(findings), AllOf(HasSubstr(folder), HasSubstr("left as it is")));
  EXPECT_THAT(test::namesIn(dir_ / folder), ElementsAre("link.tile", "thesis.txt"));
  fs::remove_all(dir_ / folder);
  EXPECT_THAT(clearUnfinished(target_, isTile), IsEmpty());
  EXPECT_THAT(names(), IsEmpty()) << "a mark of nothing";
}

TEST_F(UnfinishedWork, inAMarkedFolderIsRemovedWithIt) {
  fs::create_directory(target_);
  EXPECT_FALSE(isMarked(target_));
  ASSERT_TRUE(markFolder(target_));
  ASSERT_TRUE(markFolder(target_)) << "again";
  EXPECT_TRUE(isMarked(target_));
  fs::create_directory(target_ / "tiles");
  test::writeFile(target_ / "tiles/1.tile", "");
  test::writeFile(target_ / "kept.tile", "");
  test::writeFile(target_ / "thesis.txt", "the user's");
  const auto removed = removeOwn(target_, isTile, {"kept.tile"});
  ASSERT_TRUE(removed);
  ASSERT_EQ(removed.findings().size(), 1u) << toString(removed.findings());
  EXPECT_EQ(removed.findings().front().where, (target_ / "thesis.txt").string());
  EXPECT_THAT(test::namesIn(target_), ElementsAre("kept.tile", "thesis.txt", "trimtab.mark"));
  fs::remove(target_ / "thesis.txt");
  EXPECT_THAT(removeOwn(target_, isTile).findings(), IsEmpty());
  EXPECT_THAT(names(), IsEmpty());
}

}  // namespace
}  // namespace trimtab
