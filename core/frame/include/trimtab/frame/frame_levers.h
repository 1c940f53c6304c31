#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/hold_decision.h"
#include "trimtab/preset/parameters.h"

/// The chain from a preset to the pixels: what may change how coarsely an image is drawn, who changes it, and
/// in which order. Each step is one function below. It is given the levers and returns them, and its reason
/// stands in the decision that it is given. The chain is kept with the request, in the trace and in the
/// workbench. The renderer reads its last link, and nothing after it sets or scales a lever.
namespace trimtab {

/// The levers of one image.
struct FrameLevers {
  double errorPx = 2;      ///< allowed screen-space error of tiles and patches, pixels of the image
  double treeErrorPx = 1;  ///< that of static trees; whoever changes one changes both by the same factor
  double lodScale = 1;     ///< multiplies both; 1 is full detail, larger is coarser
  double levelSpread = 1;  ///< how far apart the distances lie at which levels are exchanged (LodParameters)
  double farM = WeatherDecision::kUnlimited;  ///< nothing farther from the eye is drawn, metres
  double renderScale = 1;    ///< the part of the image's width and height at which the scene is drawn
  double particleShare = 1;  ///< the share of the drops and flakes of the weather that is drawn
  double blurStrength = 0;   ///< as MotionBlur::strength; 0 runs no pass
  std::optional<OcclusionResolution> occlusion;  ///< if unset, no occlusion test of any kind

  friend bool operator==(const FrameLevers&, const FrameLevers&) = default;
};

/// The steps, in their order.
enum class LeverStep : std::uint8_t { preset, motion, weather, policy, budget };
inline constexpr std::size_t kLeverSteps = static_cast<std::size_t>(LeverStep::budget) + 1;

/// The levers after each step.
struct LeverChain {
  FrameLevers preset, motion, weather, policy;
  FrameLevers drawn;  ///< after the budget, or as the policy leaves them if no budget is held

  const FrameLevers& after(LeverStep step) const {
    const std::array steps{&preset, &motion, &weather, &policy, &drawn};
    return *steps[static_cast<std::size_t>(step)];
  }
  friend bool operator==(const LeverChain&, const LeverChain&) = default;
};

/// 1. What the preset asks for, with the occlusion resolution of its memberships (documents A and B).
FrameLevers presetLevers(const TuningParameters& preset, std::optional<OcclusionResolution> occlusion);
/// 2. Head motion multiplies the LOD scale and brings the blur (document C).
FrameLevers withMotion(FrameLevers levers, const MotionDecision& motion);
/// 3. The weather sets the far distance (document D).
FrameLevers withWeather(FrameLevers levers, const WeatherDecision& weather);
/// 4. The rules of a policy replace the preset's allowed error and LOD scale, which head motion still
/// multiplies; they choose another occlusion resolution by its total, which `occlusion` is the outcome of, and
/// multiply the far distance, the blur, the particles and the render scale.
FrameLevers withPolicy(FrameLevers levers, const PolicyOutcome& policy, const MotionDecision& motion,
                       std::optional<OcclusionResolution> occlusion);
/// 5. The budget raises the allowed error and lowers render scale, particles and blur until the image's
/// predicted time fits.
FrameLevers withBudget(FrameLevers levers, const HeldLevers& held);

/// One row a lever: its names, and where a chain has it.
struct FrameLeverRow {
  std::string_view key;    ///< as files and traces spell it
  std::string_view label;  ///< as people read it
  std::string_view unit;
  double FrameLevers::* value;  ///< null for the occlusion resolution, whose value is its width
};

/// Every lever except that of static trees, which follows the allowed error.
inline constexpr std::array<FrameLeverRow, 8> kFrameLeverRows{{
    {rowOf(Lever::screen_space_error).key, rowOf(Lever::screen_space_error).label, "px",
     &FrameLevers::errorPx},
    {rowOf(Lever::lod_scale).key, rowOf(Lever::lod_scale).label, "", &FrameLevers::lodScale},
    {"level_spread", "Distance between levels", "", &FrameLevers::levelSpread},
    {rowOf(Lever::far_distance).key, rowOf(Lever::far_distance).label, "m", &FrameLevers::farM},
    {rowOf(Lever::render_scale).key, rowOf(Lever::render_scale).label, "", &FrameLevers::renderScale},
    {rowOf(Lever::particle_density).key, rowOf(Lever::particle_density).label, "",
     &FrameLevers::particleShare},
    {rowOf(Lever::blur_strength).key, rowOf(Lever::blur_strength).label, "", &FrameLevers::blurStrength},
    {rowOf(Lever::occlusion).key, rowOf(Lever::occlusion).label, "px", nullptr},
}};

/// Returns the lever's value; 0 for an occlusion resolution that is unset.
double valueOf(const FrameLevers& levers, const FrameLeverRow& row);
/// Returns which step changed the lever last: the preset if none did.
LeverStep lastChange(const LeverChain& chain, const FrameLeverRow& row);

/// Returns who set the lever and who changed it to what, in order: "preset 2 px, policy 4 px, budget 5.66 px".
std::string explain(const LeverChain& chain, const FrameLeverRow& row);
/// Returns a value with its unit: "4 px", "400 x 300 px", "none".
std::string valueText(const FrameLevers& levers, const FrameLeverRow& row);

/// Returns the name of a step, as traces, docks and reports show it.
std::string_view toText(LeverStep step);

}  // namespace trimtab
