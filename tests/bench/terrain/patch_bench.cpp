#include "patch_bench.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "patch_peer.h"
#include "tests/core/terrain/patches/patch_support.h"
#include "trimtab/culling/select_patches.h"
#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/grid/post_plane.h"

namespace trimtab::bench {
namespace {

using namespace terrain;

/// What patches are held against: the mesh that nothing binds, for each eye and error once.
class Ground {
 public:
  explicit Ground(const HeightGrid& of)
      : grid(of),
        heights(of),
        geometry(of.posts),
        leafM(defaultLeafToleranceM(of.posts)),
        z_(of.posts.size()),
        allowed_(of.posts.size()) {
    PostPlane plane(geometry, posts().columns / 2, posts().rows / 2);
    for (std::uint32_t r = 0; r < posts().rows; ++r)
      plane.row(0, r, 1, std::span(grid.heights).subspan(std::size_t{r} * posts().columns, posts().columns),
                &z_[std::size_t{r} * posts().columns]);
  }

  const PostGrid& posts() const { return grid.posts; }
  Vec3 place(std::uint32_t c, std::uint32_t r, double above) const {
    const auto p = geometry.lattice(r, c, grid.heights[std::size_t{r} * posts().columns + c] + above);
    return Vec3{static_cast<double>(p.x) / 256, static_cast<double>(p.y) / 256,
                static_cast<double>(p.z) / 256};
  }
  /// Triangles with no error of more than so many metres anywhere.
  double free(double allowedM) {
    std::fill(allowed_.begin(), allowed_.end(), static_cast<float>(allowedM));
    return count();
  }
  /// The same with so many metres at a distance of one.
  double free(Vec3 eye, double metresAMetre) {
    double& known = known_[{eye.x, eye.y, eye.z, metresAMetre}];
    if (known > 0) return known;
    for (std::uint32_t r = 0; r < posts().rows; ++r)
      for (std::uint32_t c = 0; c < posts().columns; ++c)
        allowed_[std::size_t{r} * posts().columns + c] =
            static_cast<float>(std::max(leafM, metresAMetre * length(place(c, r, 0) - eye)));
    return known = count();
  }

  const HeightGrid& grid;
  const GridHeights heights;
  const PostGeometry geometry;
  const double leafM;

