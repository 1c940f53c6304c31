#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "culling_frames.h"
#include "culling_horizon.h"
#include "culling_peers.h"
#include "tests/bench/row.h"
#include "tests/core/culling/random_index.h"
#include "tests/core/culling/view_axes.h"
#include "trimtab/culling/box_arrays.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/scene/offscreen.h"

/// Group `culling`: what choosing what to draw costs, beside OpenSceneGraph's own ways and the memory's
/// speed.

namespace trimtab::bench {
namespace {

using test::axesOf;

std::vector<Box> randomBoxes(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(0, 100e3f), up(0, 2000), side(100, 1000);
  std::vector<Box> boxes(count);
  for (Box& b : boxes) {
    const float x = place(random), y = place(random), z = up(random);
    b = {x, y, z, x + side(random), y + side(random), z + side(random)};
  }
  return boxes;
}

// With the widest registers that the processor has, as the test of boxes has them.
#if defined(__x86_64__)
#define TRIMTAB_WIDEST __attribute__((noinline, target_clones("avx512f", "avx2", "default")))
#else
#define TRIMTAB_WIDEST __attribute__((noinline))
#endif

using Sides = std::vector<const std::uint64_t*>;

/// The corners of boxes that are furthest inside of a plane of the view: the sides that a test must read.
Sides sidesRead(const BoxArrays& boxes, const Frustum& frustum) {
  std::array<bool, 6> read{};
  for (const auto& plane : frustum.planes()) {
    const Vec3& n = plane.normal;
    read[n.x > 0 ? 3 : 0] = read[n.y > 0 ? 4 : 1] = read[n.z > 0 ? 5 : 2] = true;
  }
  Sides sides;
  for (std::size_t side = 0; side < read.size(); ++side)
    if (read[side]) sides.push_back(reinterpret_cast<const std::uint64_t*>(boxes.side(side)));
  return sides;
}

/// Reads those sides and nothing else, one after the other and asking for memory `ahead` words before it is
/// due: what a test of each box can at best reach.
TRIMTAB_WIDEST std::uint64_t readInTurn(const Sides& sides, std::size_t boxes, std::size_t ahead) {
  constexpr std::size_t kLine = 8, kStep = 2 * kLine;
  std::uint64_t parts[kStep] = {};
  for (const std::uint64_t* words : sides)
    for (std::size_t i = 0; i + kStep <= boxes / 2; i += kStep) {
      for (std::size_t k = 0; ahead != 0 && k < kStep; k += kLine) __builtin_prefetch(words + i + ahead + k);
      for (std::size_t k = 0; k < kStep; ++k) parts[k] += words[i + k];
    }
  std::uint64_t sum = 0;
  for (const std::uint64_t part : parts) sum += part;
  return sum;
}

/// The same, all sides abreast.
TRIMTAB_WIDEST std::uint64_t readAbreast(const Sides& sides, std::size_t boxes, std::size_t ahead) {
  constexpr std::size_t kLine = 8, kStep = 4 * kLine;
  std::uint64_t parts[kStep] = {};
  for (std::size_t i = 0; i + kStep <= boxes / 2; i += kStep)
    for (const std::uint64_t* words : sides) {
      for (std::size_t k = 0; ahead != 0 && k < kStep; k += kLine) __builtin_prefetch(words + i + ahead + k);
      for (std::size_t k = 0; k < kStep; ++k) parts[k] += words[i + k];
    }
  std::uint64_t sum = 0;
  for (const std::uint64_t part : parts) sum += part;
  return sum;
}

std::size_t keptBy(const BlockTest& test) {
  std::size_t kept = 0;
  for (std::size_t block = 0; block < test.blocks(); ++block)
    kept += static_cast<std::size_t>(std::popcount(test(block)));
  return kept;
}

void frustumRows(Report& report, const std::string& name, std::size_t count) {
  const EyePose eye{{50e3, 20e3, 1500}, axesOf(10, -8)};
  const ViewShape view;
  const std::vector<Box> boxes = randomBoxes(count);
  BoxArrays arrays;
  arrays.resize(count);
  for (std::size_t i = 0; i < count; ++i) arrays.set(i, boxes[i]);
  const Frustum frustum(eye, view);
  const BlockTest test(arrays, frustum);
  // From memory, whose speed is others' too, many turns of few runs.
  const int repeats = count > 1'000'000 ? 2 : 20, turns = count > 1'000'000 ? 12 : 5;
  const Sides sides = sidesRead(arrays, frustum);
  OsgBoxTests osg(eye, view);
  const std::span<const Box> some = std::span(boxes).first(std::min<std::size_t>(count, 1 << 20));
  // Which way of reading is best, and how far ahead, is the machine's to say.
  const auto reading = [&](std::uint64_t (*read)(const Sides&, std::size_t, std::size_t), std::size_t ahead) {
    return std::pair{repeats, [&sides, count, read, ahead] { keep(read(sides, count, ahead)); }};
  };
  const auto [ours, cullingSet, polytope, a, b, c, d, e, f] = leastInTurn(
      turns, std::pair{repeats, [&] { keep(keptBy(test)); }},
      std::pair{1, [&] { keep(osg.cullingSet(some)); }}, std::pair{1, [&] { keep(osg.polytope(some)); }},
      reading(readInTurn, 0), reading(readInTurn, 256), reading(readInTurn, 512), reading(readAbreast, 0),
      reading(readAbreast, 256), reading(readAbreast, 512));
  const double read = std::min({a, b, c, d, e, f});
  const auto rate = [](std::size_t n, double seconds) { return static_cast<double>(n) / seconds; };
  const std::string what = "Frustum test of " + std::to_string(count) + " boxes, one core";
  const Row row{.id = "culling.frustum_" + name, .what = what, .value = rate(count, ours), .unit = "boxes/s"};
  Row against = row;
  against.peer = "osg::CullingSet", against.peerFrom = "run",
  against.peerValue = rate(some.size(), cullingSet);
  report.add(ratioAtLeast(25, against));
  against.id += "_polytope", against.peer = "osg::Polytope", against.peerValue = rate(some.size(), polytope);
  report.add(ratioAtLeast(25, against));
  // A set that fits into the cache is not read at the memory's speed.
  if (count < 1'000'000) return;
  against.id = row.id + "_limit",
  against.peer = "reading the " + std::to_string(sides.size()) + " of 6 sides that its planes need",
  against.peerValue = rate(count, read);
  report.add(ratioAtLeast(0.9, against));
}

/// Whether all eight corners are outside of one plane, by plain doubles.
bool isOutside(const Box& b, const EyePose& eye, const ViewShape& v) {
  std::array<int, 5> outside{};
  for (int i = 0; i < 8; ++i) {
    const Vec3 p{i & 1 ? b.maxX : b.minX, i & 2 ? b.maxY : b.minY, i & 4 ? b.maxZ : b.minZ};
    const Vec3 e = eye.axes * (p - eye.position);
    const double depth = -e.z;
    outside[0] += e.x < v.left * depth;
    outside[1] += e.x > v.right * depth;
    outside[2] += e.y < v.bottom * depth;
    outside[3] += e.y > v.top * depth;
    outside[4] += depth < v.nearM;
  }
  return *std::max_element(outside.begin(), outside.end()) == 8;
}

void selectionRows(Report& report) {
  const TerrainIndex index = test::randomIndex(256, 3);
  LevelCut cut;
  selectLevels(index, {128e3, 128e3, 500}, {1e-6, 1, 1100}, cut);
  OsgQuadtree osg(index);
  VisibleSet visible;
  struct View {
    const char* id;
    const char* what;
    EyePose eye;
  };
  const std::array views{
      View{"culling.selection_level", "a level view from the middle", {{128e3, 128e3, 1500}, axesOf(30, -3)}},
      View{"culling.selection_all", "all of them in view", {{128e3, -400e3, 60e3}, axesOf(0, -6)}}};
  for (const View& v : views) {
    const ViewShape shape;
    const auto [ours, theirs] =
        leastInTurn(5, std::pair{10, [&] { selectVisible(cut, {.eye = v.eye, .view = shape}, visible); }},
                    std::pair{3, [&] { keep(osg.cull(v.eye, shape)); }});
    std::vector<std::uint32_t> kept = osg.kept();
    std::sort(kept.begin(), kept.end());
    std::size_t extra = 0, unproven = 0;
    for (const TileDraw& tile : visible.tiles)
      extra += !std::binary_search(kept.begin(), kept.end(), tile.node) &&
               !isOutside(index.bounds[tile.node], v.eye, shape);
    const std::vector<CullReason> reason = visible.reasons(index.size());
    for (const std::uint32_t node : kept)
      unproven += reason[node] != CullReason::drawn && !isOutside(index.bounds[node], v.eye, shape);
    const std::string what = "selecting of " + std::to_string(cut.tiles.size()) + " nodes, " + v.what;
    report.add(ratioAtMost(0.01, {.id = v.id,
                                  .what = "Time of " + what,
                                  .value = 1e3 * ours,
                                  .unit = "ms",
                                  .peer = "OSG's cull traversal",
                                  .peerValue = 1e3 * theirs,
                                  .peerFrom = "run"}));
    report.add(valueAtMost(
        0, {.id = std::string(v.id) + "_set",
            .what = "Nodes that OSG draws and ours leaves out though not proven outside, or the other way "
                    "round, of " +
                    std::to_string(kept.size()) + " and " + std::to_string(visible.tiles.size()),
            .value = static_cast<double>(extra + unproven),
            .unit = "nodes"}));
  }
  // What is left when only the head turns: the same cut, another view.
  const TerrainIndex small = test::randomIndex(128, 4);
  selectLevels(small, {64e3, 64e3, 500}, {1e-6, 1, 1100}, cut);
  cut.tiles.resize(6400);
  gather(small, cut);
  double heading = 0;
  const double turned = leastSeconds(100, [&] {
    heading += 3.3;
    selectVisible(cut, {.eye = {{64e3, 30e3, 1500}, axesOf(heading, -3)}}, visible);
  });
  report.add(valueAtMost(50, {.id = "culling.selection_turned",
                              .what = "Selecting of 6,400 tiles after the head has turned",
                              .value = 1e6 * turned,
                              .unit = "us"}));
}

void submitRow(Report& report) {
  auto created = scene::Offscreen::create(640, 360);
  if (!created) return;
  auto& context = *created.value();
  context.makeCurrent();
  const scene::DrawWay chosen = scene::drawChoiceOfContext().way;
  struct Way {
    const char* id;
    const char* what;
    Submission submission;
    double ms = 1e9;
  };
  std::array ways{
      Way{"", "one multi-draw as this context gets it, commands kept", {chosen}},
      Way{"_anew", "the same, another list each frame", {chosen, true}},
      Way{"_base_vertex",
          "one multi-draw by base vertex, another list each frame",
          {scene::DrawWay::base_vertex, true}},
      Way{"_indirect", "one indirect multi-draw, another list each frame", {scene::DrawWay::indirect, true}},
      Way{"_loop", "a draw a tile, another list each frame", {scene::DrawWay::loop, true}}};
  double theirs = 1e9;
  // In turns, so that all have the machine as it is.
  for (int turn = 0; turn < (report.quick() ? 2 : 6); ++turn) {
    theirs = std::min(theirs, submitMilliseconds(4096, {}, context.framebuffer(), 10));
    for (Way& way : ways)
      way.ms = std::min(way.ms, submitMilliseconds(4096, way.submission, context.framebuffer(), 10));
  }
  for (const Way& way : ways) {
    const Row row{.id = std::string("culling.submit") + way.id,
                  .what = std::string("Submitting 4,096 tiles of one triangle: ") + way.what,
                  .value = way.ms,
                  .unit = "ms",
                  .peer = "one osg::Geometry a tile",
                  .peerValue = theirs,
                  .peerFrom = "run"};
    report.add(way.submission.way == chosen ? ratioAtMost(0.2, row) : row);
  }
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  using namespace trimtab::bench;
  Report report(argc, argv);
  if (report.wants("frustum_64k")) frustumRows(report, "64k", 65'536);
  if (report.wants("frustum_16m")) frustumRows(report, "16m", 16'000'000);
  if (report.wants("selection")) selectionRows(report);
  if (report.wants("horizon")) horizonRows(report);
  movingHorizonRows(report);
  if (report.wants("submit")) submitRow(report);
  frameRows(report);
  if (report.wants("stage")) stageRows(report);
  return report.finish();
}
