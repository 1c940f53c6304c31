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
  EXPECT_THAT(refusal({"--flight", "nowhere.csv"}), HasSubstr("nowhere.csv"));
  EXPECT_FALSE(fs::exists(dir / "out")) << "nothing is left of what was refused";
}

}  // namespace
}  // namespace trimtab::tune
