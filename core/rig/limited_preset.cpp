#include "trimtab/rig/limited_preset.h"

#include <algorithm>

#include "trimtab/preset/policy_lines.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

class Limiter {
 public:
  Limiter(const IgProfile& profile, TuningParameters& preset, const std::string& where)
      : profile_(profile), preset_(preset), where_(where) {}

  void run() {
    limitPolicy();
    limitMotion();
    limitHold();
    if (!has(Lever::occlusion) && preset_.culling.cullingCase == CullingCase::proposed) {
      preset_.culling.cullingCase = CullingCase::view_frustum;
      note("culling.case", "view_frustum", "proposed");
    }
  }
  Findings notes;

 private:
  bool has(Lever lever) const { return follows(profile_, lever); }
  void note(std::string key, std::string now, std::string before) {
    notes.push_back({Severity::note, where_, std::move(key), std::move(now) + ", for " + profile_.name,
                     std::move(before)});
  }
  template <class Unit>
  void set(Unit& field, double value, const char* key) {
    if (field.value() == value) return;
    note(key, numberText(value), numberText(field.value()));
    field = Unit{value};
  }

  /// Returns what rules may ask of a lever, in the unit of its row in levers.h.
  Range rangeOf(Lever lever) const {
    const Range hard = rowOf(lever).hard;
    // A rule multiplies the weather's far distance and the blur: the IG's range holds for the product, where
    // ownValue() applies it.
    if (lever == Lever::far_distance || lever == Lever::blur_strength) return hard;
    const IgLever* own = profile_.find(rowOf(lever).key);
    Range ours;
    if (own != nullptr) {
      ours = own->ours();
    } else {
      ours = profile_.errorLever()->ours();
      const double neutral = profile_.errorLever()->neutral(), errorPx = preset_.lod.screenSpaceError.value();
      ours = {ours.low / neutral * errorPx, ours.high / neutral * errorPx};
    }
    return {std::clamp(ours.low, hard.low, hard.high), std::clamp(ours.high, hard.low, hard.high)};
  }

  void limitPolicy() {
    const Result<Policy> read = policyOf(preset_.policy);
    if (!read) return;
    Policy policy = *read;
    for (std::size_t i = 0; i < policy.rules.size(); ++i) {
      PolicyRule& rule = policy.rules[i];
      const std::string key = "policy.rules." + std::to_string(i + 1), before = ruleText(rule);
      std::erase_if(rule.settings, [&](const LeverSetting& s) { return !has(s.lever); });
      for (LeverSetting& s : rule.settings)
        s.value = std::clamp(s.value, rangeOf(s.lever).low, rangeOf(s.lever).high);
      if (rule.settings.empty())
        note(key, "no such rule", before);
      else if (ruleText(rule) != before)
        note(key, ruleText(rule), before);
    }
    std::erase_if(policy.rules, [](const PolicyRule& rule) { return rule.settings.empty(); });
    preset_.policy = policyLines(policy, preset_.policy);
  }

  void limitMotion() {
    MotionParameters& m = preset_.motion;
    if (m.control == MotionControl::off) return;
    if (!has(Lever::lod_scale)) set(m.lodMaximum, 1, "motion.lod_maximum");
    if (!has(Lever::blur_strength)) set(m.blurStrength, 0, "motion.blur_strength");
  }

  void limitHold() {
    constexpr Range kErrors = rowOf(Lever::screen_space_error).hard;
    HoldParameters& h = preset_.hold;
    if (!has(Lever::screen_space_error))
      set(h.errorMaximum, std::clamp(preset_.lod.screenSpaceError.value(), kErrors.low, kErrors.high),
          "hold.error_maximum_px");
    else
      set(h.errorMaximum, std::min(h.errorMaximum.value(), rangeOf(Lever::screen_space_error).high),
          "hold.error_maximum_px");
    const auto least = [&](Ratio& field, Lever lever, const char* key) {
      const IgLever* own = profile_.find(rowOf(lever).key);
      set(field, own == nullptr ? 1 : std::max(field.value(), std::min(own->ours().low, 1.0)), key);
    };
    least(h.renderScaleMinimum, Lever::render_scale, "hold.render_scale_minimum");
    least(h.particlesMinimum, Lever::particle_density, "hold.particles_minimum");
    least(h.blurMinimum, Lever::blur_strength, "hold.blur_minimum");
  }

  const IgProfile& profile_;
  TuningParameters& preset_;
  const std::string& where_;
};

}  // namespace

bool follows(const IgProfile& profile, Lever lever) {
  if (lever == Lever::screen_space_error) return profile.errorLever() != nullptr;
  return profile.find(rowOf(lever).key) != nullptr;
}

Result<TuningParameters> limitedTo(const IgProfile& profile, TuningParameters preset,
                                   const std::string& where) {
  Limiter limiter(profile, preset, where);
  limiter.run();
  return {std::move(preset), std::move(limiter.notes)};
}

}  // namespace trimtab
