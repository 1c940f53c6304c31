#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

#include "row.h"
#include "tests/support.h"
#include "trimtab/host/flight.h"

/// Measures the time from the start of trimtab-ig to its first finished image, and its peak memory, against a
/// program that does only what every image generator must do to get there.
namespace trimtab::bench {
namespace {

double now() {
  timespec time{};
  ::clock_gettime(CLOCK_REALTIME, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct Child {
  double started = 0, ended = 0;
  double peakMiB = std::numeric_limits<double>::quiet_NaN();
  std::string out;
};

/// Runs a program; ends this one when it fails.
Child run(const std::vector<std::string>& arguments, const std::filesystem::path& folder) {
  std::vector<std::string> copy = arguments;
  std::vector<char*> argv;
  for (std::string& argument : copy) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const std::string out = (folder / "out").string(), err = (folder / "err").string();
  Child child;
  child.started = now();
  const pid_t pid = ::fork();
  if (pid == 0) {
    if (!std::freopen(out.c_str(), "w", stdout) || !std::freopen(err.c_str(), "w", stderr)) ::_exit(126);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  ::wait4(pid, &status, 0, &usage);
  child.ended = now();
  child.peakMiB = static_cast<double>(usage.ru_maxrss) / 1024;
  child.out = test::readFile(out);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    std::cerr << arguments[0] << " failed:\n" << test::readFile(err);
    std::exit(1);
  }
  return child;
}

struct Start {
  double seconds = std::numeric_limits<double>::infinity(), peakMiB = 0;
};
void keepLeast(Start& least, double seconds, double peakMiB) {
  if (seconds < least.seconds) least = {seconds, peakMiB};
}

int measure(Report& report) {
  const test::ScratchDir dir;
  // Mesa keeps compiled shaders below this folder: the first run of all meets none.
  ::setenv("XDG_CACHE_HOME", (dir / "cache").c_str(), 1);
  const std::string cli = test::program("trimtab-cli").string(), ig = test::program("trimtab-ig").string();
  const std::string tif = (dir / "sample.tif").string(), database = (dir / "database").string();
  // One frame in the middle of the sample at 6,000 ft, 1280 x 720, with the depth map that the default preset
  // asks for.
  Flight flight;
  flight.states.resize(1);
  flight.states[0].position = {Degrees{36.63}, Degrees{128.35}, Feet{6000}.as<Metres>()};
  test::writeFile(dir / "flight.csv", flightCsv(flight));
  const auto firstFrame = [&](const std::string& terrain) {
    return run({ig, "--preset", "default", "--terrain", terrain, "--flight", (dir / "flight.csv").string(),
                "--headless", "--json"},
               dir.path());
  };
  const auto timeOf = [](const Child& child) {
    return nlohmann::json::parse(child.out)["first_frame_unix_s"].get<double>() - child.started;
  };

  // What a newcomer waits for: the sample is made, then baked, and trimtab-ig opens the database.
  const Child sample = run({cli, "terrain", "sample", "-o", tif}, dir.path());
  const Child bake =
      run({cli, "terrain", "bake", tif, "--objects", (dir / "sample-objects.csv").string(), "-o", database},
          dir.path());
  const Child first = firstFrame(database);
  const double freshSeconds = (sample.ended - sample.started) + (bake.ended - bake.started) + timeOf(first);

  // The first run of each warms the page cache and is not counted.
  Start baked, limit;
  for (int i = 0; i <= (report.quick() ? 2 : 7); ++i) {
    const Child start = firstFrame(database);
    const Child least = run({test::program("bench_start_limit").string(), database}, dir.path());
    if (i == 0) continue;
    keepLeast(baked, timeOf(start), start.peakMiB);
    keepLeast(limit, std::stod(least.out) - least.started, least.peakMiB);
  }
  const std::string peer = "a program that opens the same kind of context and reads the database's bytes";
  report.add(ratioAtMost(
      10, {"start.baked",
           "seconds from the start of trimtab-ig to its first finished image, 100 km of terrain baked",
           baked.seconds, "s", peer, limit.seconds, "run"}));
  report.add(valueAtMost(
      1, {"start.baked_seconds", "the same by itself, with what stands on the sample in the database",
          baked.seconds, "s"}));
  report.add(ratioAtMost(3, {"start.baked_memory", "peak memory of that run", baked.peakMiB, "MiB", peer,
                             limit.peakMiB, "run"}));
  report.add(valueAtMost(
      60, {"start.sample", "seconds to make the sample, bake it and draw the first image of trimtab-ig",
           freshSeconds, "s", "the same with the terrain baked", baked.seconds, "run"}));
  report.add(valueAtMost(
      1024, {"start.sample_memory", "peak memory of that: the largest of making, baking and drawing",
             std::max({sample.peakMiB, bake.peakMiB, first.peakMiB}), "MiB",
             "the same with the terrain baked", baked.peakMiB, "run"}));
  return report.finish();
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  trimtab::bench::Report report(argc, argv);
  return trimtab::bench::measure(report);
}
