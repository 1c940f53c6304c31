#include "bake_bench.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/synthetic/country.h"

namespace trimtab::bench {
namespace {

namespace fs = std::filesystem;

struct Baked {
  double seconds = 0, peakMb = 0, bytesAPost = 0, openSeconds = 0;
};

/// The most memory this process had at once, pages of mapped files among it.
double peakMb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::atof(line.c_str() + 6) * 1024 / 1e6;
  return std::nan("");
}

Baked bakeApart(const fs::path& source, const fs::path& output, double memoryMb) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) return {};
  const pid_t child = ::fork();
  if (child == 0) {
    std::ofstream("/proc/self/clear_refs") << "5";
    terrain::BakeOptions options;
    options.sources = {source};
    options.output = output;
    options.memory = Megabytes{memoryMb};
    const double start = monotonicSeconds();
    const auto made = terrain::bake(options);
    Baked baked{monotonicSeconds() - start, peakMb(), 0, 0};
    if (!made) std::fprintf(stderr, "%s\n", toString(made.findings()).c_str());
    if (!made || ::write(ends[1], &baked, sizeof baked) != sizeof baked) ::_exit(1);
    ::_exit(0);
  }
  ::close(ends[1]);
  Baked baked;
  const bool whole = ::read(ends[0], &baked, sizeof baked) == sizeof baked;
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  if (!whole) return {std::nan(""), std::nan(""), std::nan(""), std::nan("")};
  const double start = monotonicSeconds();
  const auto opened = terrain::Database::open(output);
  baked.openSeconds = monotonicSeconds() - start;
  if (opened)
    baked.bytesAPost = static_cast<double>((*opened)->info().bytes) /
                       (static_cast<double>((*opened)->info().columns) * (*opened)->info().rows);
  return baked;
}

void everest(Report& report, const fs::path& folder) {
  const fs::path source = test::sharedDir() / "data/dem-srtm3-everest/N27E086.hgt";
  if (!fs::exists(source)) return;
  Baked best;
  for (int turn = 0; turn < (report.quick() ? 2 : 3); ++turn) {
    const Baked baked = bakeApart(source, folder / "everest", 1024);
    if (turn == 0 || baked.seconds < best.seconds) best = baked;
  }
  constexpr double kPosts = 1201.0 * 1201.0;
  report.add(ratioAtLeast(100, {.id = "terrain.bake_everest",
                                .what = "A whole database of N27E086, tiles, patches and ground, all cores",
                                .value = kPosts / best.seconds,
                                .unit = "posts/s",
                                .peer = "osgdem, 6 levels, simplified: 80.5 s",
                                .peerValue = kPosts / 80.5,
                                .peerFrom = "quoted"}));
}

}  // namespace

void bakingRows(Report& report) {
  const test::ScratchDir dir;
  if (report.wants("bake_everest")) everest(report, dir.path());
  if (!report.wants("bake_country")) return;
  struct Size {
    const char* id;
    const char* words;
    std::uint32_t divisor;
  };
  constexpr double kMemoryMb = 1073.741824;
  Baked smaller;
  for (const Size& size :
       {Size{"16th", "a sixteenth of the country", 4}, Size{"4th", "a quarter of the country", 2},
        Size{"whole", "a country of 13,000 x 11,000 posts at 30 m", 1}}) {
    if (report.quick() && size.divisor < 4) break;
    terrain::CountryOptions country;
    country.columns /= size.divisor;
    country.rows /= size.divisor;
    const fs::path tif = dir / "country.tif", database = dir / "country";
    if (!terrain::writeCountry(tif, country)) return;
    const Baked baked = bakeApart(tif, database, kMemoryMb);
    fs::remove_all(database);
    fs::remove(tif);
    const std::string id = std::string("terrain.bake_country_") + size.id,
                      what = std::string("Baking ") + size.words;
    report.add({.id = id, .what = what, .value = baked.seconds, .unit = "s"});
    report.add(valueAtMost(kMemoryMb, {.id = id + "_memory",
                                       .what = what + ": most memory at once, mapped files counted",
                                       .value = baked.peakMb,
                                       .unit = "MB"}));
    report.add({.id = id + "_bytes",
                .what = what + ": bytes on disk",
                .value = baked.bytesAPost,
                .unit = "bytes/post"});
    report.add(valueAtMost(0.5, {.id = id + "_open",
                                 .what = "Opening " + std::string(size.words),
                                 .value = baked.openSeconds,
                                 .unit = "s"}));
    if (smaller.seconds > 0)
      report.add(valueAtMost(1.1, {.id = id + "_growth",
                                   .what = "Seconds grow by the posts to the power of, from the size before",
                                   .value = std::log(baked.seconds / smaller.seconds) / std::log(4.0),
                                   .unit = ""}));
    smaller = baked;
  }
}

}  // namespace trimtab::bench
