#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>

#include "bench_scene.h"
#include "row.h"
#include "tests/core/scene/foreign/paged_scene.h"
#include "tests/shared_scene.h"
#include "tests/support.h"
#include "trimtab/host/head_log.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/preset/preset.h"

/// Group `rig`: what a fit is worth to an image generator that is not ours, the example of osgViewer over
/// paged scenes.

namespace trimtab::bench {
namespace {

constexpr double kBudgetMs = 16.7;
constexpr int kCells = TerrainIndex::kTileCells;
/// The first images read the pages around the start.
constexpr std::size_t kFirstImages = 120;

const std::string kExamples = (test::sourceDir() / "tests/core/interface/examples").string();

class Rig {
 public:
  Rig(const terrain::Database& ground, int images) : ground_(ground), images_(images) {
    const auto& info = ground.info();
    // The finest power of two that has no more posts than the terrain, so that no detail is invented.
    int tiles = 1;
    while (2 * tiles * kCells < static_cast<int>(info.columns)) tiles *= 2;
    const double step = (info.northEast.latitude - info.southWest.latitude).value() / (tiles * kCells + 1);
    const test::SyntheticTerrain posts(tiles, step, info.southWest, [&](int column, int row) {
      return heightAt(info.southWest.latitude.value() + step * row,
                      info.southWest.longitude.value() + step * column);
    });
    const int levels = 1 + static_cast<int>(std::lround(std::log2(tiles * kCells / 16.0)));
    scene_ = test::PagedScene(posts, dir_.path(), ".osgb", true, levels, {6, true}).file().string();
  }

  bool build() {
    const test::Ran built = test::run(TRIMTAB_CXX " -O2 -std=c++17 " + kExamples + "/osg_viewer.cpp -I" +
                                      (test::sourceDir() / "core/interface/include").string() + " -o " +
                                      (dir_ / "viewer").string() +
                                      " $(pkg-config --cflags --libs openscenegraph) -L" TRIMTAB_LIBRARY_DIR
                                      " -ltrimtab -Wl,-rpath," TRIMTAB_LIBRARY_DIR);
    if (built.exitCode != 0) std::cerr << built.err;
    return built.exitCode == 0;
  }

  /// Writes a flight to the north, 2,000 ft above the ground, by somebody whose head turns as the log says.
  bool writeTable(const std::string& name, const char* log, int images) {
    const auto head = readHeadLog(test::sharedDir() / "data/headmotion-mv360" / log);
    if (!head) return false;
    const auto& info = ground_.info();
    const double longitude = (info.southWest.longitude.value() + info.northEast.longitude.value()) / 2;
    const double start = info.southWest.latitude.value() * 0.65 + info.northEast.latitude.value() * 0.35;
    std::string table;
    for (int i = 0; i < images; ++i) {
      const double time = i / 60.0, latitude = start + 120 * time / 111e3;
      const Attitude a = headAt(*head, time);
      std::ostringstream row;
      row.precision(10);
      row << time << ' ' << latitude << ' ' << longitude << ' ' << heightAt(latitude, longitude) + 610
          << " 0 0 0 " << a.heading.value() << ' ' << a.pitch.value() << ' ' << a.roll.value() << '\n';
      table += row.str();
    }
    test::writeFile(dir_ / name, table);
    return true;
  }

  std::string command(const std::string& preset, const std::string& table) const {
    return (dir_ / "viewer").string() + ' ' + preset + ' ' + scene_ + ' ' + (dir_ / table).string() + ' ' +
           kExamples + "/osg_viewer.json";
  }

  std::string presetWith(bool held) {
    TuningParameters p = loadPreset("low-level")->parameters;
    p.hold.enabled = held;
    p.measure.budget = Milliseconds{kBudgetMs};
    const std::string file = (dir_ / (held ? "held.json" : "free.json")).string();
    test::writeFile(file, exportText(*validate(p), "rig", {}, ExportFormat::json));
    return file;
  }

  /// Returns the times of the images after the first ones, milliseconds.
  std::vector<double> flown(const std::string& command) const {
    const test::Ran ran = test::run(command);
    std::istringstream lines(ran.out.substr(std::min(ran.out.find_first_of("0123456789"), ran.out.size())));
    std::vector<double> times;
    for (double scale, triangles, ms; lines >> scale >> triangles >> ms;) times.push_back(ms);
    times.erase(times.begin(),
                times.begin() + static_cast<std::ptrdiff_t>(std::min(times.size(), kFirstImages)));
    return times;
  }

  bool fit(const std::string& preset) {
    const test::Ran ran =
        test::run(TRIMTAB_CLI " fit --profile " + kExamples + "/osg_viewer.json --preset " + preset + " -o " +
                  (dir_ / "fit").string() + " -- " + command("{preset}", "other.txt"));
    std::cerr << ran.out << (ran.exitCode == 0 ? "" : ran.err);
    return ran.exitCode == 0;
  }

  void rows(Report& report, const std::string& id, const std::string& where) {
    if (!build() || !writeTable("head.txt", "user1_euler.txt", images_) ||
        !writeTable("other.txt", "user2_euler.txt", images_) || !fit(presetWith(true)))
      return;
    const std::string fitted = (dir_ / "fit/fitted.json").string(), fit = (dir_ / "fit/fit.json").string();
    const double free = quantileOf(flown(command(presetWith(false), "head.txt")), 0.99);
    const double unfitted = quantileOf(flown(command(presetWith(true), "head.txt")), 0.99);
    const std::vector<double> with = flown(command(fitted, "head.txt") + ' ' + fit);
    report.add(
        valueAtMost(1.1, {.id = "rig." + id,
                          .what = "99th percentile of an image of osgViewer over " + where +
                                  " with a head log, low-level fitted on another head log, budget 16.7 ms",
                          .value = quantileOf(with, 0.99) / kBudgetMs,
                          .unit = "budgets",
                          .peer = "the same preset unfitted",
                          .peerValue = unfitted / kBudgetMs,
                          .peerFrom = "run"}));
    report.add({.id = "rig." + id + "_median",
                .what = "median image fitted, beside the 99th percentile without a budget",
                .value = quantileOf(with, 0.5),
                .unit = "ms",
                .peer = "without a budget, 99th percentile",
                .peerValue = free,
                .peerFrom = "run"});
  }

 private:
  double heightAt(double latitude, double longitude) const {
    return ground_.heightAt(Degrees{latitude}, Degrees{longitude}).value_or(Metres{0}).value();
  }
  test::ScratchDir dir_;
  const terrain::Database& ground_;
  int images_;
  std::string scene_;
};

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  using namespace trimtab;
  bench::Report report(argc, argv);
  const int images = report.quick() ? 1200 : 3000;
  if (report.wants("everest"))
    if (const auto ground = test::bakedOnce("dem-srtm3-everest"))
      bench::Rig(**ground, images).rows(report, "everest", "Everest");
  if (report.wants("sample"))
    if (const auto ground = bench::sampleTerrain(40))
      bench::Rig(*ground, images).rows(report, "sample", "the sample");
  return report.finish();
}
