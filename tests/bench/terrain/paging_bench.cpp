#include "paging_bench.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "tests/bench/bench_scene.h"
#include "trimtab/culling/select_patches.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/synthetic/country.h"

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
  FrameRequest at(FrameRequest r, double metres) const {
    r.eye = from;
    r.eye.longitude = from.longitude + perMetre * metres;
    r.attitude = {Degrees{90}, Degrees{-6}, Degrees{0}};
    r.velocity = Velocity{MetresPerSecond{0}, MetresPerSecond{kSpeed}, MetresPerSecond{0}};
    r.terrain.form = TerrainForm::patches;
    r.terrain.cache = Megabytes{kBudgetMb};
    r.levers.drawn.errorPx = 2;
    return r;
  }
};

struct FlownFrame {
  double ms = 0, processorMs = 0, pageMs = 0;
  bool paging = false;  ///< something was read, taken in or lacking
  bool coarse = false;
  double bytes = 0;
};
struct Flight {
  double firstFrameS = 0;
  std::vector<FlownFrame> cold, again;  ///< with nothing in memory at the start; with all
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
  const double perRadian = pixelsPerRadian(view);
  const auto choose = [&](Vec3 at) { selectPatches(patches.index(), {}, at, {2, 1, perRadian}, cut); };
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

FlownFrame flown(BenchScene& scene, const FrameRequest& request) {
  const double before = processorMs();
  const FrameResult result = scene.draw(request);
  FlownFrame frame;
  frame.ms = result.cost.total;
  frame.processorMs = processorMs() - before;
  frame.pageMs = std::isnan(result.cost.page) ? 0 : result.cost.page;
  frame.paging = frame.pageMs > 0 || !result.paging.settled;
  frame.coarse = result.paging.heldBack > 0;
  frame.bytes = static_cast<double>(result.paging.bytes);
  return frame;
}

/// Opens the database with nothing of it in memory, flies, and draws the same places again. The first flight
/// finds out how far it gets from frame to frame, and says so in `places`, metres; the others go through the
/// same ones, none earlier than it is due.
bool fly(BenchScene& scene, const std::filesystem::path& database, double seconds,
         std::vector<double>& places, Flight& flight) {
  scene.use(nullptr);
  makeCold(database);
  const double opening = monotonicSeconds();
  const auto opened = terrain::Database::open(database);
  if (!opened) std::cerr << toString(opened.findings());
  if (!opened || !(*opened)->patches()) return false;
  scene.use(*opened);
  const Course course(**opened);
  scene.draw(course.at(scene.request(), 0));
  const double start = monotonicSeconds();
  flight.firstFrameS = start - opening;

  const bool first = places.empty();
  for (std::size_t i = 0; first || i < places.size(); ++i) {
    const double t = monotonicSeconds() - start;
    if (first && t >= seconds) break;
    if (first)
      places.push_back(kSpeed * t);
    else if (const double due = places[i] / kSpeed; due > t)
      std::this_thread::sleep_for(std::chrono::duration<double>(due - t));
    flight.cold.push_back(flown(scene, course.at(scene.request(), places[i])));
  }
  // Back at the start the ground's colours are another window's.
  for (int i = 0; i < 500 && !scene.draw(course.at(scene.request(), 0)).paging.settled; ++i) {
  }
  for (const double metres : places) flight.again.push_back(flown(scene, course.at(scene.request(), metres)));
  return true;
}

/// Of all flights' frames, cold or not.
std::vector<double> all(const std::vector<Flight>& flights, std::vector<FlownFrame> Flight::*which,
                        double FlownFrame::*what) {
  std::vector<double> values;
  for (const Flight& flight : flights)
    for (const FlownFrame& frame : flight.*which) values.push_back(frame.*what);
  return values;
}

double mostOf(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// The longest frame that is long because of paging, ms: of each place what it costs with all in memory (the
/// median of the flights), and what the frames about it that had to do with paging took beyond that (the
/// longest of a flight's, as pages come a few frames earlier or later; of these the median of the flights, as
/// another program's work comes at other places each time).
double longestByPaging(const std::vector<Flight>& flights, double medianMs) {
  constexpr std::size_t kAround = 5;
  const std::size_t count = flights.front().cold.size();
  std::vector<double> inMemory;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> ms;
    for (const Flight& flight : flights) ms.push_back(flight.again[i].ms);
    inMemory.push_back(experiment::quantileOf(ms, 0.5));
  }
  double longest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (inMemory[i] > 2 * medianMs) continue;  // whatever paging does
    std::vector<double> added;
    for (const Flight& flight : flights) {
      double most = 0;
      for (std::size_t k = i - std::min(i, kAround); k < std::min(count, i + kAround + 1); ++k)
        if (flight.cold[k].paging) most = std::max(most, flight.cold[k].ms - inMemory[k]);
      added.push_back(most);
    }
    if (const double most = experiment::quantileOf(added, 0.5); most > 0)
      longest = std::max(longest, inMemory[i] + most);
  }
  return longest;
}

