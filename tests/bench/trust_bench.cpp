#include "bench_scene.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/unchecked.h"

/// Measures what it costs that every byte of a database is compared with a checksum before it is used: with
/// and without the comparison, in turn. The files are in the system's page cache, so that no disk hides it.
namespace trimtab::bench {
namespace {

constexpr int kFrames = 240;

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

/// Flies east over terrain that has nothing in memory at the start; milliseconds of each image.
std::vector<double> flight(BenchScene& scene, TerrainForm form) {
  scene.use(nullptr);
  scene.use(opened());
  std::vector<double> ms;
  for (int i = 0; i < kFrames; ++i) ms.push_back(scene.ms(place(scene, form, 0.0005 * i)));
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
    for (int turn = 0; turn < (report.quick() ? 3 : 9); ++turn) {
      const auto with = flight(scene, form), without = unchecked([&] { return flight(scene, form); });
      pairs.a.insert(pairs.a.end(), with.begin(), with.end());
      pairs.b.insert(pairs.b.end(), without.begin(), without.end());
    }
    const PairedRatio ratio = pairedRatio(pairs.b, pairs.a);
    char interval[64];
    std::snprintf(interval, sizeof interval, "%.3f to %.3f", ratio.low, ratio.high);
    report.add(ratioAtMost(
        1.02, rowOf(pairs, {.id = "trust.flight_" + name,
                            .what = "An image in flight that reads " + name + " as it goes; " +
                                    std::to_string(ratio.pairs) + " pairs, ratio within " + interval,
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
