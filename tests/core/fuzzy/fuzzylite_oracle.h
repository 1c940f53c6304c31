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

/// Altitude membership, pitch membership, sum, twice the minimum, Eq. (2).
using FuzzyResult = std::array<double, 5>;
/// By the oracle, altitude by altitude; fewer than the grid has where the program fails, and then `error` is
/// set.
std::vector<FuzzyResult> byFuzzylite(const AltitudeParameters& altitude, const PitchParameters& pitch,
                                     const RuleList& rules, const Grid& grid, std::string& error);
/// The only output of an engine in the language that `format` names (fll, fis), altitude by altitude, by the
/// oracle; fewer than the grid has where the program fails, and then `error` is set.
std::vector<double> byFuzzylite(const std::string& engine, const std::string& format, const Grid& grid,
                                std::string& error);
/// What the oracle makes of an engine in another language; empty where it refuses.
std::string convertedByFuzzylite(const std::string& engine, const std::string& from, const std::string& to);

/// By us, in the same order.
FuzzyResult byUs(const AltitudeParameters& altitude, const PitchParameters& pitch, const RuleList& rules,
                 double altitudeFt, double pitchDeg);

/// Nanoseconds that fuzzylite says it takes to evaluate the four rules of Eq. (2) once: its own benchmark
/// over the grid, the least of `runs`.
std::optional<double> fuzzyliteNanoseconds(const Grid& grid, int runs);

/// Returns fuzzylite's own measure of one evaluation, the least of `runs`, over the rows of out.fld in `dir`
/// by engine.fll in it; nothing if it fails.
std::optional<double> benchmarkNanoseconds(const std::filesystem::path& dir, std::size_t rows, int runs);

}  // namespace trimtab::test
