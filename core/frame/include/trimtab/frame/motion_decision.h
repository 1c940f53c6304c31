#pragma once

#include <cstdint>

namespace trimtab {

/// What the optimizer of document C did with a frame. Only the names after `fast` change anything.
enum class MotionReason {
  off,
  first_frame,    ///< nothing to compare with yet
  invalid_input,  ///< time or line of sight is not a finite number: passed over, memory as it was
  same_time,      ///< no time has gone by: passed over; a change counts in the next step
  slow,           ///< at most Eq. (1)'s share of the field of view
  fast,           ///< more than that
  time_back,      ///< the host's clock went back: full detail, no blur, empty stacks
  gap,            ///< too long a step to know the motion in it: empty stacks
  lowered,        ///< BlurStack fired: one level coarser, blur started
  lowest,         ///< BlurStack fired at the coarsest level: blur started
  raised,         ///< LODRestoreStack fired: one level finer, blur stopped
  blur_stopped,   ///< LODRestoreStack fired at full detail: blur stopped
  blur_ended      ///< the blur's time ran out
};

/// Frames of one kind in a row, with their time and the angle they turned through.
struct MotionStack {
  std::uint32_t frames = 0;
  double ms = 0;
  double variationDeg = 0;

  friend bool operator==(const MotionStack&, const MotionStack&) = default;
};

struct MotionBlur {
  /// Share of the picture before that is left in it after 1/60 s, 0 (no blur, no pass) to 1; after t seconds
  /// strength^(60 t), so that a trail has the same length at any frame rate.
  double strength = 0;
  double remainingMs = 0;  ///< on the clock of the states; 0 when there is none

  friend bool operator==(const MotionBlur&, const MotionBlur&) = default;
};

/// Document C's optimizer after one state. Stacks are as they are left: empty in the frame they fired in.
struct MotionDecision {
  MotionReason reason = MotionReason::off;
  bool fast = false;
  double rateDegPerS = 0;       ///< of the line of sight, the larger of heading and pitch
  double thresholdDegPerS = 0;  ///< Eq. (1): one such field of view a second
  MotionStack blurStack, restoreStack;
  /// At `blurLimit` BlurStack fires, above `restoreLimit` LODRestoreStack does; frames or, where
  /// `limitsInMs`, milliseconds.
  double blurLimit = 0, restoreLimit = 0;
  bool limitsInMs = false;
  std::uint32_t level = 0;  ///< steps away from full detail
  double lodScale = 1;      ///< by motion alone; FrameDecision::lodScale holds it times the preset's
  MotionBlur blur;

  friend bool operator==(const MotionDecision&, const MotionDecision&) = default;
};

/// What the optimizer remembers between states.
struct MotionMemory {
  bool known = false;  ///< whether the three below are of a state
  double timeS = 0, headingDeg = 0, pitchDeg = 0;
  MotionStack blurStack, restoreStack;
  std::uint32_t level = 0;
  double blurRemainingMs = 0;

  friend bool operator==(const MotionMemory&, const MotionMemory&) = default;
};

}  // namespace trimtab
