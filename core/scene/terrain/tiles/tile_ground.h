#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/scene/occlusion/occlusion_conditions.h"
#include "core/scene/occlusion/occlusion_ground.h"
#include "core/scene/surface/surfaces_in_use.h"
#include "core/scene/terrain/box_lids.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// The terrain's levels of square tiles as ground that hides and is hidden.
class TileGround final : public OcclusionGround {
 public:
  void setDatabase(std::shared_ptr<const terrain::Database> database);
  /// Sets the cut of this frame; both must live until the next one.
  void setCut(const LevelCut& cut, const CutNumber& number) { cut_ = &cut, number_ = &number; }

  const LevelCut& cut() const override { return *cut_; }
  const CutNumber& cutNumber() const override { return *number_; }
  std::string refusal(const EyePose& eye, const ViewShape& view) override {
    return conditions_.refusal(*cut_, eye, view);
  }
  std::size_t makeSurfaces(Vec3 eye) override;
  void fill(std::vector<HorizonTile>& tiles) override;
  SurfaceTree tree() const override { return SurfaceTree::of(database_->index()); }
  bool mayOcclude(std::uint32_t node) override { return upright_[node] != 0 && conditions_.mayOcclude(node); }
  bool replacementsStayNear(std::uint32_t node) const override { return replacementsStayNear_[node] != 0; }
  void forgetOthers() override {
    relief_.forgetOthers(*cut_);
    lids_.forgetOthers(*cut_);
  }

  const OcclusionConditions& conditions() const { return conditions_; }

 private:
  std::shared_ptr<const terrain::Database> database_;
  OcclusionConditions conditions_;
  const LevelCut* cut_ = nullptr;
  const CutNumber* number_ = nullptr;
  std::vector<std::uint8_t> upright_;               ///< per node: no place there has two heights
  std::vector<std::uint8_t> replacementsStayNear_;  ///< per node
  SurfacesInUse<TileRelief> relief_;                ///< 15 KB each
  BoxLids lids_;
  std::vector<std::uint8_t> inCut_;  ///< per node, all 0 except during `fill`
  terrain::TileMesh mesh_;
};

/// Fills `relief` with a tile's surface for the horizon.
void makeRelief(const terrain::TileMesh& mesh, TileRelief& relief);

}  // namespace trimtab::scene
