#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>

#include "tests/app/small_run.h"
#include "tests/child.h"

/// `trimtab-cli tune` as a user calls it.
namespace trimtab::tune {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class TuneCommand : public test::SmallRun {
 protected:
  static std::vector<std::string> arguments(const fs::path& out, const std::vector<std::string>& more = {}) {
    std::vector<std::string> all{"tune",
                                 "--terrain",
                                 database(),
                                 "--flight",
                                 flight(),
                                 "--hold-out",
                                 flight("skip"),
                                 "--free",
                                 "lod.*",
                                 "--size",
                                 "160x96",
                                 "--samples",
                                 "3",
                                 "--frames",
                                 "3",
                                 "--repeats",
                                 "1",
                                 "--points",
                                 "2",
                                 "--evaluations",
                                 "4000",
                                 "-o",
                                 out.string()};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  static test::Ran tune(const fs::path& out, const std::vector<std::string>& more = {}) {
    std::string command = cli();
    for (const std::string& argument : arguments(out, more)) command += " '" + argument + '\'';
    return test::run(command);
  }
};

TEST_F(TuneCommand, answersInOneSentenceAndLeavesPresets) {
  const test::ScratchDir dir;
  const auto done = tune(dir / "out", {"--max-error", "0.05"});
  ASSERT_EQ(done.exitCode, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("Within a mean FLIP of 0.05 on "));
  EXPECT_TRUE(fs::exists(dir / "out" / "presets" / "tuned-1.json"));
  EXPECT_TRUE(fs::exists(dir / "out" / "tune-measured.csv"));
}

TEST_F(TuneCommand, killedItGoesOnToTheSameBits) {
  const test::ScratchDir dir;
  const std::vector<std::string> more{"--searches", "4"};
  ASSERT_EQ(tune(dir / "whole", more).exitCode, 0);
  fs::create_directory(dir / "killed");
  for (const char* name : {"tune-plan.json", "samples-0.json", "samples-1.json"})
    fs::copy_file(dir / "whole" / name, dir / "killed" / name);
  std::vector<std::string> command{cli()};
  for (const std::string& argument : arguments(dir / "killed", more)) command.push_back(argument);
  test::Background run(command, dir / "err");
  ASSERT_TRUE(test::until([&] { return fs::exists(dir / "killed" / "search-1.json"); }));
  run.end(SIGKILL);
  EXPECT_FALSE(fs::exists(dir / "killed" / "search-3.json")) << "it was killed in its work";
  const auto resumed = tune(dir / "killed", more);
  ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
  for (int s = 0; s < 4; ++s) {
    const std::string name = "search-" + std::to_string(s) + ".json";
    EXPECT_EQ(test::readFile(dir / "killed" / name), test::readFile(dir / "whole" / name)) << name;
  }
}

/// A disk of 32 KiB, where mounting is permitted.
TEST_F(TuneCommand, saysThatTheDiskIsFullAndGoesOnOnceItIsNot) {
  const test::ScratchDir dir;
  const std::string disk = (dir / "disk").string();
  fs::create_directory(disk);
  std::string command = cli();
  for (const std::string& argument : arguments(fs::path(disk) / "out", {"--searches", "8"}))
    command += " \"" + argument + '"';
  const std::string mount = "mount -t tmpfs -o size=32k tmpfs " + disk;
  if (test::run("unshare -rm sh -c '" + mount + "'").exitCode != 0)
    GTEST_SKIP() << "mounting is not permitted";
  const test::Ran full =
      test::run("unshare -rm sh -c '" + mount + " && { " + command + "; echo $? $(ls " + disk +
                "/out); mount -o remount,size=64m " + disk + " && " + command + "; echo $?; }'");
  EXPECT_THAT(full.err, HasSubstr("No space left on device"));
  EXPECT_THAT(full.err, HasSubstr(disk + "/out/"));
  EXPECT_THAT(full.out, testing::StartsWith("1 samples-0.json")) << "what was finished is kept";
  EXPECT_THAT(full.out, testing::EndsWith("\n0\n")) << full.err;
}

/// Two days may have a flight of one name each.
TEST_F(TuneCommand, flightsOfOneNameAreToldApartByTheirFolders) {
  const test::ScratchDir dir;
  fs::copy_file(flight("skip"), dir / "hop.csv");
  std::vector<std::string> words = arguments(dir / "out");
  std::replace(words.begin(), words.end(), flight("skip"), (dir / "hop.csv").string());
  std::string command = cli();
  for (const std::string& word : words) command += " '" + word + '\'';
  const test::Ran done = test::run(command);
  ASSERT_EQ(done.exitCode, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr((dir / "hop.csv").string()));
}

TEST_F(TuneCommand, badOptionsAreNamed) {
  const test::ScratchDir dir;
  const auto refusal = [&](const std::vector<std::string>& more) {
    const auto done = tune(dir / "out", more);
    EXPECT_NE(done.exitCode, 0);
    return done.err + done.out;
  };
  EXPECT_THAT(refusal({"--part", "3/2"}), HasSubstr("I/N with I from 1 to N"));
  EXPECT_THAT(refusal({"--budget-ms", "5", "--max-error", "0.1"}), HasSubstr("excludes"));
  EXPECT_THAT(refusal({"--budget-ms", "-5"}), HasSubstr("--budget-ms"));
  EXPECT_THAT(refusal({"--error", "psnr"}), HasSubstr("--error: psnr"));
  EXPECT_THAT(refusal({"--error", "pop"}), HasSubstr("at least 20"));
  EXPECT_THAT(refusal({"--error", "geometric", "--max-error", "40"}), HasSubstr("at most 32"));
  EXPECT_THAT(refusal({"--flight", "nowhere.csv"}), HasSubstr("nowhere.csv"));
  test::writeFile(dir / "words.csv", "once,upon\na,time\n");
  EXPECT_THAT(refusal({"--hold-out", (dir / "words.csv").string()}), HasSubstr("words.csv"));
  fs::copy_file(flight(), dir / "jump.csv");
  EXPECT_THAT(refusal({"--hold-out", (dir / "jump.csv").string()}),
              HasSubstr("jump, which flies as hop does"));
  EXPECT_THAT(refusal({"--free", "lod.scale=3..1"}), HasSubstr("LOW below HIGH"));
  EXPECT_THAT(refusal({"--free", "objects.error_px=2..900"}), HasSubstr("ends within"));
  EXPECT_THAT(refusal({"--budget-ms", "5000"}), HasSubstr("0.1 to 1000 ms"));
  EXPECT_FALSE(fs::exists(dir / "out")) << "nothing is left of what was refused";
}

}  // namespace
}  // namespace trimtab::tune
