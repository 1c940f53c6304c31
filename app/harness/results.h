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

/// Declares what `trimtab-cli bench` measures: run time against error over flights, presets and cases.
namespace trimtab::harness {

/// One preset in one culling case along one flight.
struct UnitName {
  std::string flight, preset, method;  ///< method as choices.h spells CullingCase

  friend bool operator==(const UnitName&, const UnitName&) = default;
};

/// One frame of a unit. `cost` has the medians of its repeats. Errors and counts are equal in all repeats;
/// but if the preset decides by time, they are means of the repeats, and largest errors the largest of them.
struct MeasuredFrame {
  std::size_t row = 0;  ///< of the flight
  double timeS = 0;     ///< of the flight's clock
  FrameCost cost;
  TraceCounts counts;
  FrameError error;
  FrameLevers levers;  ///< with which it was drawn; means over the flights
  /// `cost.total` of each repeat in the order drawn, in milliseconds. The n-th repeats of all units of a
  /// flight were drawn one after the other.
  std::vector<double> repeatsMs;
};

/// A worst frame of a unit; its images are files beside the results.
struct WorstFrame {
  std::size_t frame = 0;                    ///< index into Unit::frames
  std::string why;                          ///< "largest FLIP", "longest frame", ...
  std::string reference, ours, difference;  ///< PNG files by name
};

/// Work that frames skipped because its result was known, and what that saved per frame, measured in pairs
/// with the skip on and off.
struct SkipSaving {
  std::string name;                                           ///< "blur at rest"
  std::uint64_t skipped = 0;                                  ///< frames that skipped it
  std::uint64_t frames = 0;                                   ///< frames that were examined
  double savedMs = std::numeric_limits<double>::quiet_NaN();  ///< median per frame; NaN: not measured
  PairedRatio ratio;                                          ///< frame without the skip over frame with it
};

struct Unit {
  UnitName name;
  std::vector<MeasuredFrame> frames;
  std::vector<WorstFrame> worst;
  std::vector<SkipSaving> skips;
  std::size_t framesDecided = 0;  ///< rows of the flight that were decided
  /// Keys of the signals that the preset's rules ask for and that nobody knew in any of the frames.
  std::vector<std::string> unknownSignals;
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
  /// Share of the machine that other programs used meanwhile, 0 to 1; NaN: unknown.
  double othersShare = std::numeric_limits<double>::quiet_NaN();
};

/// Returns the ratio of frame times b over a. Each frame counts once, by the median ratio of its repeats:
/// disturbances that both share cancel, and the interval does not grow narrower by repeating a frame.
PairedRatio frameTimeRatio(const Unit& a, const Unit& b, double confidence = kConfidence);
/// Compares within each flight every preset with the first one in the same case, and every other case with
/// view_frustum in the same preset.
std::vector<Comparison> compareUnits(const std::vector<Unit>& units);

/// A number that each frame has: a column of the CSV, an axis of a plot.
struct Quantity {
  enum class Kind { cost, count, error, lever };

  std::string_view key;    ///< "frame_ms", "flip"
  std::string_view label;  ///< "frame time"
  std::string_view unit;   ///< "ms"; empty for a pure number
  Kind kind = Kind::cost;
  double (*of)(const MeasuredFrame&) = nullptr;
  void (*set)(MeasuredFrame&, double) = nullptr;
  bool whole = false;  ///< an integer that is always present; other quantities may be NaN
  bool largerIsWorse = true;
  StageKind stage = StageKind::of_frame;  ///< for costs: which of them sum to the frame (cost_stages.h)
};
/// Returns all quantities in the order of the CSV: the frame, its stages in the order of cost_stages.h,
/// counts, errors, levers. A mechanism that adds a count or an error adds a row here and nowhere else.
const std::vector<Quantity>& quantities();
const Quantity* quantityOf(std::string_view key);

/// A quantity over the frames of a unit; NaN if no frame has it, and for a percentile that the frames are not
/// enough for. If smaller is worse (PSNR, SSIM), percentiles count from the other end: 95 % of the frames
/// reach p95, and `worst` is the smallest value.
struct Summary {
  double median = 0, mean = 0, p95 = 0, p99 = 0, worst = 0;
};
Summary summarise(const Unit& unit, const Quantity& quantity);
/// Returns the values of a quantity that are finite.
std::vector<double> finiteOf(const Unit& unit, const Quantity& quantity);

/// Returns the results as JSON. Numbers read back bit for bit; NaN and infinity are strings.
std::string toJson(const Results& results);
/// Reads what toJson wrote, or reports every error with its place in the document. Unknown members and
/// columns are ignored.
Result<Results> parseResults(std::string_view json, const std::string& where);
/// Returns CSV with one row per frame of all units.
std::string toCsv(const Results& results);

}  // namespace trimtab::harness
