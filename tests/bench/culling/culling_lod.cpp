#include "culling_lod.h"

#include <osg/LOD>

#include <limits>
#include <random>

#include "culling_frames.h"
#include "osg_cull.h"
#include "trimtab/culling/select.h"

namespace trimtab::bench {
namespace {

/// Ranges are from the bounding sphere's middle, so what is nearer than the sphere's own radius and the
/// distance at which the error shows is split: the same screen-space error holds as ours.
osg::ref_ptr<osg::Node> lodTree(const TerrainIndex& index, std::uint32_t node, double metresPerError) {
  osg::ref_ptr<BoundOnly> tile = new BoundOnly(index.bounds[node], node);
  if (index.level[node] == 0) return tile;
  osg::ref_ptr<osg::Group> finer = new osg::Group;
  for (const std::uint32_t child : index.children[node])
    if (child != TerrainIndex::kNone) finer->addChild(lodTree(index, child, metresPerError));
  osg::ref_ptr<osg::LOD> lod = new osg::LOD;
  const osg::BoundingSphere sphere(boundOf(index.bounds[node]));
  lod->setCenterMode(osg::LOD::USER_DEFINED_CENTER);
  lod->setCenter(sphere.center());
  lod->setRadius(sphere.radius());
  const float split = static_cast<float>(index.errorM[node] * metresPerError) + sphere.radius();
  lod->addChild(finer, 0, split);
  lod->addChild(tile, split, std::numeric_limits<float>::max());
  return lod;
}

class LodPeer {
 public:
  LodPeer(const TerrainIndex& index, double metresPerError) {
    for (std::uint32_t node = 0; node < index.size(); ++node)
      if (index.parent[node] == TerrainIndex::kNone) root_->addChild(lodTree(index, node, metresPerError));
    root_->getBound();
  }
  /// Tiles of one cull traversal.
  std::size_t cull(const EyePose& eye, const ViewShape& view) { return traversal_.cull(*root_, eye, view); }

 private:
  osg::ref_ptr<osg::Group> root_ = new osg::Group;
  CullTraversal traversal_;
};

}  // namespace

void lodRows(Report& report, const std::string& name,
             const std::shared_ptr<const terrain::Database>& database) {
  const TerrainIndex& index = database->index();
  const ViewShape view;
  const double scale = pixelsPerRadian(view);
  LodPeer peer(index, scale / kErrorPx);
  LevelCut cut;
  VisibleSet visible;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.25, 0.75), heading(0, 360);
  constexpr double kTrianglesATile = 2.0 * TerrainIndex::kTileCells * TerrainIndex::kTileCells;
  double ours = 0, theirs = 0, triangles = 0, theirTriangles = 0, tiles = 0, theirTiles = 0;
  const int views = report.quick() ? 6 : 24;
  for (int i = 0; i < views; ++i) {
    const double east = place(random), north = place(random);
    const GeodeticPosition at = placeOver(*database, east, north, 610);
    const Attitude attitude{Degrees{heading(random)}, Degrees{-5}, Degrees{0}};
    const EyePose eye{index.frame.fromGeodetic(at), eyeAxes(index.frame, at, attitude)};
    const auto select = [&] {
      selectLevels(index, eye.position, {kErrorPx, 1, scale}, cut);
      selectVisible(cut, {.eye = eye, .view = view}, visible);
    };
    std::size_t kept = 0;
    const auto [least, theirLeast] =
        leastInTurn(5, std::pair{4, select}, std::pair{4, [&] { kept = peer.cull(eye, view); }});
    ours += least;
    theirs += theirLeast;
    triangles += static_cast<double>(visible.triangles);
    tiles += static_cast<double>(visible.tiles.size());
    theirTriangles += kTrianglesATile * static_cast<double>(kept);
    theirTiles += static_cast<double>(kept);
  }
  char text[160];
  std::snprintf(text, sizeof text,
                " over %s at 2,000 ft, %g px, mean of %d views: %.0f tiles, by the peer %.0f", name.c_str(),
                kErrorPx, views, tiles / views, theirTiles / views);
  Row row{.id = "culling.lod_select_" + name,
          .what = std::string("Choosing levels and tiles in view") + text,
          .value = 1e3 * ours / views,
          .unit = "ms",
          .peer = "cull traversal of a quadtree of osg::LOD",
          .peerValue = 1e3 * theirs / views,
          .peerFrom = "run"};
  report.add(ratioAtMost(1, row));
  row.id = "culling.lod_triangles_" + name;
  row.what = std::string("Triangles for the same screen-space error") + text;
  row.value = triangles / views, row.unit = "triangles";
  row.peer = "a quadtree of osg::LOD", row.peerValue = theirTriangles / views;
  report.add(ratioAtMost(1, row));
}

}  // namespace trimtab::bench
