#include "page.h"

#include <cmath>

#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/mesh/order.h"

namespace trimtab::terrain {

namespace {

/// The number of posts in half a square of 64 cells. With this limit no rough land makes a patch's indices
/// too long, and the smallest patches still get every post at a tolerance of 0.
constexpr std::size_t kMostVertices = 65 * 66 / 2;
static_assert(kMostVertices >= (kCoarseLeafCells + 1) * (kCoarseLeafCells + 2) / 2);

/// Finds the triangles of a variant that a finer one, or none, does not have in the same place.
void findFresh(PatchDraft::Variant& of, const PatchDraft::Variant* finer) {
  const std::size_t triangles = of.triangles.size() / 3;
  of.fresh.resize(triangles);
  of.inherited.assign(finer != nullptr ? finer->triangles.size() / 3 : triangles, Inherited::none);
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const std::uint32_t* const c = &of.triangles[3 * std::size_t{t}];
    const std::uint32_t* const f = finer != nullptr ? &finer->triangles[3 * std::size_t{t}] : nullptr;
    const bool fresh = f == nullptr || ((c[0] ^ f[0]) | (c[1] ^ f[1]) | (c[2] ^ f[2])) != 0;
    of.fresh[count] = t;
    of.inherited[t] = fresh ? Inherited::other : Inherited::same;
    count += fresh ? 1 : 0;
  }
  of.fresh.resize(count);
}

/// Makes the drafts of a page's patches, one at a time.
class Drafter {
 public:
  Drafter(const PatchIndex& index, const PatchIndex::Page& page, const HeightSource& heights,
          const PostGeometry& geometry, const std::vector<double>& tolerances)
      : index_(index),
        octaves_(variantsOf(index.leafCells).octaves),
        tolerances_(tolerances),
        field_(index, page, heights, geometry, tolerances) {}

  std::uint32_t stride() const { return field_.stride(); }

  void make(const PatchPlace& place, PatchDraft& draft) {
    draft.place = place;
    draft.edges = patchEdges(index_, place);
    draft.vertices.clear();
    draft.heights.clear();
    draft.z.clear();
    const int depth = place.depth();
    const PostWindow& window = field_.window();
    const auto addHeight = [&](PatchPoint p) {
      draft.vertices.push_back(p);
      draft.heights.push_back(field_.height(p));
      draft.z.push_back(static_cast<float>(field_.plane().at(p.column, p.row, draft.heights.back())));
    };
    for (const PatchEdge& edge : draft.edges) {
      const std::vector<PatchPoint> line = field_.side(edge, depth);
      for (std::size_t i = 0; i + 1 < line.size(); ++i) addHeight(line[i]);
    }
    border_.clear();
    for (const PatchPoint& p : draft.vertices)
      border_.push_back({p.column - window.column, p.row - window.row});
    mesher_.begin(field_.field(), border_, draft.z);
    draft.variants.resize(index_.variants());
    for (std::size_t variant = draft.variants.size(); variant-- > 0;) {
      mesher_.refine(
          tolerances_[static_cast<std::size_t>(depth)] * std::exp2(static_cast<double>(variant) * octaves_),
          kMostVertices);
      PatchDraft::Variant& of = draft.variants[variant];
      mesher_.triangles(of.triangles, &of.twins);
      if (field_.stride() != 1) continue;
      of.worst = mesher_.maxErrorM();
      of.rms = mesher_.rmsErrorM();
    }
    for (std::size_t v = 0; v < draft.variants.size(); ++v)
      findFresh(draft.variants[v], v == 0 ? nullptr : &draft.variants[v - 1]);
    order_.order(draft.variants[0].twins, draft.order);
    for (std::size_t i = border_.size(); i < mesher_.vertices().size(); ++i) {
      const PatchPoint& p = mesher_.vertices()[i];
      addHeight({p.column + window.column, p.row + window.row});
    }
  }

 private:
  const PatchIndex& index_;
  double octaves_;  ///< between the tolerances of two variants
  const std::vector<double>& tolerances_;
  PageField field_;
  PolygonMesher mesher_;
  TriangleOrder order_;
  std::vector<PatchPoint> border_;
};

}  // namespace

BuiltPage buildPage(const PatchIndex& index, std::uint32_t page, const HeightSource& heights,
                    const PostGeometry& geometry, const std::vector<double>& tolerances,
                    const std::function<bool()>& carryOn) {
  const PatchIndex::Page& at = index.pages[page];
  const std::vector<PatchPlace> places = placesOfPage(index, at);
  BuiltPage built;
  built.errorM = VariantTable<float>(index.variants());
  Drafter drafter(index, at, heights, geometry, tolerances);
  std::vector<PatchDraft> drafts(1);
  bool measured;
  if (drafter.stride() == 1) {
    const auto draftOf = [&](std::size_t i) -> const PatchDraft& {
      drafter.make(places[i], drafts[0]);
      return drafts[0];
    };
    measured = measurePage(index, at, heights, geometry, places.size(), draftOf, carryOn, built);
  } else {
    drafts.resize(places.size());
    bool more = true;
    for (std::size_t i = 0; i < places.size() && more; ++i) {
      drafter.make(places[i], drafts[i]);
      more = !carryOn || carryOn();
    }
    const auto draftOf = [&](std::size_t i) -> const PatchDraft& { return drafts[i]; };
    measured = more && measurePage(index, at, heights, geometry, places.size(), draftOf, carryOn, built);
  }
  if (!measured) built = {};
  built.meshes.page = page;
  return built;
}

}  // namespace trimtab::terrain
