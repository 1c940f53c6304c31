#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

/// Declares what the arbiter of the frame's budget decided for one image. core/hold decides it, and a session
/// puts it into the request.
namespace trimtab {

/// The levers that the arbiter may lower; withBudget() in frame_levers.h applies them. They have the units of
/// their rows in levers.h.
struct HeldLevers {
  double errorPx = 0;        ///< allowed screen-space error
  double renderScale = 1;    ///< part of the image's width and height
  double particleShare = 1;  ///< of the drops and flakes of the weather
  double blurShare = 1;      ///< of the strength of the blur that head motion asks for

  friend bool operator==(const HeldLevers&, const HeldLevers&) = default;
};

/// The work time of one image by stage, milliseconds, predicted or measured.
struct StageTimes {
  double ground = 0;  ///< selection, culling and drawing, without the stages below
  double weather = 0, blur = 0;
  double other = 0;  ///< decision, looking for hidden ground, symbols and paging

  double total() const { return ground + weather + blur + other; }
  friend bool operator==(const StageTimes&, const StageTimes&) = default;
};

/// Says why the levers are where they are.
enum class HoldReason : std::uint8_t {
  off,           ///< hold.enabled is off
  no_budget,     ///< measure.budget_ms is not a number above 0
  cost_unknown,  ///< too few images have been measured to predict one
  fits,          ///< what is asked for fits the budget
  lowered,       ///< lowered in this image, because the prediction did not fit
  held,          ///< lower than asked for, as in the image before
  restored,      ///< raised in this image, because head-room has lasted
  out_of_reach,  ///< as low as is of use within the limits, and the prediction still does not fit
  not_trusted    ///< as asked for, because the last predictions were too far off
};

inline constexpr std::size_t kHoldReasons = static_cast<std::size_t>(HoldReason::not_trusted) + 1;

struct HoldDecision {
  HoldReason reason = HoldReason::off;
  HeldLevers asked, held;      ///< by preset and policy; by the arbiter
  StageTimes askedMs, heldMs;  ///< predicted for both
  double limitMs = 0;          ///< what a prediction may reach
  double halfBandMs = 0;       ///< half the 90 % band of a prediction, at the levers of the image before

  friend bool operator==(const HoldDecision&, const HoldDecision&) = default;
};

/// Returns the name that traces, the command line and the workbench show, and an empty one for a value
/// outside the enumeration.
constexpr std::string_view toText(HoldReason reason) {
  constexpr std::array<std::string_view, kHoldReasons> kNames{"off",      "no_budget",    "cost_unknown",
                                                              "fits",     "lowered",      "held",
                                                              "restored", "out_of_reach", "not_trusted"};
  const auto at = static_cast<std::size_t>(reason);
  return at < kNames.size() ? kNames[at] : std::string_view{};
}

}  // namespace trimtab
