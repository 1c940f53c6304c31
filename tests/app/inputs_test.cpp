#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <atomic>

#include "ig_support.h"
#include "tests/child.h"
#include "trimtab/preset/preset.h"

/// What the programs do with inputs that are no plain files, and with files too large for their memory.
namespace trimtab {
namespace {

namespace fs = std::filesystem;
using test::Background;
using test::Ran;
using ::testing::HasSubstr;
using ::testing::Not;

std::string cli(const std::string& arguments) {
  return test::program("trimtab-cli").string() + " " + arguments;
}

class Inputs : public ::testing::Test {
 protected:
  Inputs() {
    test::writeFile(dir_ / "p.json", test::exported(defaultParameters()));
    test::writeFile(dir_ / "f.csv", flightCsv(test::weavingFlight(2)));
  }
  std::string at(const char* name) const { return (dir_ / name).string(); }
  std::string ig(const std::string& preset, const std::string& terrain, const std::string& more) const {
    return "XDG_CACHE_HOME=" + at("cache") + " " + test::program("trimtab-ig").string() + " --preset " +
           preset + " --terrain " + terrain + " --headless --size 64x64 " + more;
  }

  test::ScratchDir dir_;
};

TEST_F(Inputs, devicesAndFilesOfTheKernelAreRefusedByNameInEveryProgram) {
  const std::string terrain = test::smallTerrain().string(), device = "/dev/zero", kernel = "/proc/kmsg";
  fs::create_symlink(kernel, dir_ / "link.csv");
  const std::pair<std::string, std::string> cases[] = {
      {cli("preset check " + device), device},
      {cli("preset check " + kernel), kernel},
      {cli("decide --preset default --flight " + kernel), kernel},
      {cli("decide --preset default --flight " + at("link.csv")), at("link.csv")},
      {cli("feed play " + device + " --to 127.0.0.1:9 --protocol cigi3"), device},
      {cli("feed play " + at("f.csv") + " --head " + kernel + " --to 127.0.0.1:9 --protocol cigi3"), kernel},
      {cli("bench --terrain /proc --flight " + at("f.csv") + " -o " + at("out")), "/proc"},
      {cli("terrain bake /proc -o " + at("db")), "/proc"},
      {cli("terrain bake /sys -o " + at("db")), "/sys"},
      {cli("terrain bake " + kernel + " -o " + at("db")), kernel},
      {cli("terrain bake " + device + " -o " + at("db")), device},
      {cli("terrain picture " + kernel + " -o " + at("t.tif")), kernel},
      {cli("terrain info /proc"), "/proc"},
      {ig(device, terrain, "--flight " + at("f.csv")), device},
      {ig("default", terrain, "--flight " + kernel), kernel},
      {ig("default", terrain, "--flight " + at("f.csv") + " --head " + device), device},
      {ig("default", "/proc", "--flight " + at("f.csv")), "/proc"}};
  for (const auto& [command, name] : cases) {
    const Ran ran = test::run(command);
    EXPECT_EQ(ran.exitCode, 1) << command << '\n' << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("error: " + name)) << command;
  }
  EXPECT_THAT(test::run(cases[0].first).err, HasSubstr("found a device"));
  EXPECT_THAT(test::run(cases[7].first).err,
              HasSubstr("/proc: expected a folder on a disk, found a part of /proc"));
}

TEST_F(Inputs, pipesAndStandardInputAreRead) {
  const std::string terrain = test::smallTerrain().string(), preset = at("p.json");
  for (const std::string& command :
       {cli("preset check <(cat " + preset + ")"), cli("preset check /dev/stdin <" + preset),
        "cat " + preset + " | " + cli("preset check /dev/stdin"),
        ig("<(cat " + preset + ")", terrain, "--flight <(cat " + at("f.csv") + ")")}) {
    test::writeFile(dir_ / "command", command);
    const Ran ran = test::run("bash " + at("command"));
    EXPECT_EQ(ran.exitCode, 0) << command << '\n' << ran.err;
  }
}

TEST_F(Inputs, aReadThatWaitsEndsAtTheFirstSignal) {
  struct Case {
    std::vector<std::string> command;
    int exitCode;
    const char* says;
  };
  const std::string pipe = at("pipe");
  const Case cases[] = {{{test::program("trimtab-cli").string(), "preset", "check", pipe}, 128 + SIGTERM, ""},
                        {{test::program("trimtab-cli").string(), "feed", "play", pipe, "--to", "127.0.0.1:9",
                          "--protocol", "cigi3"},
                         1,
                         "found a request to stop the program"},
                        {{test::program("trimtab-ig").string(), "--preset", pipe, "--terrain",
                          test::smallTerrain().string(), "--flight", at("f.csv"), "--headless"},
                         1,
                         "found a request to stop the program"}};
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  ::signal(SIGPIPE, SIG_IGN);
  for (const Case& c : cases) {
    Background program(c.command, dir_ / "err");
    // Without a wait for it, the signal could come before the program reads.
    int held = -1;
    ASSERT_TRUE(
        test::until([&] { return (held = ::open(pipe.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC)) >= 0; }));
    std::atomic<bool> ended{false};
    std::thread writer([&] {
      // Bytes keep it reading for its five seconds.
      while (!ended && ::write(held, " ", 1) == 1) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    });
    EXPECT_EQ(program.end(SIGTERM), c.exitCode) << c.command[1];
    ended = true;
    writer.join();
    ::close(held);
    EXPECT_THAT(test::readFile(dir_ / "err"), HasSubstr(c.says));
  }
}

// A sanitizer needs more address space than the limit leaves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(Inputs, aFileTooLargeForTheMemoryIsNamed) {
  test::writeFile(dir_ / "large.csv", "time_s,latitude_deg\n");
  fs::resize_file(dir_ / "large.csv", std::uintmax_t{3900} << 20);
  const std::string flight = "--flight " + at("large.csv");
  for (const std::string& command :
       {cli("decide --preset default " + flight),
        cli("feed play " + at("large.csv") + " --to 127.0.0.1:9 --protocol cigi3"),
        ig("default", test::smallTerrain().string(), flight)}) {
    const Ran ran = test::run("ulimit -v 1500000; " + command);
    EXPECT_EQ(ran.exitCode, 1) << command << '\n' << ran.err;
    EXPECT_THAT(ran.err,
                HasSubstr("error: " + at("large.csv") + ": expected a file that this program's memory"))
        << command;
    EXPECT_THAT(ran.err, Not(HasSubstr("bad_alloc")));
  }
}
#endif

TEST_F(Inputs, whatAnEditorAddsToAnExportIsNamed) {
  const std::string mark = "\xef\xbb\xbf";
  test::writeFile(dir_ / "marked.json", mark + test::readFile(dir_ / "p.json"));
  const Ran ran = test::run(cli("preset check " + at("marked.json")));
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("warning: " + at("marked.json") + ": checksum"));
  EXPECT_THAT(ran.err, HasSubstr("a byte order mark"));
  const Ran flown =
      test::run(ig(at("marked.json"), test::smallTerrain().string(), "--flight " + at("f.csv")));
  EXPECT_EQ(flown.exitCode, 0) << flown.err;
  EXPECT_THAT(flown.err, HasSubstr("a byte order mark"));
}

}  // namespace
}  // namespace trimtab
