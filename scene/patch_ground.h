#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/horizon_memory.h"
#include "trimtab/scene/patch_culling.h"

namespace trimtab::scene {

/// The horizon over the patches of a cut, as they are drawn; keeps what it knows of patches while they are in
/// use. Needs no context.
class PatchHorizon {
 public:
  /// Null: none.
  void setTerrain(std::shared_ptr<const terrain::Database> database);

  /// Why nothing may be hidden from this eye; empty when it may.
  std::string refusal(const PatchCulling& patches, const EyePose& eye, const ViewShape& view);
  /// Which patches of the cut are proven hidden, in its order; see HorizonMemory::hidden.
  std::span<const std::uint8_t> hidden(const PatchCulling& patches, const HorizonMemory::CutNumber& number,
                                       Vec3 eye, const Horizon::Settings& settings, const Skips& skips);

  const HorizonMemory& memory() const { return memory_; }
  std::uint64_t reliefs() const { return reliefs_; }  ///< meshes that were looked at for it

 private:
  struct Surface {
    MeshRelief relief;
    std::uint8_t variant = 0;
    bool inside = false;  ///< so far from the data's edge that no way to it leads over the edge
  };
  /// Null where the patch's page is not there.
  const Surface* surfaceOf(const PatchCulling& patches, TileDraw patch);
  void fill(const PatchCulling& patches, std::vector<HorizonTile>& tiles);
  void forgetOthers(const LevelCut& cut);

  std::shared_ptr<const terrain::Database> database_;
  DataExtent extent_;
  std::uint32_t marginColumns_ = 0, marginRows_ = 0;  ///< posts that `inside` asks for
  std::vector<std::unique_ptr<Surface>> surfaces_;    ///< one a patch; null until it is needed
  std::size_t kept_ = 0;
  std::vector<ReliefVertex> vertices_;
  HorizonMemory memory_;
  std::uint64_t reliefs_ = 0;
};

/// A patch's surface for the horizon: one of its variants.
void makeRelief(const terrain::PatchMesh& mesh, int variant, std::vector<ReliefVertex>& vertices,
                MeshRelief& relief);

}  // namespace trimtab::scene
