#include <gmock/gmock.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <map>
#include <thread>

#include "app/harness/results.h"
#include "tests/app/small_run.h"
#include "tests/child.h"

namespace trimtab::harness {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class BenchCommand : public test::SmallRun {
 protected:
  static std::string command(const fs::path& out, const std::string& more = "") {
    return cli() + " bench --terrain " + database() + " --flight " + flight() +
           " --preset default as-published --size 96x64 --frames 6 --repeats 1 " + more + " -o " +
           out.string();
  }
};

std::string withoutTimes(const Results& results) {
  std::string text;
  for (const Unit& unit : results.units)
    for (const MeasuredFrame& frame : unit.frames) {
      text += unit.name.preset + ' ' + unit.name.method + ' ' + std::to_string(frame.row);
      for (const Quantity& quantity : quantities())
        if (quantity.kind != Quantity::Kind::cost) {
          const double value = quantity.of(frame);
          text += ' ' + (std::isnan(value) ? "nan" : std::to_string(std::bit_cast<std::uint64_t>(value)));
        }
      text += '\n';
    }
  return text;
}
std::string withoutTimes(const fs::path& folder) {
  const auto results = parseResults(test::readFile(folder / "results.json"), folder.string());
  EXPECT_TRUE(results) << toString(results.findings());
  return results ? withoutTimes(*results) : std::string();
}

std::map<std::string, fs::file_time_type> partsOf(const fs::path& folder) {
  std::map<std::string, fs::file_time_type> parts;
  std::error_code absent;
  for (const auto& entry : fs::directory_iterator(folder / "parts", absent))
    if (entry.path().extension() == ".json" && !entry.path().filename().string().starts_with("."))
      parts[entry.path().filename().string()] = entry.last_write_time();
  return parts;
}

TEST_F(BenchCommand, printsOneDocumentAndKeepsReportTableAndPictures) {
  const test::ScratchDir dir;
  const test::Ran ran = test::run(command(dir / "out", "--json"));
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const auto results = parseResults(ran.out, "standard output");
  ASSERT_TRUE(results) << toString(results.findings());
  EXPECT_EQ(ran.out, test::readFile(dir / "out" / "results.json"));
  EXPECT_EQ(results->units.size(), 6u);
  EXPECT_EQ(results->units.front().name.flight, "hop");
  EXPECT_EQ(results->units.back().name.preset, "as-published");
  EXPECT_THAT(ran.err, HasSubstr("hop, frame 6 of 6, about"));
  for (const char* name : {"frames.csv", "report.html", "plan.json"})
    EXPECT_GT(test::readFile(dir / "out" / name).size(), 100u) << name;

  // The same again, as text: only times may differ, and here not even they, for nothing is measured twice.
  const test::Ran again = test::run(command(dir / "out"));
  ASSERT_EQ(again.exitCode, 0) << again.err;
  for (const char* said : {"median ms", "p95 ms", "wrongly culled px", "over that", "95 %", "as-published"})
    EXPECT_THAT(again.out, HasSubstr(said));
  const test::Ran elsewhere = test::run(command(dir / "other"));
  ASSERT_EQ(elsewhere.exitCode, 0) << elsewhere.err;
  EXPECT_EQ(withoutTimes(dir / "other"), withoutTimes(dir / "out"));
}

TEST_F(BenchCommand, sweepsTwoParametersAndAnswersWhichFits) {
  const test::ScratchDir dir;
  const std::string sweep = cli() + " bench --terrain " + database() + " --flight " + flight() +
                            " --cases proposed --size 64x48 --frames 2 --repeats 1 -o " +
                            (dir / "out").string() + " --sweep lod.screen_space_error_px=0.25,16";
  const test::Ran ran = test::run(sweep + " --sweep lod.level_spread=1,1.5 --json");
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const auto results = parseResults(ran.out, "standard output");
  ASSERT_TRUE(results) << toString(results.findings());
  ASSERT_EQ(results->units.size(), 4u);
  EXPECT_EQ(results->units[1].name.preset, "default lod.screen_space_error_px=0.25 lod.level_spread=1.5");
  EXPECT_LT(results->units[2].frames[0].counts.triangles, results->units[0].frames[0].counts.triangles);
  EXPECT_THAT(ran.out, HasSubstr("\"over_budget_share\""));

  const std::string more = " --sweep fuzzy.hysteresis=0 --sweep lod.level_spread=1";
  EXPECT_THAT(test::run(sweep + more).err, HasSubstr("at most two parameters"));
  EXPECT_THAT(test::run(sweep + " --sweep fuzzy.hysteresis=").err, HasSubstr("--sweep"));
}

TEST_F(BenchCommand, goesOnWhereItWasKilled) {
  const test::ScratchDir dir;
  ASSERT_EQ(test::run(command(dir / "whole")).exitCode, 0);
  // Killed, not asked, once the second frame is there.
  const std::string parts = (dir / "out" / "parts").string();
  const test::Ran killed = test::run(command(dir / "out") + " & pid=$!; n=0; while [ $(ls " + parts +
                                     " 2>/dev/null | wc -l) -lt 2 ] && [ $n -lt 3000 ]; do sleep 0.01; " +
                                     "n=$((n+1)); done; kill -KILL $pid; wait $pid");
  EXPECT_EQ(killed.exitCode, 128 + 9) << killed.err;
  const auto before = partsOf(dir / "out");
  ASSERT_GE(before.size(), 2u);
  ASSERT_LT(before.size(), 6u) << "it was done before it could be killed";
  EXPECT_FALSE(fs::exists(dir / "out" / "results.json"));

  const test::Ran ran = test::run(command(dir / "out"));
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_EQ(withoutTimes(dir / "out"), withoutTimes(dir / "whole"));
  const auto after = partsOf(dir / "out");
  for (const auto& [name, time] : before) EXPECT_EQ(after.at(name), time) << name << " was measured again";
}

TEST_F(BenchCommand, stopsWhenInterruptedAndKeepsWhatIsThere) {
  const test::ScratchDir dir;
  const std::string parts = (dir / "out" / "parts").string();
  const test::Ran ran =
      test::run("set -m; " + command(dir / "out") + " & pid=$!; n=0; while [ $(ls " + parts +
                " 2>/dev/null | wc -l) -lt 1 ] && [ $n -lt 3000 ]; do sleep 0.01; " +
                "n=$((n+1)); done; kill -INT $pid; wait $pid");
  EXPECT_EQ(ran.exitCode, 1) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("it was cancelled"));
  EXPECT_GE(partsOf(dir / "out").size(), 1u);
  EXPECT_FALSE(fs::exists(dir / "out" / "results.json"));
  for (const auto& entry : fs::recursive_directory_iterator(dir / "out"))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path() << " is half a file";
  EXPECT_EQ(test::run(command(dir / "out")).exitCode, 0);
}

