#include "trimtab/terrain/patch_page.h"

#include <cmath>

namespace trimtab::terrain {

namespace {

/// No patch has more vertices than the larger of the smallest has posts: so that with no tolerance at all
/// those have every post, and no rough land makes an index too long.
constexpr std::size_t kMostVertices =
    std::size_t{PatchIndex::kLeafCells + 1} * (PatchIndex::kLeafCells + 2) / 2;

PatchDraft drafted(PageField& page, const PatchIndex& index, const PatchPlace& place,
                   const std::vector<double>& tolerances, PolygonMesher& mesher) {
  PatchDraft draft;
  draft.place = place;
  draft.edges = patchEdges(index, place);
  const int depth = place.depth();
  const PostWindow& window = page.window();
  std::vector<PatchPoint> border;
  std::vector<float> borderZ;
  const auto addHeight = [&](PatchPoint p) {
    draft.vertices.push_back(p);
    draft.heights.push_back(page.height(p));
    draft.z.push_back(static_cast<float>(page.plane().at(p.column, p.row, draft.heights.back())));
  };
  for (const PatchEdge& edge : draft.edges) {
    const std::vector<PatchPoint> line = page.side(edge, depth);
    for (std::size_t i = 0; i + 1 < line.size(); ++i) addHeight(line[i]);
  }
  for (const PatchPoint& p : draft.vertices) border.push_back({p.column - window.column, p.row - window.row});
  mesher.begin(page.field(), border, draft.z);
  for (int variant = PatchIndex::kVariants - 1; variant >= 0; --variant) {
    mesher.refine(tolerances[static_cast<std::size_t>(depth)] * std::exp2(variant / 2.0), kMostVertices);
    mesher.triangles(draft.triangles[static_cast<std::size_t>(variant)]);
  }
  for (std::size_t i = border.size(); i < mesher.vertices().size(); ++i) {
    const PatchPoint& p = mesher.vertices()[i];
    addHeight({p.column + window.column, p.row + window.row});
  }
  return draft;
}

}  // namespace

std::size_t PatchPage::bytes() const {
  std::size_t sum = 0;
  for (const PatchMesh& patch : patches)
    sum += patch.vertices.size() * sizeof(PatchVertex) + patch.indices.size() * sizeof(std::uint16_t);
  return sum;
}

BuiltPage buildPage(const PatchIndex& index, std::uint32_t page, const HeightSource& heights,
                    const PostGeometry& geometry, const std::vector<double>& tolerances) {
  const PatchIndex::Page& at = index.pages[page];
  BuiltPage built;
  built.meshes.page = page;
  std::vector<PatchDraft> drafts;
  {
    PageField field(index, at, heights, geometry, tolerances);
    PolygonMesher mesher;
    for (const PatchPlace& place : placesOfPage(index, at))
      drafts.push_back(drafted(field, index, place, tolerances, mesher));
  }
  measurePage(index, at, heights, geometry, drafts, built);
  return built;
}

}  // namespace trimtab::terrain
