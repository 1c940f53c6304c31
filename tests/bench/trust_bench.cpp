#include <time.h>

#include <cstdlib>
#include <iostream>
#include <tuple>

#include "bench_scene.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/unchecked.h"

/// Measures what it costs that every byte of a database is compared with a checksum before it is used: with
/// and without the comparison, in turn. The files are in the system's page cache, so that no disk hides it.
namespace trimtab::bench {
namespace {

/// Of a flight at 600 kt and 60 images a second: 5.1 m an image.
constexpr int kFrames = 600;
constexpr double kStepDeg = 5.1 / 89400;

std::filesystem::path folder;

FrameRequest place(const BenchScene& scene, TerrainForm form, double eastDeg) {
  FrameRequest r = scene.request();
  r.staticLod.terrain = form;
  r.eye.longitude = Degrees{128.2 + eastDeg};
  r.eye.height = Metres{2500};
  r.attitude.heading = Degrees{90};
  return r;
}

std::shared_ptr<const terrain::Database> opened() {
  auto database = terrain::Database::open(folder);
  if (database) return *database;
  std::cerr << toString(database.findings());
  std::exit(1);
}

/// From opening the database to its first finished image, milliseconds, in a program that has its context.
double firstImageMs(BenchScene& scene, TerrainForm form) {
  scene.use(nullptr);
  const double start = monotonicSeconds();
  scene.use(opened());
  FrameRequest r = place(scene, form, 0);
  r.waitForPages = r.waitForPicture = true;
  scene.draw(r);
  return (monotonicSeconds() - start) * 1e3;
}

/// Of all threads, those that read and check among them; what other programs do adds little to it.
double processorMs() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

/// Flies east from a place whose terrain is in memory; milliseconds of processor time from image to image.
std::vector<double> flight(BenchScene& scene, TerrainForm form, std::uint64_t& read) {
  scene.use(nullptr);
  scene.use(opened());
  FrameRequest r = place(scene, form, 0);
  r.waitForPages = true;
  scene.draw(r);
  std::vector<double> ms;
  for (int i = 0; i < kFrames; ++i) {
    const double before = processorMs();
    const FrameResult result = scene.draw(place(scene, form, kStepDeg * i));
    ms.push_back(processorMs() - before);
    read += !result.paging.settled;
  }
  return ms;
}

template <class Work>
auto unchecked(const Work& work) {
  const terrain::Unchecked without;
  return work();
}

void measure(Report& report, BenchScene& scene, TerrainForm form, const std::string& name) {
  if (report.wants("first_" + name)) {
    const Pairs pairs = inTurn(
        report.quick() ? 7 : 21, [&](int) { return firstImageMs(scene, form); },
        [&](int) { return unchecked([&] { return firstImageMs(scene, form); }); });
    report.add(ratioAtMost(
        1.1, rowOf(pairs, {.id = "trust.first_" + name,
                           .what = "From opening the sample, 100 km, to its first whole image of " + name,
                           .peer = "the same without comparing checksums"})));
  }
  if (report.wants("flight_" + name)) {
    Pairs pairs;
    std::uint64_t reading = 0;
    for (int turn = 0; turn < (report.quick() ? 2 : 6); ++turn) {
      const auto with = [&] { return flight(scene, form, reading); };
      // Each of both is first in half of the turns.
      const auto first = turn % 2 == 0 ? with() : unchecked(with);
      const auto second = turn % 2 == 0 ? unchecked(with) : with();
      const auto& [a, b] = turn % 2 == 0 ? std::tie(first, second) : std::tie(second, first);
      pairs.a.insert(pairs.a.end(), a.begin(), a.end());
      pairs.b.insert(pairs.b.end(), b.begin(), b.end());
    }
    const PairedRatio ratio = pairedRatio(pairs.b, pairs.a);
    char interval[64];
    std::snprintf(interval, sizeof interval, "%.3f to %.3f", ratio.low, ratio.high);
    report.add(ratioAtMost(
        1.02,
        rowOf(pairs, {.id = "trust.flight_" + name,
                      .what = "Processor time of an image of " + name + " in flight at 600 kt; " +
                              std::to_string(ratio.pairs) + " pairs, of their images " +
                              std::to_string(reading) + " while pages were read; ratio within " + interval,
                      .peer = "the same without comparing checksums"})));
  }
}

int measureAll(Report& report) {
  folder = std::filesystem::temp_directory_path() / "trimtab-bench" / "trust";
  if (!terrain::isDatabase(folder)) {
    std::filesystem::create_directories(folder.parent_path());
    const auto tif = folder.parent_path() / "trust.tif";
    terrain::BakeOptions options;
    options.sources = {tif};
    options.output = folder;
    if (!terrain::writeSample(tif, {}) || !terrain::bake(options)) return 1;
  }
  BenchScene scene(nullptr);
  if (!scene.ready()) {
    std::cerr << "no context\n";
    return 1;
  }
  scene.draw(scene.request());
  measure(report, scene, TerrainForm::levels, "levels");
  measure(report, scene, TerrainForm::patches, "patches");
  return report.finish();
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  trimtab::bench::Report report(argc, argv);
  return trimtab::bench::measureAll(report);
}
