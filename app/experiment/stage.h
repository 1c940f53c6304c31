#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "experiment.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/scene/weather_cut_error.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"

/// Declares what all experiments share: a GL context, a renderer and places to look from.
namespace trimtab::experiment {

class Stage {
 public:
  static Result<std::unique_ptr<Stage>> open(const Setup& setup);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Draws an image that, like its counts, depends on the request alone: all that it needs is read and made
  /// at once.
  FrameResult draw(const FrameRequest& request);
  /// Draws the next image of a flight as an image generator does: surfaces are made over several images, and
  /// none waits for pages.
  FrameResult fly(const FrameRequest& request);
  /// Builds meshes for coming images, as Renderer::buildAhead does.
  scene::BuiltAhead buildAhead(std::span<const std::uint32_t> nodes, double withinMs);
  /// Replaces the terrain and discards pages of the former one.
  void setTerrain(std::shared_ptr<const terrain::Database> terrain);
  /// Returns the median milliseconds of `repeats` frames, after one frame that is not counted. `last`
  /// receives the result of the last frame.
  double medianMs(const FrameRequest& request, int repeats, FrameResult& last);
  std::vector<std::uint8_t> pixels(const FrameRequest& request);
  /// Returns what the far cut of the weather changes in the image.
  scene::CutError cutError(const FrameRequest& request);
  /// Returns the RGBA pixels of the last frame drawn.
  std::vector<std::uint8_t> shown();
  /// Returns the distances of the last frame drawn (Renderer::readDistances).
  std::vector<float> distances();
  /// Returns processor, cores and renderer in one line.
  std::string machine() const;

 private:
  Stage() = default;
  FrameResult drawAndWait(FrameRequest request);
  std::unique_ptr<scene::Offscreen> offscreen_;
  scene::Renderer renderer_;
  scene::GlReport gl_;
  int width_ = 0, height_ = 0;
};

/// The budget that the arbiter holds in experiments, as a part of the median image without it.
inline constexpr double kHeldPart = 0.6;

/// A place and the attitude of the aircraft; its height is the highest ground within 2 km.
struct Place {
  GeodeticPosition ground;
  Attitude attitude;
};

/// Returns places along the flight at even times. Without a flight: five places of the terrain with four
/// level headings each.
std::vector<Place> placesOf(const Setup& setup, std::size_t count);

/// Images that a blur can reach back over at 60 images a second.
inline constexpr std::size_t kLongestTrace = 64;
inline bool blurs(const FrameRequest& request) {
  return request.levers.drawn.blurStrength > 0;
}

/// Returns how many pixels of two images differ in any channel.
std::size_t differingPixels(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b);

double meanOf(const std::vector<double>& values);
using trimtab::quantileOf;

/// Returns the finding that no place of the flight is above the terrain.
Finding notOverTerrain(const Setup& setup);
/// Returns the finding that the user cancelled.
Finding cancelled();

}  // namespace trimtab::experiment
