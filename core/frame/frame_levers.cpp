#include "trimtab/frame/frame_levers.h"

#include "trimtab/units/number.h"

namespace trimtab {
namespace {

/// Static trees and objects keep their share of the error, so that a lever which rests at the preset's value
/// changes nothing.
void setError(FrameLevers& levers, double errorPx) {
  if (errorPx == levers.errorPx) return;
  levers.treeErrorPx *= errorPx / levers.errorPx;
  levers.objectErrorPx *= errorPx / levers.errorPx;
  levers.errorPx = errorPx;
}

}  // namespace

FrameLevers presetLevers(const TuningParameters& preset, std::optional<OcclusionResolution> occlusion) {
  FrameLevers levers;
  levers.errorPx = preset.lod.screenSpaceError.value();
  levers.treeErrorPx = preset.staticLod.errorPx.value();
  levers.lodScale = preset.lod.scale.value();
  levers.levelSpread = preset.lod.spread.value();
  levers.objectErrorPx = preset.objects.errorPx.value();
  levers.smallFeaturePx = preset.objects.smallFeature.value();
  levers.objectFarM = preset.objects.farDistance.value();
  levers.occlusion = occlusion;
  return levers;
}

FrameLevers withMotion(FrameLevers levers, const MotionDecision& motion) {
  levers.lodScale *= motion.lodScale;
  levers.blurStrength = motion.blur.strength;
  return levers;
}

FrameLevers withWeather(FrameLevers levers, const WeatherDecision& weather) {
  levers.farM = weather.farM;
  return levers;
}

FrameLevers withPolicy(FrameLevers levers, const PolicyOutcome& policy, const MotionDecision& motion,
                       std::optional<OcclusionResolution> occlusion) {
  if (policy.moves(Lever::occlusion)) levers.occlusion = occlusion;
  if (policy.moves(Lever::screen_space_error)) setError(levers, policy[Lever::screen_space_error]);
  if (policy.moves(Lever::lod_scale)) levers.lodScale = policy[Lever::lod_scale] * motion.lodScale;
  if (policy.moves(Lever::far_distance)) levers.farM *= policy[Lever::far_distance];
  if (policy.moves(Lever::particle_density)) levers.particleShare = policy[Lever::particle_density];
  if (policy.moves(Lever::blur_strength)) levers.blurStrength *= policy[Lever::blur_strength];
  if (policy.moves(Lever::render_scale)) levers.renderScale = policy[Lever::render_scale];
  if (policy.moves(Lever::object_error)) levers.objectErrorPx = policy[Lever::object_error];
  if (policy.moves(Lever::small_feature)) levers.smallFeaturePx = policy[Lever::small_feature];
  if (policy.moves(Lever::object_distance)) levers.objectFarM = policy[Lever::object_distance];
  return levers;
}

FrameLevers withBudget(FrameLevers levers, const HeldLevers& held) {
  setError(levers, held.errorPx);
  levers.renderScale = held.renderScale;
  levers.particleShare = held.particleShare;
  levers.blurStrength *= held.blurShare;
  return levers;
}

double valueOf(const FrameLevers& levers, const FrameLeverRow& row) {
  if (row.value != nullptr) return levers.*row.value;
  return levers.occlusion ? levers.occlusion->widthPx : 0;
}

LeverStep lastChange(const LeverChain& chain, const FrameLeverRow& row) {
  for (std::size_t i = kLeverSteps; --i > 0;) {
    const auto step = static_cast<LeverStep>(i), before = static_cast<LeverStep>(i - 1);
    if (valueOf(chain.after(step), row) != valueOf(chain.after(before), row)) return step;
  }
  return LeverStep::preset;
}

std::string valueText(const FrameLevers& levers, const FrameLeverRow& row) {
  if (row.value == nullptr)
    return levers.occlusion ? std::to_string(levers.occlusion->widthPx) + " x " +
                                  std::to_string(levers.occlusion->heightPx) + " px"
                            : "none";
  const double value = levers.*row.value;
  if (value == WeatherDecision::kUnlimited) return "unlimited";
  std::string text = numberText(value, 3);
  if (!row.unit.empty()) text += ' ' + std::string(row.unit);
  return text;
}

std::string explain(const LeverChain& chain, const FrameLeverRow& row) {
  std::string text;
  for (std::size_t i = 0; i < kLeverSteps; ++i) {
    const auto step = static_cast<LeverStep>(i);
    const FrameLevers& now = chain.after(step);
    if (i > 0 && valueOf(now, row) == valueOf(chain.after(static_cast<LeverStep>(i - 1)), row)) continue;
    text += (i > 0 ? ", " : "") + std::string(toText(step)) + ' ' + valueText(now, row);
  }
  return text;
}

std::string_view toText(LeverStep step) {
  constexpr std::array<std::string_view, kLeverSteps> kNames{"preset", "head motion", "weather", "policy",
                                                             "budget"};
  const auto at = static_cast<std::size_t>(step);
  return at < kNames.size() ? kNames[at] : std::string_view{};
}

}  // namespace trimtab
