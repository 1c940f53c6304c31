#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "trimtab/frame/frame_levers.h"

/// The columns of a trace that hold the chain of the levers.
namespace trimtab::trace {

/// Says whether a cell may be empty; cells of the frame are all empty where no frame showed the decision, and
/// those of `hold` where no budget was held. Columns that are `former` are read, but not written.
enum class Cell { required, optional, frame, hold, former };

/// A lever after each step of the chain; unset in traces from before there was one.
using ChainCell = std::optional<std::array<double, kLeverSteps>>;
/// The levers of FrameLevers that are numbers, with their columns.
struct ChainColumn {
  const char* name;
  double FrameLevers::*lever;
};
inline constexpr std::array<ChainColumn, 11> kChainColumns{
    {{"chain_error_px", &FrameLevers::errorPx},
     {"chain_tree_error_px", &FrameLevers::treeErrorPx},
     {"chain_lod_scale", &FrameLevers::lodScale},
     {"chain_level_spread", &FrameLevers::levelSpread},
     {"chain_far_m", &FrameLevers::farM},
     {"chain_render_scale", &FrameLevers::renderScale},
     {"chain_particles", &FrameLevers::particleShare},
     {"chain_blur_strength", &FrameLevers::blurStrength},
     {"chain_object_error_px", &FrameLevers::objectErrorPx},
     {"chain_small_feature_px", &FrameLevers::smallFeaturePx},
     {"chain_object_far_m", &FrameLevers::objectFarM}}};
/// The chain of the levers; 0 is an occlusion resolution that is unset.
struct FlatChain {
  std::array<ChainCell, kChainColumns.size()> levers;
  ChainCell occlusionWidth, occlusionHeight;
};

template <class Chain, class Visit>
void forEachChainColumn(Chain& chain, const Visit& visit) {
  for (std::size_t i = 0; i < kChainColumns.size(); ++i)
    visit(kChainColumns[i].name, Cell::optional, chain.levers[i]);
  visit("chain_occlusion_width_px", Cell::optional, chain.occlusionWidth);
  visit("chain_occlusion_height_px", Cell::optional, chain.occlusionHeight);
}

inline FlatChain flattenChain(const LeverChain& chain) {
  FlatChain f;
  for (std::size_t s = 0; s < kLeverSteps; ++s) {
    const FrameLevers& levers = chain.after(static_cast<LeverStep>(s));
    for (std::size_t i = 0; i < kChainColumns.size(); ++i) {
      if (!f.levers[i]) f.levers[i].emplace();
      (*f.levers[i])[s] = levers.*kChainColumns[i].lever;
    }
    if (!f.occlusionWidth) f.occlusionWidth.emplace(), f.occlusionHeight.emplace();
    (*f.occlusionWidth)[s] = levers.occlusion ? levers.occlusion->widthPx : 0;
    (*f.occlusionHeight)[s] = levers.occlusion ? levers.occlusion->heightPx : 0;
  }
  return f;
}

inline void unflattenChain(const FlatChain& f, LeverChain& chain) {
  // Traces from before there was a chain have the LOD scale alone, as it was drawn.
  if (!f.levers[0]) chain.drawn.lodScale = chain.policy.lodScale;
  std::array<FrameLevers*, kLeverSteps> steps{&chain.preset, &chain.motion, &chain.weather, &chain.policy,
                                              &chain.drawn};
  for (std::size_t s = 0; s < kLeverSteps; ++s) {
    for (std::size_t i = 0; i < kChainColumns.size(); ++i)
      if (f.levers[i]) steps[s]->*kChainColumns[i].lever = (*f.levers[i])[s];
    if (f.occlusionWidth && f.occlusionHeight && (*f.occlusionWidth)[s] > 0)
      steps[s]->occlusion = OcclusionResolution{static_cast<int>((*f.occlusionWidth)[s]),
                                                static_cast<int>((*f.occlusionHeight)[s])};
  }
}

}  // namespace trimtab::trace
