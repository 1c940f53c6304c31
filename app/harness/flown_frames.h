#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "app/experiment/stage.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/table.h"
#include "trimtab/terrain/format/database.h"

/// Flies presets over flights as an image generator does, and keeps the requests of the rows to measure.
namespace trimtab::harness {

/// Says how the decisions of a preset depend on the images that it has drawn before.
struct Feedback {
  bool counts = false;  ///< triangles or vertices
  bool times = false;   ///< how long images take, so that two flights of the same rows may decide otherwise
  /// Longest time for which an image may have an effect, in seconds of the flight and in images.
  double rememberedS = 0;
  std::size_t rememberedImages = 0;

  bool any() const { return counts || times; }
};
Feedback feedbackOf(const ValidatedParameters& parameters);

/// Says how presets fly.
struct Flying {
  std::shared_ptr<const terrain::Database> terrain;
  int widthPx = 0, heightPx = 0;
  /// Draws every row. Otherwise only the rows are drawn that may have an effect on one to measure.
  bool whole = false;
  /// Flights of a preset whose decisions depend on time. Any other flies once.
  std::size_t repeats = 1;
  /// Called after each image; returning false stops the flight.
  std::function<bool()> goOn;
};

/// A row to measure, as a preset came to it.
struct FlownFrame {
  struct Image {
    FrameRequest request;
    /// Requests of the rows before, oldest first: one, or as many as can affect a blur.
    std::vector<FrameRequest> before;
  };
  std::size_t row = 0;
  double timeS = 0;
  double decideMs = 0;        ///< median of several decisions
  std::vector<Image> images;  ///< one of each flight

  const Image& ofRepeat(std::size_t repeat) const { return images[repeat % images.size()]; }
};

/// Returns `count` rows spread evenly over those above the terrain, or all of these if there are fewer.
std::vector<std::size_t> sampledRows(const Flight& flight, const terrain::Database& terrain,
                                     std::size_t count);

/// Returns how many images flyFrames() draws.
std::size_t imagesToFly(const Flying& flying, const Flight& flight, const ValidatedParameters& parameters,
                        const std::vector<std::size_t>& rows);

/// Decides every row of a flight in order, in one session for each flight, and returns the frames of `rows`,
/// which must ascend. Time comes from the rows, never from a clock. If the preset has feedback, images are
/// drawn on `stage` and their triangles and times are given to the session: as long before each row as they
/// may have an effect on it, or all with Flying::whole. If decisions depend on time, images are drawn as in
/// flight, otherwise reproducibly. A preset that holds the budget flies to some of the rows
/// before, so that its cost model has learned this machine; then all flights begin with the same model.
/// Returns nothing if it was stopped.
std::optional<std::vector<FlownFrame>> flyFrames(experiment::Stage& stage, const Flying& flying,
                                                 const Flight& flight, const ValidatedParameters& parameters,
                                                 const std::vector<std::size_t>& rows);

}  // namespace trimtab::harness
