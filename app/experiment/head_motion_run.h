#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "stage.h"
#include "trimtab/hold/cost_model.h"
#include "trimtab/measure/paired_ratio.h"

/// Declares what the experiments of document C share: a head that is moved over a place, in each mode of the
/// optimizer.
namespace trimtab::experiment {

/// Images a second of an experiment's own clock; what an image takes to draw does not slow the head.
inline constexpr int kImagesPerS = 200;

struct MotionMode {
  MotionControl control;
  const char* name;
  bool holds = false;  ///< the arbiter holds the budget, and may leave out the blur
};
inline constexpr std::array<MotionMode, 4> kMotionModes{
    {{MotionControl::off, "before"},
     {MotionControl::lod_scale_and_blur, "lod_scale_and_blur"},
     {MotionControl::with_restoration, "with_restoration"},
     {MotionControl::with_restoration, "hold", true}}};

/// Describes how a head moves: its attitude relative to the aircraft at each second from 0 on.
struct HeadProfile {
  double seconds = 0;
  std::function<Attitude(double seconds)> at;
  int images() const { return int(std::lround(seconds * kImagesPerS)); }
};

/// Holds what one mode drew, by image.
struct MotionRun {
  std::vector<std::vector<double>> ms;  ///< by image, one for each pass
  std::vector<double> vertices, lodScale, blur;
  std::vector<std::vector<std::uint8_t>> pictures;  ///< RGBA, of the images that `kept` names
  CostModel model;                                  ///< learned so far, for the next pass

  /// Returns the median of the passes, by image.
  std::vector<double> medians() const;
  std::size_t passes() const { return ms.empty() ? 0 : ms.front().size(); }
  /// Returns the times of the images from `from` up to `to` in one pass.
  std::vector<double> ofPass(std::size_t pass, int from, int to) const;
};
using MotionRuns = std::array<MotionRun, kMotionModes.size()>;

/// Flies the profile in all modes, `setup.repeats` times in turns, so that a slow spell of the machine meets
/// all of them. The eye stands 2,000 ft above the highest ground around the experiment's place, and the host
/// sends `setup.hostRateHz` states a second. Mode *hold* has a budget of kHeldPart of
/// the median image of a first pass in mode *before*. `kept` names the images whose pixels are kept.
Result<MotionRuns> flyHead(Stage& stage, const Setup& setup, const HeadProfile& profile,
                           const std::function<bool(int image)>& kept, const std::string& what);

/// Returns how many times the rate of one mode is that of mode `before`, at a quantile of the images' times
/// from `from` up to `to`: 1 for the smallest rate, 0.5 for the median one. Each pass is a pair, because its
/// slowest image may be any disturbance of the machine.
PairedRatio gainOf(const MotionRun& before, const MotionRun& with, int from, int to, double quantile);
/// Says whether document C's gain, 1.7 times the smallest rate, shows over this form of the terrain, as far
/// as the intervals show.
std::string gainText(const std::string& form, const MotionRun& before, const MotionRun& with, int from,
                     int to);

/// Returns how often in each pass the rate falls rapidly from one image to the next.
std::vector<double> rapidDrops(const MotionRun& run);
/// Says whether restoration leaves fewer rapid drops, as far as the passes show.
std::string rapidDropsText(const std::string& form, const MotionRuns& runs);

/// Returns the forms of the terrain that an experiment compares, as they are drawn: what the preset asks for,
/// then tiled levels and static trees, as far as the database has them.
std::vector<TerrainForm> formsOf(const Setup& setup);
std::string nameOf(TerrainForm form);

/// Returns the columns of the tables of these experiments: what was measured over what, and each mode.
std::vector<std::string> motionColumns();
/// Adds a row of one quantity.
void addRow(Table& table, const std::string& form, const char* quantity, const MotionRuns& runs,
            const std::function<double(const MotionRun&)>& valueOf);

/// Returns one line for each mode over the profile's time.
Plot motionPlot(const std::string& file, const std::string& title, const std::string& label,
                const MotionRuns& runs, const std::function<std::vector<double>(const MotionRun&)>& values);

}  // namespace trimtab::experiment
