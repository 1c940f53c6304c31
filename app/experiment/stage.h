#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "experiment.h"
#include "trimtab/scene/offscreen.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/scene/weather_cut_error.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"

/// What all experiments stand on: a context, a renderer and places to look from.
namespace trimtab::experiment {

class Stage {
 public:
  static Result<std::unique_ptr<Stage>> open(const Setup& setup);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  FrameResult draw(const FrameRequest& request);
  /// Also forgets what was paged in.
  void setTerrain(std::shared_ptr<const terrain::Database> terrain);
  /// Median milliseconds of `repeats` frames after one that is not counted; `last` is the last frame's
  /// result.
  double medianMs(const FrameRequest& request, int repeats, FrameResult& last);
  std::vector<std::uint8_t> pixels(const FrameRequest& request);
  /// What the weather's far cut changes in the picture.
  scene::CutError cutError(const FrameRequest& request);
  /// Of the last frame drawn, RGBA.
  std::vector<std::uint8_t> shown();
  /// Processor, cores and what draws, in one line.
  std::string machine() const;

 private:
  Stage() = default;
  std::unique_ptr<scene::Offscreen> offscreen_;
  scene::Renderer renderer_;
  scene::GlReport gl_;
  int width_ = 0, height_ = 0;
};

/// A place and where the nose points; its height is the highest ground within 2 km.
struct Place {
  GeodeticPosition ground;
  Attitude attitude;
};

/// Along the flight at even times, or without one five places of the terrain times four headings, level.
std::vector<Place> placesOf(const Setup& setup, std::size_t count);

/// The pixels of two pictures that differ in any channel.
std::size_t differingPixels(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b);

double meanOf(const std::vector<double>& values);
/// Nearest rank; sorts.
double quantileOf(std::vector<double> values, double fraction);

/// The finding that says that no place of the flight lies over the terrain.
Finding notOverTerrain(const Setup& setup);
/// The finding that says a person asked to stop.
Finding cancelled();

}  // namespace trimtab::experiment
