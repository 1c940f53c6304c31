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

/// The parts of buildPage(): the posts of a page, the drafts of its patches, and what is measured on them.
namespace trimtab::terrain {

/// One patch as vertices at posts, before their places in the frame are computed. Keeps its storage from
/// patch to patch.
struct PatchDraft {
  PatchPlace place;
  std::vector<PatchEdge> edges;
  std::vector<PatchPoint> vertices;  ///< the border's first
  std::vector<float> heights;        ///< per vertex, metres
  std::vector<float> z;              ///< per vertex, metres above the page's plane
  struct Variant {
    std::vector<std::uint32_t> triangles;  ///< three vertices per triangle
    std::vector<std::int32_t> twins;       ///< as PolygonMesher::triangles gives them
    std::vector<std::uint32_t> fresh;      ///< triangles that the next finer variant does not have
    std::vector<Inherited> inherited;  ///< per triangle of the next finer variant, what this one has there;
                                       ///< all `other` in the finest
    double worst = 0, rms = 0;  ///< errors along the plane's normal, at the posts that it was meshed on
  };
  std::vector<Variant> variants;  ///< from the finest, as many as the index has
  /// The drawing order of the finest variant: the half-edge at which each triangle begins (TriangleOrder).
  /// Coarser variants follow the same order, by the numbers of their triangles.
  std::vector<std::int32_t> order;

  /// Calls `work(t, corners)` for the fresh triangles of a variant; most triangles are those of the finer
  /// one. A maximum is therefore carried on from the finest variant, and never falls.
  template <class Work>
  void eachNew(std::size_t v, const Work& work) const {
    for (const std::uint32_t t : variants[v].fresh) work(std::size_t{t}, &variants[v].triangles[3 * t]);
  }
};

/// Returns the distance in posts at which the pages of a pair of depths are meshed; 1 if they use every post.
std::uint32_t meshStride(const PatchIndex& index, int pair);
/// Returns the posts that a page's patches cover.
PostWindow pageWindow(const PatchIndex& index, const PatchIndex::Page& page);
/// Returns the plane that touches the ellipsoid in the middle of a page.
PostPlane pagePlane(const PostGeometry& geometry, const PostWindow& window);

/// Holds the posts that a page is meshed on, and simplifies the sides of its patches.
class PageField {
 public:
  PageField(const PatchIndex& index, const PatchIndex::Page& page, const HeightSource& heights,
            const PostGeometry& geometry, const std::vector<double>& tolerances);

  const PostWindow& window() const { return window_; }
  std::uint32_t stride() const { return stride_; }
  /// Returns heights above the page's plane; places are relative to the window.
  HeightField field() const { return {z_.data(), columns_, rows_, columns_, stride_}; }
  const PostPlane& plane() const { return plane_; }
  float height(PatchPoint p) const;

  /// Returns the polyline of an edge, both ends included. It depends only on the posts along the edge and on
  /// the tolerance of the depth, so the patches on both sides draw the same line, whatever page they are in.
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
  /// The key is the depth and the two ends, the lesser end first. The depth is part of it because sides of
  /// two depths can have the same ends where the posts end.
  std::map<std::array<std::uint32_t, 5>, std::vector<PatchPoint>> sides_;
  std::vector<float> strip_;
};

/// Places a draft's vertices in the local frame and returns its mesh without normals. Sets `bounds` to its
/// own box.
PatchMesh patchMesh(const PatchIndex& index, const PostGeometry& geometry, const PatchDraft& draft,
                    Box& bounds);
/// Returns the cone of the normals of all triangles of a patch, whatever variant draws them.
NormalCone patchCone(const PatchDraft& draft, const PatchMesh& mesh);

/// Returns a patch of the page by its number; valid until the next call. A page that is measured in several
/// strips asks for each patch once per strip.
using DraftOf = std::function<const PatchDraft&(std::size_t)>;

/// Measures errors, facts and normals of a page's patches on all posts, strip by strip, and fills `built`.
/// Returns false if `carryOn` returned false; `built` is then incomplete.
bool measurePage(const PatchIndex& index, const PatchIndex::Page& page, const HeightSource& heights,
                 const PostGeometry& geometry, std::size_t patches, const DraftOf& draftOf,
                 const std::function<bool()>& carryOn, BuiltPage& built);

}  // namespace trimtab::terrain
