#pragma once

#include <cstdint>
#include <optional>

#include "trimtab/units/geodesy.h"

namespace trimtab {

/// Says what the optimizer did with a state. After `fast`, level, blur or both stacks changed.
enum class MotionReason {
  off,
  first_frame,    ///< nothing to compare with yet
  invalid_input,  ///< time or line of sight is not a finite number: the state is ignored
  same_time,      ///< no time has passed: the state is ignored, and a change counts in the next step
  slow,           ///< the change is at most the threshold of Eq. (1)
  fast,           ///< the change exceeds it
  time_back,      ///< the host's clock went back: full detail, no blur, empty stacks
  gap,            ///< the step is too long to know the motion in it: empty stacks
  lowered,        ///< BlurStack fired: one level coarser, blur started
  lowest,         ///< BlurStack fired at the coarsest level: blur started
  kept,           ///< BlurStack fired, but the load asks for no coarser level: blur started
  raised,         ///< LODRestoreStack fired: one level finer, blur stopped
  blur_stopped,   ///< LODRestoreStack fired at full detail: blur stopped
  blur_ended      ///< the blur's time ran out
};

/// The eye of an image between two states, or of a state itself.
struct DrawnEye {
  double timeS = 0;  ///< on the clock of the states
  GeodeticPosition position;
  Attitude attitude;             ///< of the aircraft
  std::optional<Attitude> head;  ///< relative to the aircraft

  friend bool operator==(const DrawnEye&, const DrawnEye&) = default;
};

/// Holds what document C's optimizer receives beside the state (section 3.2: "information about vertices and
/// FPS"). A part that is unset is unknown.
struct DrawnLoad {
  std::optional<double> framesPerS;       ///< average of recent images
  std::optional<std::uint64_t> vertices;  ///< in view in the last image
  /// The image that is decided, whose turn counts instead of the state's; if unset, the state is the image.
  std::optional<DrawnEye> eye;

  friend bool operator==(const DrawnLoad&, const DrawnLoad&) = default;
};

/// Counts frames of one kind in a row, with their time and the angle that they turned through.
struct MotionStack {
  std::uint32_t frames = 0;
  double ms = 0;
  double variationDeg = 0;

  friend bool operator==(const MotionStack&, const MotionStack&) = default;
};

struct MotionBlur {
  /// The share of the previous image that is left after 1/60 s, 0 (no blur, no pass) to 1. After t seconds it
  /// is strength^(60 t), so that a trail has the same length at any frame rate.
  double strength = 0;
  double remainingMs = 0;  ///< on the clock of the states; 0 without blur

  friend bool operator==(const MotionBlur&, const MotionBlur&) = default;
};

/// Holds what document C's optimizer decided for one state. Stacks are as the state leaves them: empty after
/// they fired.
struct MotionDecision {
  MotionReason reason = MotionReason::off;
  bool fast = false;
  double rateDegPerS = 0;       ///< of the line of sight: the larger of the rates of heading and pitch
  double thresholdDegPerS = 0;  ///< Eq. (1): one field of view per second
  MotionStack blurStack, restoreStack;
  /// BlurStack fires at `blurLimit`, LODRestoreStack above `restoreLimit`; in frames, or in milliseconds if
  /// `limitsInMs`.
  double blurLimit = 0, restoreLimit = 0;
  bool limitsInMs = false;
  std::uint32_t level = 0;  ///< steps from full detail
  double lodScale = 1;      ///< of head motion alone; FrameLevers::lodScale is this times the preset's or the policy's
  MotionBlur blur;

  friend bool operator==(const MotionDecision&, const MotionDecision&) = default;
};

/// Holds what the optimizer remembers between states.
struct MotionMemory {
  bool known = false;  ///< whether the next three hold a state's values
  double timeS = 0, headingDeg = 0, pitchDeg = 0;
  MotionStack blurStack, restoreStack;
  std::uint32_t level = 0;
  double blurRemainingMs = 0;
  double blurShare = 1;  ///< of MotionParameters::blurStrength; of the run that started or renewed the blur

  friend bool operator==(const MotionMemory&, const MotionMemory&) = default;
};

}  // namespace trimtab
