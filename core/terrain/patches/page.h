#pragma once

#include <array>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "trimtab/terrain/format/patch_shape.h"
#include "trimtab/terrain/grid/post_plane.h"
#include "trimtab/terrain/mesh/mesher.h"
#include "trimtab/terrain/patches/build.h"

/// What building a page works with.
namespace trimtab::terrain {

/// Vertices and triangles of one patch before its positions are known. Keeps its storage from patch to patch.
struct PatchDraft {
  PatchPlace place;
  std::vector<PatchEdge> edges;
  std::vector<PatchPoint> vertices;  ///< the border's first
  std::vector<float> heights;        ///< one a vertex
  std::vector<float> z;              ///< above the page's plane
  struct Variant {
    std::vector<std::uint32_t> triangles;  ///< three a triangle
    std::vector<std::int32_t> twins;       ///< of PolygonMesher::triangles
    std::vector<std::uint32_t> fresh;      ///< those that the next finer variant does not have
    std::vector<Heir> heirs;    ///< of the next finer variant's triangles; all others of the finest's
    double worst = 0, rms = 0;  ///< above the plane, at the posts that it was meshed on
  };
  std::vector<Variant> variants;  ///< from the finest, as many as the index has
  /// Of the finest variant's triangles as they are drawn and packed: half-edges to begin from. A coarser
  /// one's are drawn in the same order, by their places among the triangles.
  std::vector<std::int32_t> order;

  /// Calls `work(t, corners)` for the fresh triangles of a variant: most stay where they were. So everything
  /// that is a maximum is taken from the finest variant on, and never falls.
  template <class Work>
  void eachNew(std::size_t v, const Work& work) const {
    for (const std::uint32_t t : variants[v].fresh) work(std::size_t{t}, &variants[v].triangles[3 * t]);
  }
};

/// Posts from one to the next at which pages of a pair are meshed.
std::uint32_t meshStride(const PatchIndex& index, int pair);
/// The posts that a page's patches cover.
PostWindow pageWindow(const PatchIndex& index, const PatchIndex::Page& page);
/// Touches the ellipsoid in the middle of a page.
PostPlane pagePlane(const PostGeometry& geometry, const PostWindow& window);

/// The posts that a page is meshed on, and its patches' sides.
class PageField {
 public:
  PageField(const PatchIndex& index, const PatchIndex::Page& page, const HeightSource& heights,
            const PostGeometry& geometry, const std::vector<double>& tolerances);

  const PostWindow& window() const { return window_; }
  std::uint32_t stride() const { return stride_; }
  /// Above the page's plane, by places relative to the window.
  HeightField field() const { return {z_.data(), columns_, rows_, columns_, stride_}; }
  const PostPlane& plane() const { return plane_; }
  float height(PatchPoint p) const;

  /// The polyline of an edge, both ends in it: a function of the posts along it and of its tolerance only, so
  /// that both patches at it, in whatever page, draw the same.
  std::vector<PatchPoint> side(const PatchEdge& edge, int depth);

 private:
  std::vector<PatchPoint> simplified(PatchPoint from, PatchPoint to, std::uint32_t step, double tolerance);

  const PatchIndex& index_;
  const HeightSource& heights_;
  const PostGeometry& geometry_;
  const std::vector<double>& tolerances_;
  PostWindow window_;
  std::uint32_t stride_, columns_, rows_;
  PostPlane plane_;
  std::vector<float> raw_, z_;
  /// By depth and ends, the lesser first: cut off, sides of two depths can have the same ends.
  std::map<std::array<std::uint32_t, 5>, std::vector<PatchPoint>> sides_;
  std::vector<float> strip_;
};

/// A draft's mesh in the frame, all but its normals; its own bounds.
PatchMesh patchMesh(const PatchIndex& index, const PostGeometry& geometry, const PatchDraft& draft,
                    Box& bounds);
/// Of the front faces of all of a patch's triangles, whatever variant draws them.
NormalCone patchCone(const PatchDraft& draft, const PatchMesh& mesh);

/// A patch of the page by its number; good until the next is asked for. Pages meshed on every so-manyth post
/// ask for each several times, others once.
using DraftOf = std::function<const PatchDraft&(std::size_t)>;

/// Measures errors, facts and normals of a page's patches on all posts, strip by strip, and fills `built`.
/// False where `carryOn` said no: what is in `built` then is of no use.
bool measurePage(const PatchIndex& index, const PatchIndex::Page& page, const HeightSource& heights,
                 const PostGeometry& geometry, std::size_t patches, const DraftOf& draftOf,
                 const std::function<bool()>& carryOn, BuiltPage& built);

}  // namespace trimtab::terrain
