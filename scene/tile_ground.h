#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/culling/select.h"
#include "trimtab/scene/horizon_memory.h"
#include "trimtab/scene/occlusion_conditions.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/database.h"

namespace trimtab::scene {

/// The horizon over the tiles of a cut, as they are drawn. Keeps it while the eye stays where it is, and what
/// it knows of tiles while they are in use. Needs no context.
class HorizonCulling {
 public:
  void setDatabase(std::shared_ptr<const terrain::Database> database);

  using CutNumber = HorizonMemory::CutNumber;
  static int columnsFor(int depthMapWidthPx) { return HorizonMemory::columnsFor(depthMapWidthPx); }
  static double slackOf(const ViewShape& view, int bits) { return HorizonMemory::slackOf(view, bits); }
  /// Which tiles of the cut are proven hidden, in its order, whatever the view's direction. The eye must be
  /// one that `conditions` do not refuse. Empty where nothing is: also, where `skips.littleHidden`, while the
  /// eye has moved little since next to nothing was, by the same rule for the levels.
  std::span<const std::uint8_t> hidden(const LevelCut& cut, const CutNumber& number, Vec3 eye,
                                       const Horizon::Settings& settings,
                                       const OcclusionConditions& conditions, const Skips& skips);
  Renderer::Grey picture(const EyePose& eye, const ViewShape& view, int widthPx, int heightPx) const {
    return memory_.picture(eye, view, widthPx, heightPx);
  }
  const Horizon& horizon() const { return memory_.horizon(); }
  std::uint64_t built() const { return memory_.built(); }
  std::uint64_t leftOut() const { return memory_.leftOut(); }
  std::uint64_t reliefs() const { return reliefs_; }  ///< tiles that were looked at for it

 private:
  const TileRelief* reliefOf(std::uint32_t node);
  bool mayOcclude(std::uint32_t node, const OcclusionConditions& conditions) const {
    return upright_[node] != 0 && conditions.mayOcclude(node);
  }
  void fill(const LevelCut& cut, const OcclusionConditions& conditions, std::vector<HorizonTile>& tiles);
  void forgetOthers(const LevelCut& cut);

  std::shared_ptr<const terrain::Database> database_;
  std::vector<std::uint8_t> upright_;                ///< one a node: no place there has two heights
  std::vector<std::unique_ptr<TileRelief>> relief_;  ///< one a node; null until it is needed
  std::size_t kept_ = 0;
  std::vector<std::uint8_t> inCut_;  ///< one a node
  HorizonMemory memory_;
  terrain::TileMesh mesh_;
  std::uint64_t reliefs_ = 0;
};

/// A tile's surface for the horizon.
void makeRelief(const terrain::TileMesh& mesh, TileRelief& relief);

}  // namespace trimtab::scene
