#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "drawn_samples.h"
#include "lever_places.h"
#include "trimtab/host/flight.h"
#include "trimtab/preset/table.h"
#include "trimtab/terrain/format/database.h"

/// Counts what the rows of a flight would draw, chooses the few that are drawn, and spreads what those showed
/// over the others.
namespace trimtab::tune {

/// Where images are and how large.
struct FlightScene {
  std::shared_ptr<const terrain::Database> terrain;
  int widthPx = 0, heightPx = 0;
};

/// Holds what the model knows of one row of a flight.
struct FlightRow {
  std::size_t row = 0;  ///< of the flight
  /// Its state, with the velocity that follows from those before; the ground is asked for by each preset.
  FrameInput input;
  std::optional<Metres> ground;  ///< height of the ground below
  bool over = false;             ///< lies above the terrain, so that its image counts
  double turnDegps = 0;          ///< of the view since the row before
  double groundMpx = 0, imageMpx = 0;
  Counted tiles{}, objects{};            ///< triangles of the ground and of objects
  Counted tilesAhead{}, objectsAhead{};  ///< the most of this row and of those that a budget looks ahead to
  // From the drawn rows before and after it.
  double drawnHidden = 1, drawnOpen = 1;
  double costs = 1;                    ///< over the fitted cost
  std::array<Steps, kLosses> error{};  ///< of images with one lever moved
  Steps smallKept{}, objectsKept{}, airKept{}, smallInstances{}, farInstances{};
  SpreadKept spreadKept{};
  Steps spreadLoses{};  ///< by how many octaves of the allowed error a spread changes what is lost
  double instances = 0, atRest = 0;
};

struct CountedFlight {
  std::vector<FlightRow> rows;
  std::vector<SampleRow> toDraw;
  std::vector<SpreadKept> spreads;  ///< of the rows to draw
  FormsOfTerrain forms;             ///< that the terrain has
  std::optional<TerrainForm> form;  ///< that is counted
  double pixelsPerRadian = 0;       ///< of the image
  double spreadFromM = 0;           ///< with which samples are drawn
};

/// Counts as FlightModel's constructor says.
CountedFlight countFlight(const FlightScene& scene, const Flight& flight, const ValidatedParameters& start,
                          std::size_t mostRows, std::size_t drawn);

/// Gives each row what the samples say, on straight lines between the drawn rows: blur over how fast the view
/// turns, all else over the flight, and by how much ground is in the image. `costs` are what the drawn rows
/// cost over the fitted cost.
void takeSamples(CountedFlight& flight, ErrorKind kind, const DrawnSamples& samples,
                 const std::vector<double>& costs);

}  // namespace trimtab::tune
