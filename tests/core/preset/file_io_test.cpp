#include "trimtab/preset/file_io.h"

#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "tests/disk_order.h"
#include "tests/support.h"
#include "trimtab/preset/preset.h"

namespace trimtab {
namespace {

using test::ScratchDir;
using ::testing::HasSubstr;

std::size_t filesIn(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(WriteAtomically, makesAndReplacesFiles) {
  const ScratchDir dir;
  ASSERT_TRUE(writeAtomically(dir / "a", "one"));
  EXPECT_EQ(test::readFile(dir / "a"), "one");
  ASSERT_TRUE(writeAtomically(dir / "a", std::string("t\0o", 3)));
  EXPECT_EQ(test::readFile(dir / "a"), std::string("t\0o", 3));
  ASSERT_TRUE(writeAtomically(dir / "a", ""));
  EXPECT_EQ(test::readFile(dir / "a"), "");
  EXPECT_EQ(filesIn(dir.path()), 1u);
}

TEST(WriteAtomically, keepsModeAndLink) {
  const ScratchDir dir;
  test::writeFile(dir / "real", "old");
  ::chmod((dir / "real").c_str(), 0640);
  std::filesystem::create_symlink("real", dir / "link");
  ASSERT_TRUE(writeAtomically(dir / "link", "new"));
  EXPECT_TRUE(std::filesystem::is_symlink(dir / "link"));
  EXPECT_EQ(test::readFile(dir / "real"), "new");
  struct stat status {};
  ASSERT_EQ(::stat((dir / "real").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
}

TEST(WriteAtomically, leavesTheOldFileOrTheNewOneWhenThePowerFails) {
  const ScratchDir dir;
  ASSERT_TRUE(writeAtomically(dir / "a", "old"));
  test::DiskOrder& order = test::DiskOrder::instance();
  order.clear();
  ASSERT_TRUE(writeAtomically(dir / "a", "new"));
  const std::vector<std::string> events = order.events();
  ASSERT_EQ(events.size(), 3u);
  EXPECT_THAT(events[0], ::testing::StartsWith("flush .a."));
  EXPECT_EQ(events[1], "rename a");
  EXPECT_EQ(events[2], "flush " + dir.path().filename().string());
}

TEST(PutInPlace, keepsWhatItCannotRename) {
  const ScratchDir dir;
  test::writeFile(dir / "unfinished", "rows");
  EXPECT_FALSE(putInPlace(dir / "unfinished", dir / "no folder" / "a"));
  EXPECT_EQ(test::readFile(dir / "unfinished"), "rows");
  EXPECT_FALSE(putInPlace(dir / "nothing", dir / "a"));
  ASSERT_TRUE(putInPlace(dir / "unfinished", dir / "a"));
  EXPECT_EQ(test::readFile(dir / "a"), "rows");
}

TEST(WriteAtomically, givesNewFilesTheUsualMode) {
  const ScratchDir dir;
  test::writeFile(dir / "ordinary", "");
  ASSERT_TRUE(writeAtomically(dir / "ours", ""));
  struct stat ordinary {
  }, ours{};
  ASSERT_EQ(::stat((dir / "ordinary").c_str(), &ordinary), 0);
  ASSERT_EQ(::stat((dir / "ours").c_str(), &ours), 0);
  EXPECT_EQ(ours.st_mode, ordinary.st_mode);
}

TEST(WriteAtomically, namesTheFileAndTheReason) {
  const ScratchDir dir;
  const auto reason = [](const std::filesystem::path& file) {
    return toString(writeAtomically(file, "x").findings());
  };
  EXPECT_THAT(reason(dir / "nowhere/a"), HasSubstr("nowhere/a: expected a folder that can be written"));
  EXPECT_THAT(reason(dir / "nowhere/a"), HasSubstr("No such file"));
  EXPECT_THAT(reason(dir.path()), HasSubstr("found a folder"));
  test::writeFile(dir / "file", "");
  EXPECT_THAT(reason(dir / "file/a"), HasSubstr("file/a"));
  EXPECT_EQ(reason("/dev/full"),
            "/dev/full: expected room and permission to write it, found No space left on device");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full")) << "a device is written to, not replaced";
}

/// Runs a check in a process of its own, because what it changes is the process's: limits, signals, the user.
bool holdsInChild(const std::function<bool()>& check) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(check() ? 0 : 1);
  int status = -1;
  return ::waitpid(child, &status, 0) == child && status == 0;
}

TEST(WriteAtomically, keepsTheOldFileWhenThereIsNoRoom) {
  const ScratchDir dir;
  test::writeFile(dir / "a", "old");
  EXPECT_TRUE(holdsInChild([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const auto written = writeAtomically(dir / "a", std::string(100000, 'x'));
    return toString(written.findings()) ==
           (dir / "a").string() + ": expected room and permission to write it, found File too large";
  }));
  EXPECT_EQ(test::readFile(dir / "a"), "old");
  EXPECT_EQ(filesIn(dir.path()), 1u) << "nothing half-written is left";
}

TEST(WriteAtomically, respectsReadOnlyFilesAndFolders) {
  const ScratchDir dir;
  std::filesystem::create_directory(dir / "open");
  test::writeFile(dir / "closed", "old");
  test::writeFile(dir / "open/closed", "old");
  ::chmod((dir / "closed").c_str(), 0644);
  ::chmod((dir / "open/closed").c_str(), 0444);
  ::chmod((dir / "open").c_str(), 0777);
  ::chmod(dir.path().c_str(), 0555);
  EXPECT_TRUE(holdsInChild([&] {
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) return false;
    return !writeAtomically(dir / "new", "new") && !writeAtomically(dir / "closed", "new") &&
           !writeAtomically(dir / "open/closed", "new") && writeAtomically(dir / "open/new", "new").ok();
  }));
  ::chmod(dir.path().c_str(), 0755);
  EXPECT_EQ(test::readFile(dir / "closed"), "old");
  EXPECT_EQ(test::readFile(dir / "open/closed"), "old");
  EXPECT_EQ(test::readFile(dir / "open/new"), "new");
}

TEST(WriteAtomically, replacesAFileThatMayBeWrittenButNotRead) {
  const ScratchDir dir;
  test::writeFile(dir / "a", "old");
  EXPECT_TRUE(holdsInChild([&] {
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && (::chown(dir.path().c_str(), kNobody, kNobody) != 0 ||
                             ::chown((dir / "a").c_str(), kNobody, kNobody) != 0 || ::setuid(kNobody) != 0))
      return false;
    return ::chmod((dir / "a").c_str(), 0200) == 0 && writeAtomically(dir / "a", "new").ok();
  }));
  struct stat status {};
  ASSERT_EQ(::stat((dir / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0200u);
  ::chmod((dir / "a").c_str(), 0600);
  EXPECT_EQ(test::readFile(dir / "a"), "new");
  EXPECT_EQ(filesIn(dir.path()), 1u);
}

TEST(ReadWhole, readsBytesAndRefusesTheRest) {
  const ScratchDir dir;
  test::writeFile(dir / "a", std::string("t\0o", 3));
  EXPECT_EQ(*readWhole(dir / "a"), std::string("t\0o", 3));
  EXPECT_THAT(toString(readWhole(dir.path()).findings()), HasSubstr("found a folder"));
  EXPECT_THAT(toString(readWhole(dir / "none").findings()), HasSubstr("No such file"));
  EXPECT_THAT(toString(readWhole("/dev/zero").findings()), HasSubstr("16 MiB"));
}

}  // namespace
}  // namespace trimtab
