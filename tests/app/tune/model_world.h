#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "app/harness/flown_frames.h"
#include "app/tune/flight_model.h"
#include "tests/app/ig_support.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab::tune {

/// Patches have levels of many errors.
inline std::shared_ptr<const terrain::Database> smallLand() {
  static const std::shared_ptr<const terrain::Database> land =
      terrain::Database::open(test::smallTerrain()).value();
  return land;
}

inline ValidatedParameters patches(const std::function<void(TuningParameters&)>& edit) {
  return test::edited([&](TuningParameters& parameters) {
    parameters.terrain.form = TerrainForm::patches;
    edit(parameters);
  });
}

/// A model of a flight over a terrain with samples that are drawn, and what drawing its presets
/// gives.
struct ModelWorld {
  static constexpr int kWidth = 480, kHeight = 288;
  static constexpr std::size_t kRows = 6;

  explicit ModelWorld(Flight flown, const ValidatedParameters& start = patches([](TuningParameters&) {}),
                      ErrorKind errors = ErrorKind::flip,
                      std::shared_ptr<const terrain::Database> ground = smallLand())
      : kind(errors), land(std::move(ground)), flight(std::move(flown)) {
    experiment::Setup setup;
    setup.terrain = land;
    setup.widthPx = kWidth;
    setup.heightPx = kHeight;
    stage = std::move(experiment::Stage::open(setup)).value();
    model =
        std::make_unique<FlightModel>(FlightModel::Scene{land, kWidth, kHeight}, flight, start, kRows, kind);
    samples = *drawSamples(*stage, model->toDraw(), kind, [](double) { return true; });
    // Images of so small a size take next to nothing, and that with noise: what they cost is planted.
    for (TimedImage& image : samples.images) {
      image.ms = plantedMs(image.load.triangles, image.load.groundMpx, image.looksForHidden) +
                 (image.load.blurs ? kBlurMsPerMpx * image.load.sceneMpx : 0);
      image.repeatsMs = {image.ms};
    }
    model->learn(samples);
  }
  static constexpr double kBlurMsPerMpx = 4;
  static double plantedMs(double triangles, double groundMpx, bool looks) {
    return 0.5 + 2e-4 * triangles + groundMpx + (looks ? 0.2 : 0);
  }

  struct Drawn {
    double error = 0;      ///< the statistic of the kind
    double triangles = 0;  ///< mean
  };
  /// Draws a preset with the meter of `bench`, in rows that are spread over the flight.
  Drawn draw(const ValidatedParameters& preset, std::size_t count = kRows) {
    scene::ErrorMeter meter;
    EXPECT_TRUE(meter.initialize().usable);
    meter.setTerrain(land);
    const harness::Flying flying{land, kWidth, kHeight, false, 1, {}};
    const auto frames =
        *harness::flyFrames(*stage, flying, flight, preset, harness::sampledRows(flight, *land, count));
    Drawn drawn;
    std::vector<double> errors;
    for (const harness::FlownFrame& frame : frames) {
      const auto& image = frame.images[0];
      const FrameError error = meter.measure(image.request, image.before, nullptr);
      errors.push_back(error.*rowOf(kind).ofImage);
      drawn.triangles += static_cast<double>(stage->draw(image.request).visible.triangles) /
                         static_cast<double>(frames.size());
    }
    meter.release();
    drawn.error = errorOfImages(kind, errors);
    return drawn;
  }

  const ErrorKind kind;
  const std::shared_ptr<const terrain::Database> land;
  const Flight flight;
  std::unique_ptr<experiment::Stage> stage;
  std::unique_ptr<FlightModel> model;
  DrawnSamples samples;
};

}  // namespace trimtab::tune
