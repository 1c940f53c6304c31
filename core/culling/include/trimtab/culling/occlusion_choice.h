#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "trimtab/preset/parameters.h"
#include "trimtab/units/linear.h"

namespace trimtab {

/// Which method looks for hidden ground, by what each has cost and saved so far on this machine, or none
/// where none pays. Whatever is chosen, the picture is the same.
///
/// A method is worth what the triangles that it hides would cost to draw, less its own time. What a triangle
/// costs is learnt from how the time to draw follows their number. The method in use is judged by every
/// frame; the others, and none, by a few frames now and then: sooner where eye, view or rule have changed, at
/// once where a band, a while without any of them or a leap of the eye makes what is known of little worth,
/// and never for more than kExploring of all time, so that in the long run a frame costs at most so much more
/// than with the best of them.
class OcclusionChoice {
 public:
  static constexpr double kExploring = 0.01;  ///< share of all time that may be lost to trying methods
  // Having been found worth less than another one is believed at most so long; found again and again, up to
  // kMostPatience times as long.
  static constexpr double kBelievedMs = 1000, kBelievedM = 50, kBelievedTurn = 0.1;  ///< the last: radians
  static constexpr double kMostPatience = 4;
  /// And what could not win so much as its own cost, as far as is known: so many times as long again,
  /// whatever the rule.
  static constexpr double kHopelessPatience = 8;
  /// An eye that goes further in one frame than that could reach has leapt.
  static constexpr double kLeapM = kHopelessPatience * kBelievedM;

  using Method = std::optional<OcclusionMethod>;  ///< none: nothing looks

  struct Situation {
    double timeMs = 0;                         ///< of a clock that never goes back
    Vec3 eye, forward;                         ///< place and direction of view, in one frame
    std::uint64_t rule = 0;                    ///< another one where parameters or levels differ
    std::span<const OcclusionMethod> methods;  ///< that can serve; what is likely to be best first
    std::uint64_t band = 0;                    ///< another one where the methods themselves differ
  };
  /// For the frame that comes.
  Method choose(const Situation& situation);

  struct Outcome {
    double occlusionMs = 0;  ///< what looking took; 0 where nothing looked
    double drawMs = 0;       ///< all of the frame that grows with what is drawn
    double totalMs = 0;
    std::uint64_t drawn = 0, hidden = 0;  ///< triangles in view
  };
  /// What that frame came to. Numbers that are not finite are not learnt from.
  void learn(const Outcome& outcome);

  /// Nothing is chosen in the frame that comes: what serves in the next one starts anew.
  void pause() { before_ = kArms; }

  /// Milliseconds a triangle, as far as it is known.
  double msPerTriangle() const;
  /// Milliseconds a frame that a method is thought to be worth; 0 for none, and for what was never tried.
  double worthMs(Method method) const;
  std::uint64_t trials() const { return trials_; }  ///< frames that were drawn to learn

 private:
  static constexpr std::size_t kArms = 5;  ///< none, and the methods but `automatic`
  struct Arm {
    bool known = false;
    int frames = 0;  ///< of its first trial in a chapter
    std::uint64_t chapter = 0;
    double costMs = 0;   ///< a frame in a row
    double firstMs = 0;  ///< the first frame of a row
    double share = 0;    ///< of the triangles in view that it hides
    Situation last;      ///< when it was in use
    double purseMs = 0;  ///< what may be lost to trying it
    double patience = 1;
    bool canServe = false;
  };
  static std::size_t armOf(Method method);
  static Method methodOf(std::size_t arm);
  double worth(std::size_t arm) const;
  double startMs(std::size_t arm) const;
  bool isHopeless(std::size_t arm) const;
  /// Whether it was never tried, or not since what it is worth may have changed for good.
  bool isNew(std::size_t arm) const { return !arms_[arm].known || arms_[arm].chapter != chapter_; }
  bool isDue(std::size_t arm, const Situation& now) const;
  double lossOfTrying(std::size_t arm) const;
  std::size_t best(std::span<const std::size_t> arms) const;
  void learnTriangleCost(const Outcome& outcome);
  void learnArm(const Outcome& outcome);

  std::array<Arm, kArms> arms_;
  std::size_t current_ = 0;          ///< what serves but for trials
  std::size_t served_ = 0;           ///< in the frame in hand
  std::size_t before_ = kArms;       ///< in the frame before it
  int trialLeft_ = 0;                ///< frames
  double frameMs_ = 0, inView_ = 0;  ///< of late: a frame's time and triangles
  // How the time to draw follows the triangles: sums over pairs of frames, the older the less.
  double squares_ = 0, products_ = 0;
  double guessMs_ = 0, mostMs_ = 0;  ///< a triangle, before anything is known, and at most
  std::optional<Outcome> previous_;
  std::uint64_t trials_ = 0;
  Situation now_;
  std::uint64_t chapter_ = 0;  ///< ends with a band, a leap, or so long without a choice as is believed
};

}  // namespace trimtab
