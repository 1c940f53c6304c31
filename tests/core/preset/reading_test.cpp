#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <thread>

#include "tests/child.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/stop_request.h"

namespace trimtab {
namespace {

namespace fs = std::filesystem;
using test::holdsInChild;
using test::ScratchDir;
using ::testing::HasSubstr;

std::string refusalOf(const fs::path& file) {
  return toString(readWhole(file).findings());
}

TEST(ReadWhole, refusesDevicesAndWhatTheKernelMakesUpByAnyName) {
  const ScratchDir dir;
  EXPECT_EQ(refusalOf("/dev/zero"),
            "/dev/zero: expected a file on a disk, or a pipe that ends, found a device");
  EXPECT_THAT(refusalOf("/proc/cpuinfo"), HasSubstr("found a part of /proc or /sys"));
  EXPECT_THAT(refusalOf("/sys/kernel/mm/transparent_hugepage/enabled"), HasSubstr("found"));
  for (const char* const file : {"/proc/kmsg", "/proc/self/status", "/dev/random"}) {
    fs::remove(dir / "link");
    fs::create_symlink(file, dir / "link");
    EXPECT_THAT(refusalOf(dir / "link"), HasSubstr((dir / "link").string() + ": expected a file on a disk"))
        << file;
  }
  EXPECT_FALSE(checkIsData("/proc"));
  EXPECT_FALSE(checkIsData("/sys/kernel"));
  EXPECT_FALSE(checkIsData("/proc/self/fd"));
  EXPECT_TRUE(checkIsData("/proc/self/cwd")) << "it leads to a folder on a disk";
  EXPECT_TRUE(checkIsData(dir.path()));
  EXPECT_TRUE(checkIsData(dir / "nothing"));
}

TEST(ReadWhole, readsPipesAndFilesThatProcNames) {
  const ScratchDir dir;
  test::writeFile(dir / "a", "bytes");
  const int file = ::open((dir / "a").c_str(), O_RDONLY | O_CLOEXEC);
  for (const std::string folder : {"/dev/fd/", "/proc/self/fd/"})
    EXPECT_EQ(*readWhole(folder + std::to_string(file)), "bytes");
  fs::remove(dir / "a");
  EXPECT_EQ(*readWhole("/proc/self/fd/" + std::to_string(file)), "bytes") << "though it has no name any more";
  ::close(file);
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  ASSERT_EQ(::write(ends[1], "piped", 5), 5);
  ::close(ends[1]);
  EXPECT_EQ(*readWhole("/dev/fd/" + std::to_string(ends[0])), "piped");
  ::close(ends[0]);
  EXPECT_EQ(*readWhole("/dev/null"), "");
}

TEST(ReadWhole, takesNoMoreFromAPipeThanItMay) {
  const ScratchDir dir;
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  ::signal(SIGPIPE, SIG_IGN);
  const std::string much(std::size_t{65} << 20, 'x');
  std::atomic<bool> written{false};
  std::thread writer([&] {
    test::writeFile(dir / "pipe", much);
    written = true;
  });
  // On a machine that is busy with other things 64 MiB may take longer than a pipe is given.
  EXPECT_THAT(toString(readWhole(dir / "pipe", kLargestRecording).findings()),
              testing::AnyOf(HasSubstr("at most 64 MiB"), HasSubstr("after five seconds")));
  // A writer that comes after the reader has given up would wait for another one for ever.
  for (; !written; std::this_thread::sleep_for(std::chrono::milliseconds(1)))
    if (const int reader = ::open((dir / "pipe").c_str(), O_RDONLY | O_NONBLOCK); reader >= 0)
      ::close(reader);
  writer.join();
}

TEST(ReadWhole, endsItsWaitWhenTheProgramIsAskedToStop) {
  const ScratchDir dir;
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  EXPECT_TRUE(holdsInChild([&] {
    const int held = ::open((dir / "pipe").c_str(), O_RDWR | O_CLOEXEC);
    std::atomic<bool> read{false};
    // A byte now and then, so that nothing but the request ends the wait in its first seconds.
    std::thread other([&] {
      for (int i = 0; !read; ++i) {
        if (::write(held, "x", 1) != 1) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (i == 2) requestStop();
      }
    });
    const std::string refusal = refusalOf(dir / "pipe");
    read = true;
    other.join();
    return stopRequested() && refusal.find("found a request to stop the program") != std::string::npos;
  }));
  EXPECT_TRUE(holdsInChild([&] {
    test::writeFile(dir / "a", "kept");
    requestStop();
    return *readWhole(dir / "a") == "kept";
  })) << "what ends by itself is read, since unsaved work may depend on it";
}

// A sanitizer needs more address space than the limit leaves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(ReadWhole, takesTheMemoryThatItNeedsAndNamesTheFileIfThereIsTooLittle) {
  const ScratchDir dir;
  test::writeFile(dir / "sparse", "text");
  fs::resize_file(dir / "sparse", std::uintmax_t{3900} << 20);
  EXPECT_TRUE(holdsInChild([&] {
    const rlimit limit{rlim_t{800} << 20, rlim_t{800} << 20};
    ::setrlimit(RLIMIT_AS, &limit);
    const auto read = readWhole(dir / "sparse", kLargestRecording);
    return toString(read.findings()) ==
           (dir / "sparse").string() +
               ": expected a file that this program's memory can hold, found a larger one";
  }));
  EXPECT_EQ(withinMemory(dir / "a", []() -> Result<int> { throw std::bad_alloc(); }).findings()[0].where,
            (dir / "a").string());
}
#endif

TEST(VisitFiles, leavesOutWhatIsNoDataAndSaysSoOfTheFolderItself) {
  const ScratchDir dir;
  fs::create_directories(dir / "a/b");
  for (const char* const name : {"1", "a/2", "a/b/3"}) test::writeFile(dir / name, "");
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  fs::create_symlink("/proc/kmsg", dir / "kernel");
  fs::create_directory_symlink("/proc", dir / "a/proc");
  std::vector<std::string> names;
  const auto visit = [&](const fs::path& file) {
    names.push_back(file.filename());
    return true;
  };
  ASSERT_TRUE(visitFiles(dir.path(), visit));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"1", "2", "3"}));
  std::size_t visited = 0;
  ASSERT_TRUE(visitFiles(dir.path(), [&](const fs::path&) { return ++visited < 2; }));
  EXPECT_EQ(visited, 2u);
  for (const char* const folder : {"/proc", "/sys", "/proc/self"}) {
    const auto refused = visitFiles(folder, [](const fs::path&) { return ADD_FAILURE(), true; });
    EXPECT_THAT(
        toString(refused.findings()),
        HasSubstr(std::string(folder) + ": expected a folder on a disk, found a part of /proc or /sys"));
  }
  EXPECT_TRUE(holdsInChild([&] {
    requestStop();
    return toString(visitFiles(dir.path(), visit).findings()).find("a request to stop") != std::string::npos;
  }));
}

