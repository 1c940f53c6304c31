#include "trimtab/terrain/patches/build.h"

#include <algorithm>
#include <utility>

#include "trimtab/terrain/grid/parallel.h"

namespace trimtab::terrain {

namespace {

class PatchesInMemory final : public PatchTerrain {
 public:
  PatchIndex index_;
  std::vector<PatchFacts> facts_;
  std::vector<PatchPage> pages_;

  const PatchIndex& index() const override { return index_; }
  const std::vector<PatchFacts>& facts() const override { return facts_; }
  Result<PatchPage> readPage(std::uint32_t page) const override { return pages_[page]; }
  std::uint64_t pageBytes(std::uint32_t page) const override { return pages_[page].bytes(); }
};

}  // namespace

std::shared_ptr<const PatchTerrain> buildPatches(const HeightSource& heights, double leafToleranceM,
                                                 std::uint32_t leafCells) {
  const PostGeometry geometry(heights.posts());
  auto terrain = std::make_shared<PatchesInMemory>();
  terrain->index_ = makePatchIndex(heights.posts(), geometry, leafCells);
  PatchIndex& index = terrain->index_;
  const std::vector<double> tolerances = patchTolerances(index, leafToleranceM);
  const auto pageCount = static_cast<std::uint32_t>(index.pages.size());
  std::vector<Box> bounds(index.size());
  VariantTable<float> errorM(index.variants(), index.size());
  VariantTable<std::uint16_t> triangles(index.variants(), index.size());
  std::vector<NormalCone> cones(index.size());
  terrain->facts_.resize(index.size());
  terrain->pages_.resize(pageCount);
  const auto work = [&](std::uint32_t page) {
    BuiltPage built = buildPage(index, page, heights, geometry, tolerances);
    const auto first = static_cast<std::ptrdiff_t>(index.pages[page].firstPatch);
    std::copy(built.bounds.begin(), built.bounds.end(), bounds.begin() + first);
    std::ranges::copy(built.errorM.values(),
                      errorM.values(index.pages[page].firstPatch, index.pages[page].patches).begin());
    std::copy(built.cones.begin(), built.cones.end(), cones.begin() + first);
    std::copy(built.facts.begin(), built.facts.end(), terrain->facts_.begin() + first);
    std::size_t patch = index.pages[page].firstPatch;
    for (const PatchMesh& mesh : built.meshes.patches) countTriangles(mesh, triangles[patch++]);
    terrain->pages_[page] = std::move(built.meshes);
  };
  forEachParallel(pageCount, work);
  finishPatchIndex(index, std::move(bounds), std::move(errorM), std::move(triangles));
  index.cones = std::move(cones);
  return terrain;
}

}  // namespace trimtab::terrain