/// As Ctrl+Z and `fg` do it in a terminal.
TEST_F(BenchCommand, pausesBetweenImagesSoThatNoTimeHasThePauseInIt) {
  const test::ScratchDir dir;
  const std::string out = (dir / "out").string();
  test::Background bench({cli(), "bench", "--terrain", database(), "--flight", flight(), "--cases", "none",
                          "--size", "96x64", "--frames", "20", "--repeats", "1", "-o", out},
                         dir / "err", true);
  ASSERT_TRUE(test::until([&] { return !partsOf(out).empty(); })) << bench.err();
  EXPECT_TRUE(test::hasSignal(bench.pid(), "SigBlk:", SIGTSTP)) << "it stops only where it times nothing";
  for (int i = 0; i < 3; ++i) {
    ::kill(bench.pid(), SIGTSTP);
    ASSERT_TRUE(test::until([&] { return test::isStopped(bench.pid()); })) << bench.err();
    const auto before = partsOf(out);
    ASSERT_LT(before.size(), 20u) << "it was done before it could be paused";
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_EQ(partsOf(out), before);
    ::kill(bench.pid(), SIGCONT);
    ASSERT_TRUE(test::until([&] { return partsOf(out).size() > before.size(); })) << bench.err();
  }
  EXPECT_EQ(bench.end(), 0);
  const auto results = parseResults(test::readFile(dir / "out" / "results.json"), "results");
  ASSERT_TRUE(results) << toString(results.findings());
  for (const MeasuredFrame& frame : results->units.front().frames) EXPECT_LT(frame.cost.total, 1000);
}

/// A limit on the size of files stands in for a disk that fills up while the results are written.
TEST_F(BenchCommand, saysWhatWouldNotFitAndKeepsWhatItHad) {
  const test::ScratchDir dir;
  const test::Ran ran = test::run("ulimit -f 16; " + command(dir / "out"));
  EXPECT_EQ(ran.exitCode, 1);
  EXPECT_THAT(ran.err, HasSubstr((dir / "out").string()));
  EXPECT_THAT(ran.err, HasSubstr("room for "));
  EXPECT_THAT(ran.err, HasSubstr("bytes are free"));
  const auto before = partsOf(dir / "out");
  EXPECT_EQ(before.size(), 6u);
  for (const auto& entry : fs::recursive_directory_iterator(dir / "out"))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path() << " is half a file";
  ASSERT_EQ(test::run(command(dir / "out")).exitCode, 0) << "with room again it goes on";
  const auto after = partsOf(dir / "out");
  for (const auto& [name, time] : before) EXPECT_EQ(after.at(name), time) << name << " was measured again";
}

