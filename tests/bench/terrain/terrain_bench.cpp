#include <meshoptimizer.h>

#include <cmath>
#include <string>
#include <vector>

#include "bake_bench.h"
#include "core/terrain/static_lod/collapse.h"
#include "core/terrain/static_lod/surface.h"
#include "mesher_bench.h"
#include "paging_bench.h"
#include "patch_bench.h"
#include "tests/bench/row.h"
#include "tests/core/terrain/static_lod/static_lod_support.h"
#include "tests/support.h"
#include "trimtab/terrain/static_lod/error.h"

/// Group `terrain`: what simplification costs and loses, beside meshoptimizer's at the same number of
/// triangles.

namespace trimtab::bench {
namespace {

using namespace terrain;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct Simplified {
  std::vector<Lattice> vertices;
  Triangles triangles;
};

Patch patchOf(const LatticeTile& tile, const SourceSurface& surface) {
  Patch patch;
  patch.origin = tile.vertices[0];
  for (std::uint32_t i = 0; i < tile.vertices.size(); ++i)
    patch.vertices.push_back(
        {tile.vertices[i], surface.quadrics[i], tile.normals[i], i, surface.fixed[i] != 0, false});
  patch.triangles = tile.triangles;
  return patch;
}

/// Rms vertical distance of the source's vertices from the result, metres.
double rmsOf(const LatticeTile& source, const Simplified& result) {
  const VerticalDistance distance(result.vertices, result.triangles);
  double sum = 0;
  std::size_t samples = 0;
  for (const Lattice& p : source.vertices)
    if (const auto d = distance.metres(p, 0, static_cast<std::uint32_t>(result.triangles.size()))) {
      sum += *d * *d;
      ++samples;
    }
  return std::sqrt(sum / static_cast<double>(samples));
}

Simplified meshoptimizers(const LatticeTile& tile, std::size_t target, double& seconds) {
  std::vector<float> places;
  for (const Lattice& p : tile.vertices)
    for (const std::int32_t v :
         {p.x - tile.vertices[0].x, p.y - tile.vertices[0].y, p.z - tile.vertices[0].z})
      places.push_back(static_cast<float>(v * Lattice::kStepM));
  std::vector<unsigned> indices, left(tile.triangles.size() * 3);
  for (const auto& t : tile.triangles) indices.insert(indices.end(), t.begin(), t.end());
  std::size_t count = 0;
  seconds = leastSeconds(3, [&] {
    count = meshopt_simplify(left.data(), indices.data(), indices.size(), places.data(), tile.vertices.size(),
                             3 * sizeof(float), target * 3, 1.0f, meshopt_SimplifyLockBorder, nullptr);
  });
  Simplified out{tile.vertices, {}};
  for (std::size_t i = 0; i < count; i += 3) out.triangles.push_back({left[i], left[i + 1], left[i + 2]});
  return out;
}

void compare(Report& report, const std::string& id, const std::string& what, const SceneryMesh& mesh) {
  GeodeticPosition middle = toGeodetic(mesh.vertices[mesh.vertices.size() / 2]);
  middle.height = Metres{0};
  const auto lattice = toLattice(std::vector<SceneryMesh>{mesh}, LocalFrame(middle));
  if (!lattice) return;
  const LatticeTile& tile = lattice->tiles[0];
  const std::size_t target = tile.triangles.size() / 10;
  double theirSeconds = 0;
  const Simplified theirs = meshoptimizers(tile, target, theirSeconds);

  Patch patch;
  std::vector<std::uint8_t> alive;
  // Equal counts: ours stops where theirs did. Land cover is no matter to theirs, so it is none to ours.
  const double seconds = leastSeconds(3, [&] {
    patch = patchOf(tile, analyse(tile, tile.vertices[0], 0));
    collapseEdges(patch, theirs.triangles.size(), alive);
  });
  Simplified ours;
  for (const Patch::Vertex& v : patch.vertices) ours.vertices.push_back(v.at);
  for (std::size_t t = 0; t < alive.size(); ++t)
    if (alive[t]) ours.triangles.push_back(patch.triangles[t]);

  const double count = static_cast<double>(tile.triangles.size());
  const std::string from = what + ", " + std::to_string(tile.triangles.size()) + " to " +
                           std::to_string(ours.triangles.size()) + " triangles (theirs " +
                           std::to_string(theirs.triangles.size()) + ")";
  report.add(ratioAtLeast(0.05, {.id = id + "_rate",
                                 .what = "Simplifying " + from + ", one core",
                                 .value = count / seconds,
                                 .unit = "triangles/s",
                                 .peer = "meshopt_simplify",
                                 .peerValue = count / theirSeconds,
                                 .peerFrom = "run"}));
  report.add(ratioAtMost(1.0, {.id = id + "_rms",
                               .what = "RMS height error, " + from,
                               .value = rmsOf(tile, ours),
                               .unit = "m",
                               .peer = "meshopt_simplify",
                               .peerValue = rmsOf(tile, theirs),
                               .peerFrom = "run"}));
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  using namespace trimtab;
  bench::Report report(argc, argv);
  // First: its processes start as small as this one is now.
  bench::bakingRows(report);
  const std::uint32_t side = report.quick() ? 100 : 230;
  if (report.wants("simplify_hills"))
    bench::compare(report, "terrain.simplify_hills", "jittered hills",
                   test::tin("hills", {.columns = side, .rows = side}));
  const auto tile = test::sharedDir() / "data/fg-kansai-e135n35/Terrain/e130n30/e135n35/5168985.btg.gz";
  if (!report.quick() && report.wants("simplify_scenery") && std::filesystem::exists(tile))
    if (const auto mesh = terrain::readBtg(tile))
      bench::compare(report, "terrain.simplify_scenery", "tile 5168985", *mesh);
  if (report.wants("mesh")) bench::mesherRows(report);
  if (report.wants("patches")) bench::patchRows(report);
  if (report.wants("paging")) bench::pagingRows(report);
  return report.finish();
}
