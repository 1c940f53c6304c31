#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/culling/horizon.h"
#include "trimtab/culling/select.h"
#include "trimtab/scene/occlusion_conditions.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/database.h"

namespace trimtab::scene {

/// The horizon over the tiles of a cut, as they are drawn. Keeps it while the eye stays where it is, and what
/// it knows of tiles while they are in use. Needs no context.
class HorizonCulling {
 public:
  void setDatabase(std::shared_ptr<const terrain::Database> database);

  struct CutNumber {
    std::uint64_t cut = 0;   ///< another one for another cut
    std::uint64_t rule = 0;  ///< another one where not only the eye differs that it was made for
    friend bool operator==(const CutNumber&, const CutNumber&) = default;
  };
  /// Which tiles of the cut are proven hidden, in its order, whatever the view's direction. The eye must be
  /// one that `conditions` do not refuse. Empty where nothing is: also, where `skips.littleHidden`, while the
  /// eye has moved little since next to nothing was, by the same rule for the levels.
  std::span<const std::uint8_t> hidden(const LevelCut& cut, const CutNumber& number, Vec3 eye,
                                       const Horizon::Settings& settings,
                                       const OcclusionConditions& conditions, const Skips& skips);
  /// The view as the last horizon sees it: what it covers grey, what stays open white. Row 0 at the bottom.
  Renderer::Grey picture(const EyePose& eye, const ViewShape& view, int widthPx, int heightPx) const;
  const Horizon& horizon() const { return horizon_; }
  std::uint64_t built() const { return built_; }  ///< horizons, since the start
  std::uint64_t leftOut() const {
    return leftOut_;
  }  ///< calls since the start that skips.littleHidden spared
  std::uint64_t reliefs() const { return reliefs_; }  ///< tiles that were looked at for it

  /// Columns of a quarter of the circle for a depth map of this width.
  static int columnsFor(int depthMapWidthPx);
  /// How far rasterising may shift a direction, radians, where vertices keep so many bits of a pixel.
  static double slackOf(const ViewShape& view, int subpixelBits);

 private:
  struct Key {
    Vec3 eye;
    CutNumber cut;
    int columns = 0;
    double slack = 0;
    bool raised = false;
    friend bool operator==(const Key&, const Key&) = default;
  };
  const TileRelief* reliefOf(std::uint32_t node);
  bool mayOcclude(std::uint32_t node, const OcclusionConditions& conditions) const {
    return upright_[node] != 0 && conditions.mayOcclude(node);
  }
  bool hidLittleNear(const Key& key) const;
  void forgetOthers(const LevelCut& cut);

  std::shared_ptr<const terrain::Database> database_;
  std::vector<std::uint8_t> upright_;                ///< one a node: no place there has two heights
  std::vector<std::unique_ptr<TileRelief>> relief_;  ///< one a node; null until it is needed
  std::size_t kept_ = 0;
  std::vector<std::uint8_t> inCut_;  ///< one a node
  std::vector<HorizonTile> tiles_;
  Horizon horizon_;
  std::optional<Key> key_;
  terrain::TileMesh mesh_;
  std::uint64_t built_ = 0, leftOut_ = 0, reliefs_ = 0;
};

/// A tile's surface for the horizon.
void makeRelief(const terrain::TileMesh& mesh, TileRelief& relief);

}  // namespace trimtab::scene
