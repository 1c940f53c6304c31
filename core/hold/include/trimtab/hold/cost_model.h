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

/// What the time of an image follows from.
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

/// How uncertain the coefficients of a model are, in squares of their units. A covariance matrix is kept row
/// by row, each from its diagonal on.
struct CostVariance {
  std::array<double, 10> ground{};  ///< of fixed, perTriangle, perTriangleSide and perGroundMpx
  std::array<double, 3> weather{};  ///< of perParticles and perWeatherMpx
  double blur = 0;                  ///< of perBlurMpx

  friend bool operator==(const CostVariance&, const CostVariance&) = default;
};

/// The model as plain numbers, milliseconds a unit of its quantity. A prediction needs nothing else.
///
/// A triangle costs perTriangle at any render scale. A software rasteriser also pays for the length of its
/// edges in pixels: perTriangleSide times the side of the scene, which is the root of its millions of pixels.
struct CostCoefficients {
  double fixed = 0, perTriangle = 0, perTriangleSide = 0, perGroundMpx = 0;
  double perParticles = 0, perWeatherMpx = 0;
  double perBlurMpx = 0;
  double other = 0;
  double bandMs = 0;   ///< the 90 % band of the image that is about to be drawn, to either side
  bool known = false;  ///< enough images were measured to predict one
  CostVariance variance{};

  friend bool operator==(const CostCoefficients&, const CostCoefficients&) = default;
};

/// Returns the time of an image, by stage.
StageTimes predict(const CostCoefficients& cost, const FrameLoad& load);

/// Returns the part of an image's 90 % band that comes from uncertain coefficients, milliseconds. It is small
/// for loads like those that were drawn lately, and grows with what they never told apart.
double coefficientBandMs(const CostCoefficients& cost, const FrameLoad& load);

/// Returns how many times as long an image may take at most under another load, whatever the coefficients
/// are: none is negative, so it is the greatest ratio of a quantity; infinite if there was none of it before.
double mostTimesAsLong(const FrameLoad& before, const FrameLoad& after);

/// Returns what a frame's work took: all of the processor's time, or the GPU's if that is longer.
double workMs(const FrameCost& cost);

/// Returns the work of an image by stage, as it was measured; NaN if it was not. Weather and blur that nobody
/// measured apart count as ground.
StageTimes stagesOf(const FrameCost& cost);

/// Learns the coefficients of a machine from finished images.
class CostModel {
 public:
  /// Learns from an image. What it ran and nobody measured (FrameCost::kNotMeasured) teaches nothing. Times
  /// outside cost_bounds are ignored. A model that can predict nothing, because a number of it is not finite
  /// or because a hundred predictions in a row were more than twice too long or too short, begins anew.
  void observe(const FrameLoad& load, const FrameCost& cost);
  /// Returns the coefficients, with the band for an image of this load.
  CostCoefficients coefficients(const FrameLoad& load) const;
  /// Returns how many images it has learned from.
  std::size_t images() const { return images_; }
  /// Returns why it began anew for the first time; unset as long as it did not.
  const std::optional<Finding>& whyAnew() const { return whyAnew_; }

  struct State {
    LinearCost<4>::State ground;
    LinearCost<2>::State weather;
    LinearCost<1>::State blur;
    double other = 0;
    double band = 0;  ///< standard deviations in the 90 % band

    /// Calls `visit(key, number, low, high)` for each number, in the order of the file. Units are
    /// milliseconds a unit of a quantity, triangles in ten thousands.
    template <class Self, class Visit>
    static void forEachNumber(Self& self, const Visit& visit) {
      const auto under = [&visit](const char* name) {
        return [&visit, name](const std::string& key, auto& number, double low, double high) {
          visit(name + ('.' + key), number, low, high);
        };
      };
      LinearCost<4>::State::forEachNumber(self.ground, under("ground"));
      LinearCost<2>::State::forEachNumber(self.weather, under("weather"));
      LinearCost<1>::State::forEachNumber(self.blur, under("blur"));
      visit("other", self.other, 0.0, cost_bounds::kLongestMs);
      visit("band", self.band, kLeastBand, kMostBand);
    }
  };
  static constexpr double kLeastBand = 0.3, kMostBand = 10;
  State state() const;
  /// Takes a saved state, with some distrust (LinearCost::restore).
  void restore(const State& state);

 private:
  void noteOther(double ms);
  void noteFarOff(double predictedMs, double ms);
  void beginAnew(Finding why);

  LinearCost<4> ground_;
  LinearCost<2> weather_;
  LinearCost<1> blur_;
  static constexpr std::size_t kOthers = 9;

  double other_ = 0, band_ = kNormalBand;
  std::deque<double> others_;  ///< the last kOthers times of what `other_` is the median of
  std::size_t images_ = 0;
  int farOff_ = 0;  ///< predictions in a row
  std::optional<Finding> whyAnew_;
};

}  // namespace trimtab
