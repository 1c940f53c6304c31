#pragma once

#include <string>
#include <vector>

#include "trimtab/units/geodesy.h"

/// The sample flight: a jet trainer's ten minutes around 36.63 N 128.35 E. Take-off, climb, a zoom through
/// 8,000 ft, cruise at 9,000 ft, steep turns at 9,000 and 5,500 ft, descent, approach, go-around: every band
/// of the default preset is visited. Calculated, not recorded: a point mass that is flown by commands of
/// bank, path angle and speed.
namespace trimtab::flights {

struct CircuitRow {
  double time = 0;
  GeodeticPosition position;
  Attitude attitude;
};

inline constexpr double kCircuitSeconds = 600, kCircuitStep = 0.1;

std::vector<CircuitRow> circuit();
/// As a flight file: columns of flight CSV, rounded to what the model is worth (1e-9 deg, 0.001 ft, 0.0001
/// deg).
std::string circuitCsv(const std::vector<CircuitRow>& rows);

}  // namespace trimtab::flights