TEST(VisitFiles, entersEachFolderOnceAndWarnsOfWhatItCannotFollow) {
  const ScratchDir dir, other;
  fs::create_directories(dir / "top/deep");
  fs::create_directories(other / "far");
  for (const fs::path& file : {dir / "top/1", dir / "top/deep/2", other / "3", other / "far/4"})
    test::writeFile(file, "");
  fs::create_directory_symlink(other.path(), dir / "top/elsewhere");
  fs::create_directory_symlink(other / "far", dir / "top/again");
  fs::create_directory_symlink(dir / "top", dir / "top/deep/up");
  fs::create_symlink("nowhere", dir / "top/lost.tif");
  std::vector<fs::path> files;
  const auto visited =
      visitFiles(dir / "top", [&](const fs::path& file) { return files.push_back(file), true; });
  ASSERT_TRUE(visited);
  std::sort(files.begin(), files.end());
  EXPECT_EQ(files, (std::vector<fs::path>{dir / "top/1", dir / "top/again/4", dir / "top/deep/2",
                                          dir / "top/elsewhere/3"}));
  ASSERT_EQ(visited.findings().size(), 1u);
  EXPECT_EQ(toString(visited.findings()[0]),
            (dir / "top/lost.tif").string() + ": expected a file or folder, found a link to nothing");
}

}  // namespace
}  // namespace trimtab
