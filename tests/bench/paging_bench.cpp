#include "paging_bench.h"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bench_scene.h"
#include "trimtab/culling/select_patches.h"
#include "trimtab/terrain/country.h"
#include "trimtab/terrain/patch_terrain.h"

namespace trimtab::bench {
namespace {

constexpr double kSpeed = 600 * 1852.0 / 3600, kHeightM = 2000 * 0.3048;
/// The second is the least that there is: less than the flight has a use for.
constexpr double kBudgetMb = 512, kTightMb = 16;

/// The database's files out of the system's page cache: the next that reads them waits for the disk.
void makeCold(const std::filesystem::path& folder) {
  ::sync();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const int file = ::open(entry.path().c_str(), O_RDONLY);
    if (file < 0) continue;
    ::posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
    ::close(file);
  }
}

/// A straight flight along a parallel, at one height above the sea: over the highest post of its way.
struct Course {
  GeodeticPosition from;
  Degrees perMetre;

  explicit Course(const terrain::Database& database) {
    const terrain::TerrainInfo& info = database.info();
    from.latitude = (info.southWest.latitude + info.northEast.latitude) * 0.5;
    from.longitude = info.southWest.longitude + (info.northEast.longitude - info.southWest.longitude) * 0.2;
    perMetre = Degrees{1 / (111320 * std::cos(from.latitude.value() * 3.14159265358979 / 180))};
    from.height = Metres{kHeightM} +
                  database.highestWithin(from.latitude, from.longitude, Metres{15e3}).value_or(Metres{0});
  }
  scene::FrameRequest at(scene::FrameRequest r, double metres) const {
    r.eye = from;
    r.eye.longitude = from.longitude + perMetre * metres;
    r.attitude = {Degrees{90}, Degrees{-6}, Degrees{0}};
    r.velocity = Velocity{MetresPerSecond{0}, MetresPerSecond{kSpeed}, MetresPerSecond{0}};
    r.staticLod.terrain = TerrainForm::patches;
    r.terrain.cache = Megabytes{kBudgetMb};
    r.lod.screenSpaceError = Pixels{2};
    return r;
  }
};

/// Of all threads: those that draw and those that read.
double processorMs() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

struct Flown {
  std::vector<double> places, ms, processorMs, pageMs, heldBack;
  double mostBytes = 0;
};

/// A country, or the 64th part of one; baked once. TRIMTAB_COUNTRY names another database.
std::filesystem::path baked(bool quick) {
  if (const char* country = std::getenv("TRIMTAB_COUNTRY")) return country;
  const std::uint32_t share = quick ? 8 : 1;
  const auto folder = std::filesystem::temp_directory_path() / "trimtab-bench";
  const auto database = folder / ("country-1-" + std::to_string(share));
  if (terrain::isDatabase(database) && terrain::Database::open(database)) return database;
  std::filesystem::create_directories(folder);
  const auto tif = folder / ("country-1-" + std::to_string(share) + ".tif");
  terrain::CountryOptions country;
  country.columns /= share;
  country.rows /= share;
  if (const auto written = terrain::writeCountry(tif, country); !written) {
    std::cerr << toString(written.findings());
    return {};
  }
  terrain::BakeOptions options;
  options.sources = {tif};
  options.output = database;
  const auto made = terrain::bake(options);
  std::filesystem::remove(tif);
  if (!made) std::cerr << toString(made.findings());
  return made ? database : std::filesystem::path{};
}

void selectionRow(Report& report, const terrain::PatchTerrain& patches, Vec3 eye) {
  PatchCut cut;
  ViewShape view;
  view.widthPx = BenchScene::kWidth, view.heightPx = BenchScene::kHeight;
  const double perRadian =
      std::max(view.widthPx / (view.right - view.left), view.heightPx / (view.top - view.bottom));
  const auto choose = [&](Vec3 at) { selectPatches(patches.index(), {}, at, 2, 1, perRadian, cut); };
  int step = 0;
  const double seconds = leastSeconds(report.quick() ? 20 : 200, [&] {
    choose(eye + Vec3{10.0 * ++step, 0, 0});
    keep(cut.cut.tiles.size());
  });
  report.add(valueAtMost(1, {.id = "terrain.select",
                             .what = "Choosing " + std::to_string(cut.cut.tiles.size()) + " of " +
                                     std::to_string(patches.index().size()) + " patches, 2 px at 1280 x 720",
                             .value = seconds * 1e3,
                             .unit = "ms"}));
}

void fly(BenchScene& scene, const Course& course, double seconds, Flown& flown) {
  const double start = monotonicSeconds();
  for (double t = 0; t < seconds; t = monotonicSeconds() - start) {
    const double metres = kSpeed * t, before = processorMs();
    const scene::FrameResult result = scene.draw(course.at(scene.request(), metres));
    flown.places.push_back(metres);
    flown.ms.push_back(result.cost.total);
    flown.processorMs.push_back(processorMs() - before);
    flown.pageMs.push_back(std::isnan(result.cost.page) ? 0 : result.cost.page);
    flown.heldBack.push_back(static_cast<double>(result.paging.heldBack));
    flown.mostBytes = std::max(flown.mostBytes, static_cast<double>(result.paging.bytes));
  }
}

}  // namespace

