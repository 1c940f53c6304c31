#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include "resumed_bake.h"

/// Bakes whose disk has no room, whose output cannot be renamed, or whose folder holds files of others.
namespace trimtab::terrain {
namespace {

/// A name space of its own for mounts, as root or as root of a name space of users.
bool mayMount() {
  if (::unshare(CLONE_NEWNS) == 0) return true;
  const std::string uid = std::to_string(::getuid()), gid = std::to_string(::getgid());
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) return false;
  test::writeFile("/proc/self/setgroups", "deny");
  test::writeFile("/proc/self/uid_map", "0 " + uid + " 1");
  test::writeFile("/proc/self/gid_map", "0 " + gid + " 1");
  return ::getuid() == 0;
}

/// A real file system without room.
TEST_F(ResumedBake, goesOnWhenThereIsRoomAgain) {
  const fs::path disk = dir_ / "disk";
  fs::create_directory(disk);
  std::size_t size = 0;
  for (const auto& [name, bytes] : whole_) size += bytes.size();
  const int status = ended(start([&] {
    if (!mayMount()) return 100;
    // What is mounted here stays here.
    ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=64k") != 0) return 100;
    options_.output = disk / "db";
    int refused = 0;
    for (std::size_t room = 96 * 1024; room < 4 * size; room += size / 7) {
      ::mount("tmpfs", disk.c_str(), "tmpfs", MS_REMOUNT, ("size=" + std::to_string(room)).c_str());
      const auto made = bake(options_);
      if (made) break;
      if (toString(made.findings()).find("room") == std::string::npos &&
          toString(made.findings()).find("No space") == std::string::npos) {
        std::fprintf(stderr, "%s\n", toString(made.findings()).c_str());
        return 1;
      }
      if (fs::exists(disk / "db")) return 2;
      ++refused;
    }
    if (refused < 3 || !fs::exists(disk / "db")) return 3;
    return filesIn(disk / "db") == whole_ ? 0 : 4;
  }));
  if (status == 100) GTEST_SKIP() << "needs leave to mount";
  EXPECT_EQ(status, 0);
}

/// Who has it mounted cannot rename it: every way for the last step to fail, and nothing is lost.
TEST_F(ResumedBake, goesOnWhenItsLastStepFailed) {
  const fs::path work = dir_ / ".db.work";
  const Files before = filesIn(dir_ / "whole");
  const int status = ended(start([&] {
    if (!mayMount()) return 100;
    ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    fs::copy(dir_ / "whole", dir_ / "db");
    options_.maxError = Metres{60};
    // The output that cannot go, then the new one that cannot come once the old is gone.
    for (const fs::path& held : {dir_ / "db", work / "database"}) {
      options_.progress = [&](double, const std::string& what) {
        if (what == "writing") ::mount(held.c_str(), held.c_str(), nullptr, MS_BIND, nullptr);
        return true;
      };
      const auto made = bake(options_);
      if (::umount(held.c_str()) != 0) return 100;
      if (made) return 1;
      if (filesIn(dir_ / "db") != before) return 2;
      if (!fs::exists(work / "recipe.json") || fs::exists(work / "old")) return 3;
    }
    options_.progress = nullptr;
    const auto made = bake(options_);
    if (!made || toString(made.findings()).find("goes on") == std::string::npos) return 4;
    return filesIn(dir_ / "db") == before || fs::exists(work) ? 5 : 0;
  }));
  if (status == 100) GTEST_SKIP() << "needs leave to mount";
  EXPECT_EQ(status, 0);
}

TEST_F(ResumedBake, refusesAMountPointBeforeItBegins) {
  const fs::path disk = dir_ / "disk";
  fs::create_directory(disk);
  const int status = ended(start([&] {
    if (!mayMount()) return 100;
    ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=64m") != 0) return 100;
    options_.output = disk;
    const auto made = bake(options_);
    if (made || fs::exists(dir_ / ".disk.work")) return 1;
    return toString(made.findings()).find("mount point") == std::string::npos ? 2 : 0;
  }));
  if (status == 100) GTEST_SKIP() << "needs leave to mount";
  EXPECT_EQ(status, 0);
}

/// Another recipe empties the folder, and the end removes it: both of what a bake made there.
TEST_F(ResumedBake, leavesWhatOthersPutIntoItsFolder) {
  options_.maxError = Metres{5};
  ASSERT_TRUE(bakePart(options_, 1, 2));
  const fs::path work = dir_ / ".db.work";
  fs::create_directory(work / "mine");
  for (const char* name : {"thesis.txt", "mine/thesis.txt", "pieces/thesis.txt"})
    test::writeFile(work / name, "mine");
  options_.maxError = Metres{20};
  const auto made = bake(options_);
  ASSERT_TRUE(made) << toString(made.findings());
  expectWhole(dir_ / "db");
  for (const char* name : {"thesis.txt", "mine/thesis.txt", "pieces/thesis.txt"})
    EXPECT_EQ(test::readFile(work / name), "mine") << name;
  EXPECT_EQ(test::namesIn(work), (std::vector<std::string>{"mine", "pieces", "thesis.txt", "trimtab.mark"}));
  for (const char* name : {"thesis.txt", "mine", "pieces/thesis.txt"})
    EXPECT_NE(toString(made.findings()).find((work / name).string() + ": expected nothing"),
              std::string::npos)
        << name << toString(made.findings());
  EXPECT_TRUE(bake(options_)) << "it is still a bake's";
}

TEST_F(ResumedBake, waitsForNoPipeInItsFolder) {
  ASSERT_TRUE(bakePart(options_, 1, 2));
  fs::remove(dir_ / ".db.work/journal");
  ASSERT_EQ(::mkfifo((dir_ / ".db.work/journal").c_str(), 0600), 0);
  const pid_t child = start([&] {
    ::alarm(60);
    return bake(options_) ? 0 : 1;
  });
  EXPECT_EQ(ended(child), 1);
  EXPECT_TRUE(fs::is_fifo(dir_ / ".db.work/journal"));
}

}  // namespace
}  // namespace trimtab::terrain
