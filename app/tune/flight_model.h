#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "drawn_samples.h"
#include "flight_rows.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/table.h"
#include "trimtab/terrain/format/database.h"

/// Estimates what a preset would take and lose over a flight, without drawing it.
namespace trimtab::tune {

/// What a preset is estimated to take and to lose over the rows of a flight that lie above the terrain. It is
/// an estimate and no bound: whoever needs more draws.
struct Estimate {
  double medianMs = 0, p95Ms = 0, p99Ms = 0;  ///< by nearest rank, whatever the number of rows
  double meanMs = 0;
  double error = 0;  ///< of the flight's images, as errorOfImages() has it
  /// The fitted bands: nine of ten images that were drawn for samples lie within this part of their estimate,
  /// to either side.
  double timeBand = 0, errorBand = 0;
};

/// The same of one row.
struct RowEstimate {
  std::size_t row = 0;  ///< of the flight
  double ms = 0, error = 0;
};

/// Knows of every row of a flight what each allowed error would draw, counted once in the terrain's index,
/// and from a few drawn rows what triangles and pixels cost and what each lever loses. A preset's decisions
/// are those of a session, row by row; load and triangles that its rules ask for, and the budget that it
/// holds, follow from the estimate itself.
class FlightModel {
 public:
  using Scene = FlightScene;
  /// Counts. At most `kMostRows` rows are kept, evenly spread. `start` says from where and how widely one
  /// looks. The rows to draw are `drawn` of them at most, and samples of them are of errors of this kind.
  FlightModel(const Scene& scene, const Flight& flight, const ValidatedParameters& start, std::size_t drawn,
              ErrorKind kind = ErrorKind::flip);
  ~FlightModel();
  FlightModel(FlightModel&&) noexcept;

  static constexpr std::size_t kMostRows = 1200;

  /// Returns the rows that samples are to be drawn of; empty if no row lies above the terrain.
  const std::vector<SampleRow>& toDraw() const;
  /// Fits costs to the samples and takes their losses. They must be of the rows of toDraw().
  void learn(const DrawnSamples& samples);

  /// Estimates a preset; NaN if it draws another form of the terrain than the start, which nobody has
  /// counted. Call it after learn(), and from one thread at a time: decisions that the last preset shares are
  /// kept. Those rows that lie above the terrain are appended to `rows`, if it is given.
  Estimate estimate(const ValidatedParameters& parameters, std::vector<RowEstimate>* rows = nullptr) const;

  /// Returns what an image takes of which nothing is ground, milliseconds, in the row where it takes most.
  double emptyMs() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trimtab::tune