void pagingRows(Report& report) {
  const std::filesystem::path database = baked(report.quick());
  if (database.empty()) return;
  // In a program that runs: what a start costs besides is the group start's.
  BenchScene scene(nullptr);
  if (!scene.ready()) {
    std::cerr << "no context\n";
    return;
  }
  scene.draw(scene.request());
  makeCold(database);
  const double start = monotonicSeconds();
  const auto opened = terrain::Database::open(database);
  if (!opened) std::cerr << toString(opened.findings());
  if (!opened || !(*opened)->patches()) return;
  scene.use(*opened);
  const Course course(**opened);
  scene.draw(course.at(scene.request(), 0));
  report.add(
      valueAtMost(1, {.id = "terrain.first_frame",
                      .what = "From opening a baked country, nothing of it in memory, to its first picture",
                      .value = monotonicSeconds() - start,
                      .unit = "s"}));
  const terrain::PatchTerrain& patches = *(*opened)->patches();
  selectionRow(report, patches, patches.index().frame.fromGeodetic(course.from));

  Flown cold;
  fly(scene, course, report.quick() ? 4 : 40, cold);
  // The same places again with all that they need in memory: what frames cost without paging.
  std::vector<double> again;
  for (const double metres : cold.places) again.push_back(scene.ms(course.at(scene.request(), metres)));
  const double median = experiment::quantileOf(cold.ms, 0.5);
  report.add(ratioAtMost(2, {.id = "terrain.flight_longest",
                             .what = "Longest of " + std::to_string(cold.ms.size()) +
                                     " frames at 600 kt and 2,000 ft, nothing in memory at the start",
                             .value = *std::max_element(cold.ms.begin(), cold.ms.end()),
                             .unit = "ms",
                             .peer = "the median frame",
                             .peerValue = median,
                             .peerFrom = "run"}));
  report.add(ratioAtMost(2, {.id = "terrain.flight_processor",
                             .what = "The most processor time of one of them, with what was read meanwhile: "
                                     "no other program adds to it",
                             .value = *std::max_element(cold.processorMs.begin(), cold.processorMs.end()),
                             .unit = "ms",
                             .peer = "the median frame's",
                             .peerValue = experiment::quantileOf(cold.processorMs, 0.5),
                             .peerFrom = "run"}));
  report.add(ratioAtMost(1, {.id = "terrain.flight_page",
                             .what = "The most that a frame of it spent on taking pages in",
                             .value = *std::max_element(cold.pageMs.begin(), cold.pageMs.end()),
                             .unit = "ms",
                             .peer = "the median frame",
                             .peerValue = median,
                             .peerFrom = "run"}));
  report.add(ratioAtMost(2, {.id = "terrain.flight_again",
                             .what = "Longest frame of the same places once all is in memory",
                             .value = *std::max_element(again.begin(), again.end()),
                             .unit = "ms",
                             .peer = "their median frame",
                             .peerValue = experiment::quantileOf(again, 0.5),
                             .peerFrom = "run"}));
  double mostBytes = 0;
  for (const double metres : cold.places) {
    scene::FrameRequest r = course.at(scene.request(), metres);
    r.terrain.cache = Megabytes{kTightMb};
    mostBytes = std::max(mostBytes, static_cast<double>(scene.draw(r).paging.bytes));
  }
  report.add(ratioAtMost(1, {.id = "terrain.flight_memory",
                             .what = "Most that pages of meshes took where they may take too little; with " +
                                     std::to_string(static_cast<int>(kBudgetMb)) + " MB allowed " +
                                     std::to_string(static_cast<int>(cold.mostBytes / 1e6)) + " MB",
                             .value = mostBytes / 1e6,
                             .unit = "MB",
                             .peer = "the budget",
                             .peerValue = kTightMb,
                             .peerFrom = "run"}));
  report.add(
      valueAtMost(0.05, {.id = "terrain.flight_coarse",
                         .what = "Share of its frames with a part coarser than asked for, one second on",
                         .value =
                             [&] {
                               std::size_t coarse = 0, count = 0;
                               for (std::size_t i = 0; i < cold.places.size(); ++i) {
                                 if (cold.places[i] < kSpeed) continue;
                                 ++count;
                                 coarse += cold.heldBack[i] > 0;
                               }
                               return count ? static_cast<double>(coarse) / static_cast<double>(count) : 0;
                             }(),
                         .unit = ""}));
}

}  // namespace trimtab::bench
