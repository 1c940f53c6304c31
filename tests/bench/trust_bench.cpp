
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

/// The eye moves 5.1 m from image to image, as at 600 kt and 60 images a second.
constexpr int kFrames = 600;
constexpr double kStepDeg = 5.1 / 89400;

std::filesystem::path folder;

FrameRequest place(const BenchScene& scene, TerrainForm form, double eastDeg) {
  FrameRequest r = scene.request();
  r.terrain.form = form;
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
  r.waitForPages = r.waitForImage = true;
  scene.draw(r);
  return (monotonicSeconds() - start) * 1e3;
}

/// A flight east with a database of its own, from a place whose terrain is in memory.
class Flight {
 public:
  Flight(BenchScene& scene, TerrainForm form) : scene_(scene), form_(form) {
    scene_.use(opened());
    FrameRequest r = place(scene_, form_, 0);
    r.waitForPages = true;
    scene_.draw(r);
  }
  /// Draws the next image; milliseconds of processor time.
  double next() {
    const double before = processorMs();
    const FrameResult result = scene_.draw(place(scene_, form_, kStepDeg * image_++));
    reading_ += !result.paging.settled;
    return processorMs() - before;
  }
  std::uint64_t reading() const { return reading_; }

 private:
  BenchScene& scene_;
  TerrainForm form_;
  int image_ = 0;
  std::uint64_t reading_ = 0;  ///< images while pages were read
};

template <class Work>
auto unchecked(const Work& work) {
  const terrain::Unchecked without;
  return work();
}

void measure(Report& report, BenchScene& scene, BenchScene& other, TerrainForm form,
             const std::string& name) {
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
    // Image by image in turn, and each of both first in half of the pairs: what other programs do meanwhile
    // is the same for both.
    Pairs pairs;
    std::uint64_t reading = 0;
    for (int turn = 0; turn < (report.quick() ? 1 : 4); ++turn) {
      Flight with(scene, form);
      Flight without = unchecked([&] { return Flight(other, form); });
      for (int i = 0; i < kFrames; ++i) {
        const bool first = (i + turn) % 2 == 0;
        if (first) pairs.a.push_back(with.next());
        pairs.b.push_back(without.next());
        if (!first) pairs.a.push_back(with.next());
      }
      reading += with.reading();
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
  BenchScene scene(nullptr), other(nullptr);
  if (!scene.ready() || !other.ready()) {
    std::cerr << "no context\n";
    return 1;
  }
  for (BenchScene* each : {&scene, &other}) each->draw(each->request());
  measure(report, scene, other, TerrainForm::tiles, "tiles");
  measure(report, scene, other, TerrainForm::patches, "patches");
  return report.finish();
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  trimtab::bench::Report report(argc, argv);
  return trimtab::bench::measureAll(report);
}