std::string inMs(double ms) {
  return std::to_string(ms).substr(0, 4) + " ms";
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
  std::vector<Flight> flights(report.quick() ? 3 : 5);
  std::vector<double> places, firstFrames;
  for (Flight& flight : flights) {
    if (!fly(scene, database, report.quick() ? 3 : 10, places, flight)) return;
    firstFrames.push_back(flight.firstFrameS);
  }
  report.add(valueAtMost(
      1, {.id = "terrain.first_frame",
          .what = "From opening a baked country, nothing of it in memory, to its first picture; "
                  "median of " +
                  std::to_string(flights.size()) + ", the longest " + inMs(1e3 * mostOf(firstFrames)),
          .value = experiment::quantileOf(firstFrames, 0.5),
          .unit = "s"}));
  const auto opened = terrain::Database::open(database);
  if (!opened) return;
  const Course course(**opened);
  const terrain::PatchTerrain& patches = *(*opened)->patches();
  selectionRow(report, patches, patches.index().frame.fromGeodetic(course.from));

  const std::vector<double> ms = all(flights, &Flight::cold, &FlownFrame::ms);
  const std::vector<double> inMemory = all(flights, &Flight::again, &FlownFrame::ms);
  // What slows every frame of the cold flights must not be what it is held against.
  const double median = std::min(experiment::quantileOf(ms, 0.5), experiment::quantileOf(inMemory, 0.5));
  report.add(ratioAtMost(
      2, {.id = "terrain.flight_paging",
          .what = "Longest frame because of paging, of " + std::to_string(flights.size()) + " flights of " +
                  std::to_string(places.size()) +
                  " frames at 600 kt and 2,000 ft, nothing in memory at the start; for whatever reason " +
                  inMs(mostOf(ms)) + ", with all in memory " + inMs(mostOf(inMemory)),
          .value = longestByPaging(flights, median),
          .unit = "ms",
          .peer = "the median frame, cold or in memory",
          .peerValue = median,
          .peerFrom = "run"}));
  const std::vector<double> processor = all(flights, &Flight::cold, &FlownFrame::processorMs);
  report.add(ratioAtMost(2, {.id = "terrain.flight_processor",
                             .what = "The most processor time of one of them, with what was read meanwhile: "
                                     "no other program adds to it",
                             .value = mostOf(processor),
                             .unit = "ms",
                             .peer = "the median frame's",
                             .peerValue = experiment::quantileOf(processor, 0.5),
                             .peerFrom = "run"}));
  report.add(ratioAtMost(1, {.id = "terrain.flight_page",
                             .what = "The most that a frame of them spent on taking pages in",
                             .value = mostOf(all(flights, &Flight::cold, &FlownFrame::pageMs)),
                             .unit = "ms",
                             .peer = "the median frame",
                             .peerValue = median,
                             .peerFrom = "run"}));
  scene.use(*opened);
  double tightBytes = 0;
  for (const double metres : places) {
    FrameRequest r = course.at(scene.request(), metres);
    r.terrain.cache = Megabytes{kTightMb};
    tightBytes = std::max(tightBytes, static_cast<double>(scene.draw(r).paging.bytes));
  }
  const double mostBytes = mostOf(all(flights, &Flight::cold, &FlownFrame::bytes));
  report.add(ratioAtMost(1, {.id = "terrain.flight_memory",
                             .what = "Most that pages of meshes took where they may take too little; with " +
                                     std::to_string(static_cast<int>(kBudgetMb)) + " MB allowed " +
                                     std::to_string(static_cast<int>(mostBytes / 1e6)) + " MB",
                             .value = tightBytes / 1e6,
                             .unit = "MB",
                             .peer = "the budget",
                             .peerValue = kTightMb,
                             .peerFrom = "run"}));
  std::size_t coarse = 0, count = 0;
  for (const Flight& flight : flights)
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] < kSpeed) continue;
      ++count;
      coarse += flight.cold[i].coarse;
    }
  report.add(
      valueAtMost(0.05, {.id = "terrain.flight_coarse",
                         .what = "Share of their frames with a part coarser than asked for, one second on",
                         .value = count ? static_cast<double>(coarse) / static_cast<double>(count) : 0,
                         .unit = ""}));
}

}  // namespace trimtab::bench
