#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/preset/parameters.h"

/// The `fuzzylite` program as an independent oracle of the fuzzy arithmetic, and as a peer in speed.
namespace trimtab::test {

bool fuzzylitePresent();

/// Every pair of an altitude and a pitch.
struct Grid {
  std::vector<double> altitude, pitch;
  std::size_t size() const { return altitude.size() * pitch.size(); }
};
/// Evenly spaced, and the curves' own points.
Grid gridFor(const AltitudeParameters& altitude, const PitchParameters& pitch, int altitudes, int pitches);

/// Altitude membership, pitch membership, sum, twice the minimum.
using FuzzyResult = std::array<double, 4>;
/// By the oracle, altitude by altitude; fewer than the grid has where the program fails, and then `error` is
/// set.
std::vector<FuzzyResult> byFuzzylite(const AltitudeParameters& altitude, const PitchParameters& pitch,
                                     const Grid& grid, std::string& error);
/// What the oracle makes of an engine in another language; empty where it refuses.
std::string convertedByFuzzylite(const std::string& engine, const std::string& from, const std::string& to);

/// By us, in the same order.
FuzzyResult byUs(const AltitudeParameters& altitude, const PitchParameters& pitch, double altitudeFt,
                 double pitchDeg);

/// Returns fuzzylite's own measure of one evaluation, the least of `runs`, over the rows of out.fld in `dir`
/// by engine.fll in it; nothing if it fails.
std::optional<double> benchmarkNanoseconds(const std::filesystem::path& dir, std::size_t rows, int runs);

}  // namespace trimtab::test
