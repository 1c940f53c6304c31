#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/linear.h"
#include "trimtab/units/not_finite.h"

namespace trimtab {

/// Chooses which method looks for hidden ground, or none, from what each has cost and saved on this machine
/// so far. The choice never changes the image, only what it costs. resources/docs/occlusion.md derives the
/// rule.
///
/// A method is worth the time that drawing its hidden triangles would take, less its own time. The time per
/// triangle is learnt from how the time to draw changes with the number of triangles. Every frame measures
/// the method in use. The others are tried for a frame or two when they are due, and only while their
/// exploration budget covers the expected loss, so that in the long run a frame costs at most kExploring more
/// than with the best method. Not thread-safe.
class OcclusionChoice {
 public:
  /// Share of all frame time that trials may lose. A flight whose every frame asks for trials loses no more.
  static constexpr double kExploring = 0.01;
  /// A loss that does not fit the room of its frame (Situation::roomMs) counts so many times. In the long run
  /// frames that fill their budget then have a trial less than once in a hundred, where 1 % may be late.
  static constexpr double kBeyondRoom = 10;
  /// A method that was found to be worth less than another is due again after this time of drawing (ms), this
  /// way of the eye (m) or this turn of the view (radians). An eye that flies, turns or rests can each
  /// uncover ground for which another method is better.
  static constexpr double kBelievedMs = 1000, kBelievedM = 50, kBelievedTurn = 0.1;
  /// The three limits above double with every trial that finds the same, up to this factor, until the rule
  /// changes. It multiplies them again for a method that costs more than it could save. Without the factor
  /// trials took twice the frames.
  static constexpr double kMostPatience = 6;
  /// An eye that moves further than this (m) in one frame was put elsewhere: everything is tried again.
  static constexpr double kLeapM = kMostPatience * kBelievedM;

  using Method = std::optional<OcclusionMethod>;  ///< unset: nothing looks for hidden ground

  struct Situation {
    double timeMs = 0;       ///< spent on drawing so far
    Vec3 eye, forward;       ///< position and view direction, both in one frame of reference
    std::uint64_t rule = 0;  ///< a new number when parameters or the terrain change
    std::span<const OcclusionMethod> methods;  ///< those that can be used; read during the call only
    std::uint64_t band = 0;                    ///< a new number when the resolution of the methods changes
    double roomMs = kInfinity;                 ///< what the next frame may take longer than without a trial
  };
  /// Returns the method for the next frame.
  Method choose(const Situation& situation);

  struct Outcome {
    double occlusionMs = 0;  ///< time spent looking for hidden ground; 0 if nothing looked
    double drawMs = 0;       ///< all time of the frame that grows with what is drawn
    double totalMs = 0;
    std::uint64_t drawn = 0, hidden = 0;  ///< triangles in view
  };
  /// Reports what the frame after the last `choose` cost. Ignores an outcome with a time that is not finite.
  void learn(const Outcome& outcome);

  /// Reports that the next frame is drawn without a choice. The frame after it counts as a method's start.
  void pause() { before_ = kArms; }

  /// Returns the estimated milliseconds per triangle; 0 if the last frame had none in view.
  double msPerTriangle() const;
  /// Returns the number of frames so far that were drawn to try a method.
  std::uint64_t trials() const { return trials_; }

 private:
  static constexpr std::size_t kArms = 3;  ///< arm 0 is none; the others are the methods but `automatic`
  /// What is known of a method.
  struct Arm {
    bool known = false, canServe = false;
    int frames = 0;             ///< of its trial in this chapter; counts to 2
    std::uint64_t chapter = 0;  ///< in which it was last used
    double costMs = 0;          ///< per frame while it goes on
    double firstMs = 0;         ///< for the frame that starts it
    double share = 0;           ///< of the triangles in view that it hides
    Situation last;             ///< in which it was last used
    double budgetMs = 0;        ///< what trials of it may lose
    double patience = 1;
  };
  static std::size_t armOf(Method method);
  static Method methodOf(std::size_t arm);
  double worth(std::size_t arm) const;
  double startMs(std::size_t arm) const;
  /// Returns true if the arm would be no better than the current one even if it hid a good part of the rest.
  bool isHopeless(std::size_t arm) const;
  /// Returns true if the arm was not used in this chapter.
  bool isNew(std::size_t arm) const { return !arms_[arm].known || arms_[arm].chapter != chapter_; }
  bool isDue(std::size_t arm, const Situation& now) const;
  double lossOfTrying(std::size_t arm) const;
  /// Returns what a loss in the next frame takes from the budget of a trial.
  double price(double lossMs) const { return lossMs > now_.roomMs ? kBeyondRoom * lossMs : lossMs; }
  std::size_t best() const;
  void learnTriangleCost(const Outcome& outcome);
  void learnArm(const Outcome& outcome);

  std::array<Arm, kArms> arms_;
  std::size_t current_ = 0;          ///< in use except for trials
  std::size_t served_ = 0;           ///< in the frame being drawn
  std::size_t before_ = kArms;       ///< in the frame before it; kArms: none was chosen
  int trialLeft_ = 0;                ///< frames that the trial in progress goes on for
  double frameMs_ = 0, inView_ = 0;  ///< recent mean of a frame's time; triangles in view in the last frame
  double squares_ = 0,
         products_ = 0;              ///< decaying sums over pairs of frames: the slope of time over triangles
  double guessMs_ = 0, mostMs_ = 0;  ///< per triangle: the first guess, and the upper limit
  std::optional<Outcome> previous_;
  std::uint64_t trials_ = 0;
  Situation now_;
  /// Ends when the band changes, the eye leaps, or nothing was chosen for kBelievedMs. Everything is new in
  /// the next one.
  std::uint64_t chapter_ = 0;
};

}  // namespace trimtab
