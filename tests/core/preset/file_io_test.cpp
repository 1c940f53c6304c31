#include "trimtab/preset/file_io.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <thread>

#include "tests/child.h"
#include "tests/disk_order.h"
#include "trimtab/preset/preset.h"

static int timesTheMaskWasSet = 0;
extern "C" mode_t umask(mode_t mask) noexcept {
  ++timesTheMaskWasSet;
  return static_cast<mode_t>(::syscall(SYS_umask, mask));
}

namespace trimtab {
namespace {

using test::holdsInChild;
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
  EXPECT_THAT(events[0], ::testing::StartsWith("flush #"));
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

/// The mask is the process's: another thread would make files that everybody may write.
TEST(WriteAtomically, neverSetsTheMaskOfThisProcess) {
  const ScratchDir dir;
  timesTheMaskWasSet = 0;
  ASSERT_TRUE(writeAtomically(dir / "new", ""));
  ASSERT_TRUE(writeAtomically(dir / "new", "replaced"));
  EXPECT_EQ(timesTheMaskWasSet, 0);
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

TEST(WriteAtomically, keepsTheOldFileWhenThereIsNoRoom) {
  const ScratchDir dir;
  test::writeFile(dir / "a", "old");
  EXPECT_TRUE(holdsInChild([&] {
    failLargeWrites();
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

TEST(WriteAtomically, waitsForNobodyAtTheOtherEndOfAPipe) {
  const ScratchDir dir;
  const std::filesystem::path pipe = dir / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(toString(writeAtomically(pipe, "x").findings()), HasSubstr("nobody reads"));
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  ASSERT_TRUE(writeAtomically(pipe, "x"));
  char got = 0;
  EXPECT_EQ(::read(reader, &got, 1), 1);
  EXPECT_THAT(toString(writeAtomically(pipe, std::string(1000000, 'x')).findings()), HasSubstr("full"));
  ::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST(WriteAtomically, byManyAtOnceLeavesOneOfTheirTexts) {
  const ScratchDir dir;
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 50; ++i) EXPECT_TRUE(writeAtomically(dir / "a", std::string(1000, char('a' + t))));
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(test::readFile(dir / "a").size(), 1000u);
  EXPECT_EQ(filesIn(dir.path()), 1u);
}

TEST(ReadWhole, waitsForNoPipeThatNobodyFillsOrEnds) {
  const ScratchDir dir;
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(toString(readWhole(dir / "pipe").findings()), HasSubstr("a pipe that ends"));
  const int held = ::open((dir / "pipe").c_str(), O_RDWR | O_CLOEXEC);
  EXPECT_EQ(::write(held, "half", 4), 4);
  EXPECT_THAT(toString(readWhole(dir / "pipe").findings()), HasSubstr("a pipe that ends"));
  ::close(held);
}

TEST(ReadWhole, readsAPipeThatEnds) {
  const ScratchDir dir;
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(dir / "pipe") << std::string(300000, 'x'); });
  const auto read = readWhole(dir / "pipe");
  writer.join();
  ASSERT_TRUE(read) << toString(read.findings());
  EXPECT_EQ(read->size(), 300000u);
}

TEST(ReadWhole, refusesWhatIsTooLargeBeforeItReadsIt) {
  const ScratchDir dir;
  test::writeFile(dir / "large", "");
  std::filesystem::resize_file(dir / "large", std::uintmax_t{1} << 40);
  EXPECT_THAT(toString(readWhole(dir / "large").findings()), HasSubstr("at most 16 MiB"));
}

TEST(CanWriteIn, leavesNothingAndSaysWhyNot) {
  const ScratchDir dir;
  test::writeFile(dir / ".trimtab-backup", "mine");
  EXPECT_TRUE(canWriteIn(dir.path()));
  EXPECT_EQ(test::namesIn(dir.path()), std::vector<std::string>{".trimtab-backup"});
  EXPECT_THAT(toString(canMake(dir / "none/a").findings()), HasSubstr("none/a: "));
  EXPECT_TRUE(makeWritable(dir / "a/b"));
  EXPECT_TRUE(std::filesystem::is_empty(dir / "a/b"));
  EXPECT_THAT(toString(canWriteIn(dir / "none").findings()), HasSubstr("No such file"));
  test::writeFile(dir / "file", "");
  EXPECT_FALSE(makeWritable(dir / "file/a"));
  EXPECT_TRUE(holdsInChild([&] {
    ::chmod(dir.path().c_str(), 0555);
    constexpr uid_t kNobody = 65534;
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) return false;
    return !canWriteIn(dir.path()) && !makeWritable(dir / "new");
  }));
  ::chmod(dir.path().c_str(), 0755);
}

TEST(ReadWhole, readsBytesAndRefusesTheRest) {
  const ScratchDir dir;
  test::writeFile(dir / "a", std::string("t\0o", 3));
  EXPECT_EQ(*readWhole(dir / "a"), std::string("t\0o", 3));
  EXPECT_THAT(toString(readWhole(dir.path()).findings()), HasSubstr("found a folder"));
  EXPECT_THAT(toString(readWhole(dir / "none").findings()), HasSubstr("No such file"));
}

}  // namespace
}  // namespace trimtab