/// A disk of 64 KiB, where mounting is permitted.
TEST_F(BenchCommand, saysThatTheDiskIsFull) {
  const test::ScratchDir dir;
  const std::string disk = (dir / "disk").string();
  fs::create_directory(disk);
  const std::string mount = "mount -t tmpfs -o size=64k tmpfs " + disk;
  if (test::run("unshare -rm sh -c '" + mount + "'").exitCode != 0)
    GTEST_SKIP() << "mounting is not permitted";
  const test::Ran ran = test::run("unshare -rm sh -c '" + mount + " && " + command(fs::path(disk) / "out") +
                                  "; code=$?; ls " + disk + "/out/parts; exit $code'");
  EXPECT_EQ(ran.exitCode, 1);
  EXPECT_THAT(ran.err, HasSubstr("No space left on device"));
  EXPECT_THAT(ran.err, HasSubstr("room for "));
  EXPECT_THAT(ran.out, HasSubstr(".json")) << "what was measured is kept";
}

TEST_F(BenchCommand, putsSeveralRunsIntoOneTableAndOnePage) {
  const test::ScratchDir dir;
  ASSERT_EQ(test::run(command(dir / "a")).exitCode, 0);
  ASSERT_EQ(test::run(command(dir / "b")).exitCode, 0);
  const std::string results = cli() + " results " + (dir / "a").string() + ' ' + (dir / "b").string();
  const test::Ran ran = test::run(results + " --json -o " + (dir / "both.html").string());
  ASSERT_EQ(ran.exitCode, 0) << ran.err;
  const auto both = parseResults(ran.out, "standard output");
  ASSERT_TRUE(both) << toString(both.findings());
  const auto one = parseResults(test::readFile(dir / "a" / "results.json"), "a");
  ASSERT_TRUE(one);
  ASSERT_EQ(both->units.size(), 2 * one->units.size());
  EXPECT_EQ(both->units.front().name.flight, "hop, " + one->terrain);
  EXPECT_THAT(test::readFile(dir / "both.html"), HasSubstr("as-published"));

  ASSERT_EQ(test::run(cli() + " bench --terrain " + database() + " --flight " + flight() +
                      " --size 64x48 --frames 1 --repeats 1 -o " + (dir / "small").string())
                .exitCode,
            0);
  const test::Ran unlike = test::run(results + ' ' + (dir / "small").string() + ' ' + (dir / "no").string());
  EXPECT_EQ(unlike.exitCode, 1);
  for (const char* said : {"96x64", "64x48", "No such file"}) EXPECT_THAT(unlike.err, HasSubstr(said));
}

TEST_F(BenchCommand, tellsAllThatIsWrongWithItsInput) {
  const test::ScratchDir dir;
  const std::string out = " -o " + (dir / "out").string();
  const test::Ran ran = test::run(cli() + " bench --terrain /nowhere --flight /none.csv " + flight() +
                                  " --preset default nope --cases none,all --size 10x" + out);
  EXPECT_EQ(ran.exitCode, 1);
  for (const char* said : {"/nowhere", "/none.csv", "nope", "--cases", "none,all", "--size", "10x"})
    EXPECT_THAT(ran.err, HasSubstr(said));
  EXPECT_EQ(ran.out, "");
  EXPECT_FALSE(fs::exists(dir / "out"));

  struct {
    const char* arguments;
    const char* said;
  } const bad[] = {{"--cases ''", "--cases"},
                   {"--cases none,none", "none twice"},
                   {"--size 1000000x3", "1000000x3"},
                   {"--set cull.nothing=3", "cull.nothing=3"},
                   {"--preset default default", "default twice"}};
  for (const auto& row : bad) {
    const test::Ran refused = test::run(cli() + " bench --terrain " + database() + " --flight " + flight() +
                                        " --frames 1 --repeats 1 " + row.arguments + out);
    EXPECT_EQ(refused.exitCode, 1) << row.arguments;
    EXPECT_THAT(refused.err, HasSubstr(row.said));
  }
  EXPECT_EQ(test::run(cli() + " bench --terrain " + database() + " --flight " + flight()).exitCode, 2);
  EXPECT_EQ(test::run(command(dir / "out", "--repeats 0")).exitCode, 2);
  EXPECT_EQ(test::run(command(dir / "out", "--frames -1")).exitCode, 2);

  test::writeFile(dir / "elsewhere.csv",
                  "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n"
                  "0,10,10,5000,0,0,0\n1,10,10.001,5000,0,0,0\n");
  const test::Ran away = test::run(cli() + " bench --terrain " + database() + " --flight " +
                                   (dir / "elsewhere.csv").string() + out);
  EXPECT_EQ(away.exitCode, 1);
  EXPECT_THAT(away.err, HasSubstr("a flight over the terrain"));
  EXPECT_THAT(away.err, HasSubstr("elsewhere"));

  test::writeFile(dir / "file", "");
  EXPECT_EQ(test::run(command(dir / "file")).exitCode, 1);
  EXPECT_THAT(test::run(command(dir / "file" / "below")).err, HasSubstr("a folder"));
  EXPECT_THAT(test::run(command("/proc/trimtab")).err, HasSubstr("/proc/trimtab"));
}

}  // namespace
}  // namespace trimtab::harness
