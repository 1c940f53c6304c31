#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/experiment/stage.h"
#include "error_kind.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/hold/cost_model.h"
#include "trimtab/units/result.h"

/// Draws a few images of a flight, from which the others are estimated.
namespace trimtab::tune {

/// The levers whose loss is drawn, each alone.
enum class Loss : std::uint8_t {
  ground_error,
  object_error,
  small_feature,
  object_distance,
  render_scale,
  far_distance,
  particles,
  blur,
  level_spread
};
inline constexpr std::size_t kLosses = static_cast<std::size_t>(Loss::level_spread) + 1;
inline constexpr std::size_t kLossSteps = 6;

/// The values at which a lever's loss is drawn, from the finest on; the last fill up the row. Errors and
/// sizes are pixels, distances metres or a part of what the weather leaves, the others parts. Spreads ascend.
inline constexpr std::array<std::array<double, kLossSteps>, kLosses> kLossValues{{
    {1, 2, 4, 8, 16, 32},
    {1, 2, 4, 8, 16, 32},
    {1, 2, 4, 8, 16, 16},
    {40000, 20000, 10000, 5000, 2500, 2500},
    {0.85, 0.7, 0.6, 0.5, 0.5, 0.5},
    {1, 0.7, 0.5, 0.25, 0.25, 0.25},
    {0.75, 0.5, 0.25, 0, 0, 0},
    {0.5, 0.8, 0.95, 0.95, 0.95, 0.95},
    {0.25, 0.5, 1, 4.0 / 3, 2, 4},
}};
/// Spreads are drawn at this allowed error of ground and objects, where levels of many errors are in view;
/// this step of them leaves the distances.
inline constexpr double kSpreadPx = 4;
inline constexpr std::size_t kNoSpread = 2;

/// So many settings move several levers at once: their errors show by how much estimates miss that are made
/// from levers moved alone.
inline constexpr std::size_t kTogether = 3;
/// Returns an image at one of these settings.
FrameRequest together(FrameRequest request, std::size_t setting);

/// What one row of a flight showed.
struct DrawnRow {
  std::size_t row = 0;  ///< of the flight
  /// Triangles drawn over triangles counted, while hidden ground is looked for and while it is not.
  double drawnHidden = 1, drawnOpen = 1;
  double atRest = 0;  ///< error of the image with every lever at rest
  /// Errors of the images with one lever moved; 0 where it moves nothing.
  std::array<std::array<double, kLossSteps>, kLosses> error{};
  std::array<double, kTogether> together{};  ///< errors of images with several levers moved
  /// The part of the triangles that a value leaves: of objects for small_feature and object_distance, of all
  /// for far_distance.
  std::array<double, kLossSteps> smallKept{}, objectsKept{}, airKept{};
  double instances = 0;  ///< of objects in the image, all levers at rest
  /// The part of them that the values of small_feature and of object_distance leave.
  std::array<double, kLossSteps> smallInstances{}, farInstances{};
};

/// One image that was timed.
struct TimedImage {
  std::size_t row = 0;  ///< of the flight
  FrameLoad load;
  double instances = 0;  ///< of objects
  bool looksForHidden = false;
  double ms = 0;                  ///< the quickest of its repeats: other programs only add to it
  std::vector<double> repeatsMs;  ///< all of them, which say how far times of one image lie apart
};

struct DrawnSamples {
  std::vector<DrawnRow> rows;  ///< ascending
  std::vector<TimedImage> images;
};

/// A row to draw: the image that the start asks for, the one before it, and what an index counts of it.
struct SampleRow {
  std::size_t row = 0;
  double turnDegps = 0;  ///< of the view since the row before
  FrameRequest request;
  std::optional<FrameRequest> before;
  /// The images before that one which a blur reaches back to, oldest first, if blur is drawn in this row.
  std::optional<std::vector<FrameRequest>> trail;
  double groundMpx = 0;
  /// Returns the triangles counted at an allowed error of the ground and of objects, pixels, LOD scale 1.
  std::function<double(double groundPx, double objectPx)> counted;
};

/// Returns how long a blur of this strength reaches back, seconds: until a sixty-fourth is left of an image,
/// which is four grey levels at most.
double blurReachS(double strength);

/// Draws the rows. Times are of whole images; losses are drawn at ErrorKindRow::size, with the levels of the
/// whole image. `goOn` is called between images; returning false stops, and nothing is returned.
std::optional<DrawnSamples> drawSamples(experiment::Stage& stage, std::span<const SampleRow> rows,
                                        ErrorKind kind, const std::function<bool(double fraction)>& goOn);

/// Returns the samples as JSON, whose numbers read back bit for bit; and the inverse.
std::string toJson(const DrawnSamples& samples);
Result<DrawnSamples> parseSamples(std::string_view json, const std::string& where);

}  // namespace trimtab::tune
