#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/frame/frame.h"
#include "trimtab/measure/cost_stages.h"
#include "trimtab/measure/frame_error.h"
#include "trimtab/measure/paired_ratio.h"
#include "trimtab/measure/trace.h"
#include "trimtab/units/result.h"

/// What `trimtab-cli bench` measures: run time against error, over flights x presets x cases.
namespace trimtab::harness {

/// One preset in one culling case along one flight.
struct UnitName {
  std::string flight, preset, method;  ///< method as choices.h spells CullingCase

  friend bool operator==(const UnitName&, const UnitName&) = default;
};

/// One frame of a unit. `cost` is the medians of its repeats; errors and counts repeat exactly.
struct MeasuredFrame {
  std::size_t row = 0;  ///< of the flight
  double timeS = 0;     ///< of the flight's clock
  FrameCost cost;
  TraceCounts counts;
  FrameError error;
  /// `cost.total` of each repeat in the order drawn: the n-th repeats of all units of a flight were drawn one
  /// after the other.
  std::vector<double> repeatsMs;
};

/// A worst frame of a unit, as files beside the results.
struct WorstFrame {
  std::size_t frame = 0;                    ///< index into Unit::frames
  std::string why;                          ///< "largest FLIP", "longest frame", ...
  std::string reference, ours, difference;  ///< PNG files by name
};

/// Work that frames left out because its result was known, and what leaving it out saved: milliseconds a
/// frame, by switching the skip off and measuring in pairs.
struct SkipSaving {
  std::string name;                                           ///< "blur at rest"
  std::uint64_t skipped = 0;                                  ///< frames that skipped it
  std::uint64_t frames = 0;                                   ///< of so many
  double savedMs = std::numeric_limits<double>::quiet_NaN();  ///< median; NaN: never skipped
  PairedRatio ratio;                                          ///< frame without the skip over frame with it
};

struct Unit {
  UnitName name;
  std::vector<MeasuredFrame> frames;
  std::vector<WorstFrame> worst;
  std::vector<SkipSaving> skips;
  std::size_t framesDecided = 0;  ///< rows of the flight that were decided
};

/// Frame times of two units of one flight, measured frame by frame in turn.
struct Comparison {
  UnitName a, b;
  PairedRatio frameTime;  ///< b over a
};

struct Results {
  std::string terrain, machine, version;
  int widthPx = 0, heightPx = 0;
  std::size_t repeats = 0;
  double budgetMs = std::numeric_limits<double>::quiet_NaN();  ///< measure.budget_ms of the first preset
  std::vector<Unit> units;
  std::vector<Comparison> comparisons;
  std::vector<std::string> notes;  ///< conditions
};

/// One pair a frame, the median of the ratios of its repeats, so that what pairs share (the machine's mood)
/// cancels out, and frames, not repeats, are what the interval counts.
PairedRatio frameTimeRatio(const Unit& a, const Unit& b);
/// Within each flight: every preset against the first one in the same case, every other case against
/// view_frustum in the same preset.
std::vector<Comparison> compareUnits(const std::vector<Unit>& units);

/// A number of a frame by which frames are told apart: a column of the CSV, an axis of a plot.
struct Quantity {
  enum class Kind { cost, count, error };

  std::string_view key;    ///< "frame_ms", "flip"
  std::string_view label;  ///< "frame time"
  std::string_view unit;   ///< "ms"; empty for a pure number
  Kind kind = Kind::cost;
  double (*of)(const MeasuredFrame&) = nullptr;
  void (*set)(MeasuredFrame&, double) = nullptr;
  bool whole = false;  ///< a whole number that is never absent; others may be NaN
  bool largerIsWorse = true;
  StageKind stage = StageKind::of_frame;  ///< of a cost: which of them sum to the frame (cost_stages.h)
};
/// All of them, in the order of the CSV: the frame, its stages as cost_stages.h lists them, counts, errors. A
/// mechanism that adds a count or an error adds a line there and nowhere else.
const std::vector<Quantity>& quantities();
const Quantity* quantityOf(std::string_view key);

/// NaN where no frame has the quantity. For one of which smaller is worse (PSNR, SSIM) the percentiles are
/// taken from the other end: p95 is what 95 % of the frames reach, `worst` the smallest.
struct Summary {
  double median = 0, mean = 0, p95 = 0, p99 = 0, worst = 0;
};
Summary summarise(const Unit& unit, const Quantity& quantity);

/// The whole document; numbers read back bit for bit, NaN and infinity as strings.
std::string toJson(const Results& results);
/// Every offence with its place in the document; members and columns this version does not know are passed
/// over.
Result<Results> parseResults(std::string_view json, const std::string& where);
/// One row a frame of all units.
std::string toCsv(const Results& results);

}  // namespace trimtab::harness