 private:
  double count() const {
    const HeightField field{z_.data(), posts().columns, posts().rows, posts().columns};
    return static_cast<double>(unconstrainedTriangles(field, allowed_));
  }
  std::vector<float> z_, allowed_;
  std::map<std::array<double, 4>, double> known_;
};

/// Triangles of views beside the mesh that nothing binds.
void viewRows(Report& report, const std::string& id, const std::string& what, Ground& ground,
              const PatchIndex& index) {
  // 1280 x 720 with 60 degrees across.
  const double pixelsPerRadian = 640 / std::tan(std::numbers::pi / 6);
  struct Eye {
    double column, row, aboveM;
  };
  std::vector<Eye> eyes{
      {0.5, 0.5, 600}, {0.5, 0.5, 3000}, {0.2, 0.3, 1500}, {0.8, 0.6, 6000}, {0.05, 0.05, 2000}};
  if (report.quick()) eyes.resize(1);
  for (const int errorPx : {1, 2}) {
    double ours = 0, theirs = 0, patches = 0, worst = 0;
    for (const Eye& eye : eyes) {
      const Vec3 at = ground.place(static_cast<std::uint32_t>(eye.column * ground.posts().columns),
                                   static_cast<std::uint32_t>(eye.row * ground.posts().rows), eye.aboveM);
      PatchCut cut;
      selectPatches(index, {}, at, {double(errorPx), 1, pixelsPerRadian}, cut);
      double triangles = 0;
      for (const TileDraw& tile : cut.cut.tiles) triangles += index.triangles[tile.node][tile.variant.number];
      const double free = ground.free(at, errorPx / pixelsPerRadian);
      ours += triangles;
      theirs += free;
      patches += static_cast<double>(cut.cut.tiles.size());
      worst = std::max(worst, triangles / free);
    }
    report.add(ratioAtMost(
        1.25,
        {.id = id + "_view" + (errorPx == 1 ? "" : "_" + std::to_string(errorPx) + "px"),
         .what = "Triangles of views of " + what + ", " + std::to_string(errorPx) + " px at 1280 x 720, in " +
                 std::to_string(static_cast<int>(patches / static_cast<double>(eyes.size()))) +
                 " patches a view; worst view " + std::to_string(worst).substr(0, 4),
         .value = ours,
         .unit = "triangles",
         .peer = "unconstrained greedy mesh",
         .peerValue = theirs,
         .peerFrom = "run"}));
  }
}

void rows(Report& report, const std::string& id, const std::string& what, const HeightGrid& grid) {
  Ground ground(grid);
  std::shared_ptr<const PatchTerrain> terrain;
  const auto build = [&](std::uint32_t leafCells) {
    return leastSeconds(report.quick() ? 1 : 3,
                        [&] { terrain = buildPatches(ground.heights, ground.leafM, leafCells); });
  };
  const auto shapeRows = [&](const std::string& of, const std::string& name, double seconds) {
    report.add(
        {.id = of + "_seconds", .what = "Building all levels of " + name, .value = seconds, .unit = "s"});
    double bytes = 0;
    for (std::uint32_t page = 0; page < terrain->index().pages.size(); ++page)
      bytes += static_cast<double>(terrain->pageBytes(page));
    report.add({.id = of + "_bytes",
                .what = "Vertices and indices of all levels of " + name,
                .value = bytes / static_cast<double>(grid.posts.size()),
                .unit = "bytes/post"});
    viewRows(report, of, name, ground, terrain->index());
  };
  const double large = build(kCoarseLeafCells);
  shapeRows(id + "_large", what + " as a large terrain's patches", large);
  const double seconds = build(leafCellsOf(grid.posts));
  shapeRows(id, what, seconds);
  const PatchIndex& index = terrain->index();

  // A single level has the error of its worst patch: what the peer is allowed.
  double worstLevel = 0, levelTheirs = 0;
  std::size_t levelOurs = 0;
  const int depths = *std::max_element(index.depth.begin(), index.depth.end()) + 1;
  for (int depth = depths - (report.quick() ? 1 : 6); depth < depths; ++depth) {
    std::size_t triangles = 0;
    for (std::uint32_t p = 0; p < index.size(); ++p)
      if (index.depth[p] == depth) triangles += index.triangles[p][0];
    const double free = ground.free(patchTolerances(index, ground.leafM)[static_cast<std::size_t>(depth)]);
    const double ratio = static_cast<double>(triangles) / free;
    if (ratio > worstLevel) worstLevel = ratio, levelOurs = triangles, levelTheirs = free;
  }
  report.add(ratioAtMost(1.05, {.id = id + "_level",
                                .what = "Triangles of the worst of six single levels of " + what,
                                .value = static_cast<double>(levelOurs),
                                .unit = "triangles",
                                .peer = "unconstrained greedy mesh",
                                .peerValue = levelTheirs,
                                .peerFrom = "run"}));
}

}  // namespace

void patchRows(Report& report) {
  const std::uint32_t side = report.quick() ? 257 : 1201;
  rows(report, "terrain.patches_fractal", "fractal ground",
       test::fractal({10, 45, 1.0 / 1200, 1.0 / 1200, side, side}, 7));
  if (report.quick() || !std::filesystem::exists(test::sharedDir() / "data/dem-srtm3-everest/N27E086.hgt"))
    return;
  rows(report, "terrain.patches_everest", "the Everest cell",
       test::imported("data/dem-srtm3-everest/N27E086.hgt"));
}

}  // namespace trimtab::bench
