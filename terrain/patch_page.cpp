#include "trimtab/terrain/patch_page.h"

#include <cmath>

namespace trimtab::terrain {

namespace {

/// As many as the half of a square of 64 cells has posts: no rough land makes a patch's indices too long, and
/// with no tolerance at all the smallest patches still get every post.
constexpr std::size_t kMostVertices = 65 * 66 / 2;
static_assert(kMostVertices >= (PatchIndex::kLeafCells + 1) * (PatchIndex::kLeafCells + 2) / 2);
/// Variants are a quarter of an octave apart: four of them span the octave and a half between what a patch is
/// split at and what its neighbours force on it.
constexpr double kVariantOctaves = 0.25;

/// Triangles of a variant that a finer one, or none, does not have in the same place.
std::vector<std::uint32_t> freshTriangles(const std::vector<std::uint32_t>& triangles,
                                          const std::vector<std::uint32_t>* finer) {
  std::vector<std::uint32_t> fresh(triangles.size() / 3);
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < triangles.size() / 3; ++t) {
    const std::uint32_t* const c = &triangles[3 * std::size_t{t}];
    fresh[count] = t;
    // About every other one is: which cannot be guessed.
    const std::uint32_t* const f = finer != nullptr ? &(*finer)[3 * std::size_t{t}] : nullptr;
    count += f == nullptr || ((c[0] ^ f[0]) | (c[1] ^ f[1]) | (c[2] ^ f[2])) != 0 ? 1 : 0;
  }
  fresh.resize(count);
  return fresh;
}

PatchDraft drafted(PageField& page, const PatchIndex& index, const PatchPlace& place,
                   const std::vector<double>& tolerances, PolygonMesher& mesher) {
  PatchDraft draft;
  draft.place = place;
  draft.edges = patchEdges(index, place);
  const int depth = place.depth();
  const PostWindow& window = page.window();
  std::vector<PatchPoint> border;
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
  draft.border = border.size();
  mesher.begin(page.field(), border, draft.z);
  for (int variant = PatchIndex::kVariants - 1; variant >= 0; --variant) {
    mesher.refine(tolerances[static_cast<std::size_t>(depth)] * std::exp2(variant * kVariantOctaves),
                  kMostVertices);
    PatchDraft::Variant& of = draft.variants[static_cast<std::size_t>(variant)];
    mesher.triangles(of.triangles);
    mesher.triangleStrips(of.strips);
    if (page.stride() != 1) continue;
    of.worst = mesher.maxErrorM();
    of.rms = mesher.rmsErrorM();
  }
  for (std::size_t v = 0; v < draft.variants.size(); ++v)
    draft.variants[v].fresh =
        freshTriangles(draft.variants[v].triangles, v == 0 ? nullptr : &draft.variants[v - 1].triangles);
  for (std::size_t i = border.size(); i < mesher.vertices().size(); ++i) {
    const PatchPoint& p = mesher.vertices()[i];
    addHeight({p.column + window.column, p.row + window.row});
  }
  return draft;
}

/// Of the front faces of all of a patch's triangles, whatever variant draws them.
NormalCone coneOf(const PatchDraft& draft, const PatchMesh& mesh) {
  std::vector<Vec3> normals;
  normals.reserve(2 * draft.variants[0].triangles.size() / 3);
  for (std::size_t v = 0; v < PatchIndex::kVariants; ++v)
    draft.eachNew(v, [&](std::size_t, const std::uint32_t* corners) {
      const auto place = [&](std::size_t corner) {
        const PatchVertex& at = mesh.vertices[corners[corner]];
        return Vec3{at.x, at.y, at.z};
      };
      const Vec3 a = place(0), normal = cross(place(1) - a, place(2) - a);
      // One without an area draws nothing.
      if (const double area = dot(normal, normal); area != 0)
        normals.push_back(normal * (1 / std::sqrt(area)));
    });
  return NormalCone::of(normals);
}

}  // namespace

std::size_t PatchPage::bytes() const {
  std::size_t sum = 0;
  for (const PatchMesh& patch : patches)
    sum += patch.vertices.size() * sizeof(PatchVertex) + patch.indices.size() * sizeof(std::uint16_t);
  return sum;
}

BuiltPage buildPage(const PatchIndex& index, std::uint32_t page, const HeightSource& heights,
                    const PostGeometry& geometry, const std::vector<double>& tolerances,
                    const std::function<bool()>& carryOn) {
  const PatchIndex::Page& at = index.pages[page];
  BuiltPage built;
  built.meshes.page = page;
  std::vector<PatchDraft> drafts;
  {
    PageField field(index, at, heights, geometry, tolerances);
    PolygonMesher mesher;
    for (const PatchPlace& place : placesOfPage(index, at)) {
      if (carryOn && !carryOn()) return built;
      drafts.push_back(drafted(field, index, place, tolerances, mesher));
    }
  }
  if (!measurePage(index, at, heights, geometry, drafts, carryOn, built)) {
    built = {};
    built.meshes.page = page;
  }
  for (std::size_t i = 0; i < built.meshes.patches.size(); ++i)
    built.cones.push_back(coneOf(drafts[i], built.meshes.patches[i]));
  return built;
}

}  // namespace trimtab::terrain
