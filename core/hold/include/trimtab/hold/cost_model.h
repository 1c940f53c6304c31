#pragma once

#include <array>
#include <deque>
#include <optional>

#include "trimtab/frame/frame.h"
#include "trimtab/frame/hold_decision.h"
#include "trimtab/hold/linear_cost.h"
#include "trimtab/units/result.h"

/// Predicts what an image costs on this machine, and learns it while flying.
namespace trimtab {

/// Holds what the time of an image follows from.
struct FrameLoad {
  double triangles = 0;  ///< of the ground, drawn
  double groundMpx = 0;  ///< millions of pixels of the scene that show ground
  double sceneMpx = 0;   ///< millions of pixels of the scene, at its render scale
  double particles = 0;  ///< amount of what falls times the share that is drawn; 0: nothing falls
  bool blurs = false;

  friend bool operator==(const FrameLoad&, const FrameLoad&) = default;
};

/// Standard deviations in the 90 % band of a normal distribution.
inline constexpr double kNormalBand = 1.645;

/// Holds what the work of one clock costs, milliseconds per unit of its quantity.
struct ClockCoefficients {
  double fixed = 0, perTriangle = 0, perGroundMpx = 0;
  double perParticles = 0, perWeatherMpx = 0;
  double perBlurMpx = 0;
  double other = 0;
};

/// The model as plain numbers; a prediction needs nothing else. The coefficients themselves are those of the
/// clock that takes longer for the load that they were asked for: processor or GPU.
struct CostCoefficients : ClockCoefficients {
  std::optional<ClockCoefficients> second;  ///< the other clock, if there are two
  double halfBandMs = 0;  ///< half the 90 % band of an image with the load that was asked for
  double offMs = 0;       ///< the median by which the last predictions were off, to either side
  bool known = false;     ///< enough images were measured to predict one
};

/// Returns the time of an image, by stage: that of the clock which takes longer for this load.
StageTimes predict(const CostCoefficients& cost, const FrameLoad& load);

/// Returns what a frame's work took: all of the processor's time, or the GPU's if that is longer.
double workMs(const FrameCost& cost);

/// Returns the work of an image by stage, as it was measured; NaN if it was not. Weather and blur that nobody
/// measured apart count as ground.
StageTimes stagesOf(const FrameCost& cost);

/// The work of one image on one clock, milliseconds.
struct ClockTimes {
  double work = 0;   ///< all of it
  double other = 0;  ///< of that, what belongs to no load
  double weather = 0, blur = 0;
  bool apart = true;  ///< weather was measured apart, if the image had any
};

/// Learns the coefficients of one clock from finished images.
class ClockModel {
 public:
  /// Learns from an image. What it ran and should have been measured apart, but was not, teaches nothing.
  /// Times outside cost_bounds are ignored. A model of which a number is not finite begins anew.
  void observe(const FrameLoad& load, const ClockTimes& times);
  ClockCoefficients coefficients() const;
  /// Returns the half width of the 90 % band for an image of this load, milliseconds.
  double halfBandMs(const FrameLoad& load) const;
  /// Returns the median by which the last predictions were off, milliseconds.
  double offMs() const;
  /// A prediction from fewer images would be little more than the first image's time.
  static constexpr double kFewestImages = 8;
  bool known() const { return ground_.state().images >= kFewestImages; }
  std::size_t images() const { return images_; }
  const std::optional<Finding>& whyAnew() const { return whyAnew_; }

  struct State {
    LinearCost<3>::State ground;
    LinearCost<2>::State weather;
    LinearCost<1>::State blur;
    double other = 0;
    double band = kNormalBand;  ///< standard deviations in the 90 % band

    /// Calls `visit(key, number, low, high)` for each number, in the order of the file. Units are
    /// milliseconds a unit of a quantity, triangles in ten thousands.
    template <class Self, class Visit>
    static void forEachNumber(Self& self, const std::string& prefix, const Visit& visit) {
      const auto under = [&](const char* name) {
        return [&visit, path = prefix + name + '.'](const std::string& key, auto& number, double low,
                                                    double high) { visit(path + key, number, low, high); };
      };
      LinearCost<3>::State::forEachNumber(self.ground, under("ground"));
      LinearCost<2>::State::forEachNumber(self.weather, under("weather"));
      LinearCost<1>::State::forEachNumber(self.blur, under("blur"));
      visit(prefix + "other", self.other, 0.0, cost_bounds::kLongestMs);
      visit(prefix + "band", self.band, kLeastBand, kMostBand);
    }
  };
  static constexpr double kLeastBand = 0.3, kMostBand = 10;
  State state() const;
  /// Restores a saved state, with some distrust (LinearCost::restore).
  void restore(const State& state);

 private:
  LinearCost<3> ground_;
  LinearCost<2> weather_;
  LinearCost<1> blur_;
  double other_ = 0, band_ = kNormalBand;
  std::deque<double> others_;  ///< the last times of what `other_` is the median of
  std::deque<double> off_;     ///< by how much the last predictions were off, milliseconds
  std::size_t images_ = 0;
  int farOff_ = 0;  ///< predictions in a row
  std::optional<Finding> whyAnew_;
};

/// Learns what images cost on this machine, the processor's time and the GPU's apart: an image takes as long
/// as the longer of both. A software rasteriser has no time of a GPU, and so a single clock.
///
/// The time of the GPU arrives with a later image, usually the next one (GpuTimer reads a ring of four). So
/// it is learned for the load of the image before, and only where the levers have rested since the oldest
/// image that it can belong to.
class CostModel {
 public:
  void observe(const FrameLoad& load, const FrameCost& cost);
  /// Tells that a lever moved in the last image, of which nothing is learned: it also made levels, or resized
  /// its target.
  void leversMoved() { loads_.clear(); }
  /// Returns the coefficients, with the band for an image of this load.
  CostCoefficients coefficients(const FrameLoad& load) const;
  /// Returns how many images it has learned from.
  std::size_t images() const { return processor_.images(); }
  /// Returns why a clock began anew for the first time; unset as long as none did.
  const std::optional<Finding>& whyAnew() const {
    return processor_.whyAnew() ? processor_.whyAnew() : gpu_.whyAnew();
  }

  struct State {
    ClockModel::State processor, gpu;

    template <class Self, class Visit>
    static void forEachNumber(Self& self, const Visit& visit) {
      ClockModel::State::forEachNumber(self.processor, "processor.", visit);
      ClockModel::State::forEachNumber(self.gpu, "gpu.", visit);
    }
  };
  State state() const { return {processor_.state(), gpu_.state()}; }
  void restore(const State& state) { processor_.restore(state.processor), gpu_.restore(state.gpu); }

 private:
  ClockModel processor_, gpu_;
  std::deque<FrameLoad> loads_;  ///< of the last images, since a lever moved
};

}  // namespace trimtab
