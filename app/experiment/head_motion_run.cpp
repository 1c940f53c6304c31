#include "head_motion_run.h"

#include <algorithm>
#include <cstdio>

#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/host/received_state.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::experiment {
namespace {

constexpr double kEyeFt = 2000;
/// Images between two questions whether to go on.
constexpr int kAsked = 40;
/// A rate that falls by more than this share from one image to the next is a rapid drop.
constexpr double kDrop = 0.3;

/// Flies once through the profile; the first pass also counts and keeps images. Returns false if `go` does.
bool pass(Stage& stage, const Setup& setup, const ValidatedParameters& parameters,
          const GeodeticPosition& eye, const HeadProfile& profile, const std::function<bool(int)>& kept,
          bool first, MotionRun& run, const auto& go) {
  Session session(parameters);
  session.setGround(setup.terrain);
  session.setLoadIndex(scene::loadIndexOf(setup.terrain));
  session.hold().model() = run.model;
  AircraftState state;
  state.position = eye;
  const int images = profile.images();
  run.ms.resize(std::size_t(images));
  for (int i = 0; i < images; ++i) {
    if (i % kAsked == 0 && !go(double(i) / images)) return false;
    const double now = double(i) / kImagesPerS;
    // The slack puts the states of a host as fast as the images into their images.
    for (; double(state.packet) / setup.hostRateHz <= now + 1e-9; ++state.packet) {
      state.time = double(state.packet) / setup.hostRateHz;
      state.head = profile.at(state.time);
      session.receive(std::vector{ReceivedState{state, state.time, state.time}});
    }
    const std::optional<FrameRequest> request = session.request(now, setup.widthPx, setup.heightPx);
    const FrameResult result = stage.draw(*request);
    session.finished(result, now);
    run.ms[std::size_t(i)].push_back(result.cost.total);
    if (!first) continue;
    run.vertices.push_back(double(result.visible.vertices));
    run.lodScale.push_back(request->decision.motion.lodScale);
    run.blur.push_back(request->levers.drawn.blurStrength);
    if (kept(i)) run.pictures.push_back(stage.shown());
  }
  run.model = session.hold().model();
  return true;
}

Result<ValidatedParameters> inMode(const TuningParameters& preset, const MotionMode& mode, double budgetMs) {
  TuningParameters changed = preset;
  changed.motion.control = mode.control;
  changed.hold.enabled = mode.holds;
  changed.measure.budget = Milliseconds{budgetMs};
  return validate(changed);
}

}  // namespace

std::vector<double> MotionRun::medians() const {
  std::vector<double> result;
  for (const auto& repeats : ms) result.push_back(quantileOf(repeats, 0.5));
  return result;
}

std::vector<double> MotionRun::ofPass(std::size_t pass, int from, int to) const {
  std::vector<double> images;
  for (int i = from; i < to; ++i) images.push_back(ms[std::size_t(i)][pass]);
  return images;
}

PairedRatio gainOf(const MotionRun& before, const MotionRun& with, int from, int to, double quantile) {
  std::vector<double> a, b;
  for (std::size_t pass = 0; pass < std::min(before.passes(), with.passes()); ++pass) {
    a.push_back(quantileOf(with.ofPass(pass, from, to), quantile));
    b.push_back(quantileOf(before.ofPass(pass, from, to), quantile));
  }
  return pairedRatio(a, b);
}

std::string gainText(const std::string& form, const MotionRun& before, const MotionRun& with, int from,
                     int to) {
  const PairedRatio smallest = gainOf(before, with, from, to, 1),
                    median = gainOf(before, with, from, to, 0.5);
  const MeasuredDifference gain = differenceOf(smallest);
  const char* const verdict =
      gain == MeasuredDifference::unknown ? "the passes are too few to tell whether the gain holds"
      : gain == MeasuredDifference::none  ? "the passes show no difference"
      : gain == MeasuredDifference::more && differenceOf(median) != MeasuredDifference::less
          ? "the gain holds"
          : "the gain does not hold";
  char text[400];
  std::snprintf(
      text, sizeof text,
      "Over %s %s: with restoration the smallest rate of the sweep is %.2f times (%.2f to %.2f) that "
      "of before (published 1.7), the median rate %.2f times (%.2f to %.2f); medians of %zu passes "
      "with their 95 %% intervals, which need 6.",
      form.c_str(), verdict, smallest.median, smallest.low, smallest.high, median.median, median.low,
      median.high, smallest.pairs);
  return text;
}

std::vector<double> rapidDrops(const MotionRun& run) {
  std::vector<double> drops;
  for (std::size_t pass = 0; pass < run.passes(); ++pass) {
    const std::vector<double> ms = run.ofPass(pass, 0, int(run.ms.size()));
    double count = 0;
    for (std::size_t i = 1; i < ms.size(); ++i) count += ms[i - 1] / ms[i] < 1 - kDrop;
    drops.push_back(count);
  }
  return drops;
}

std::string rapidDropsText(const std::string& form, const MotionRuns& runs) {
  const std::vector<double> without = rapidDrops(runs[1]), with = rapidDrops(runs[2]);
  const PairedDifference difference = pairedDifference(without, with);
  const MeasuredDifference found = differenceOf(difference);
  const char* const verdict =
      found == MeasuredDifference::less   ? "restoration leaves fewer rapid drops of the rate"
      : found == MeasuredDifference::more ? "restoration adds rapid drops of the rate"
      : found == MeasuredDifference::none ? "rapid drops of the rate show no difference"
                                          : "the passes are too few to compare rapid drops";
  char text[480];
  std::snprintf(text, sizeof text,
                "Over %s %s: %.0f with it, %.0f without (difference %.0f, %.0f to %.0f), %.0f without the "
                "mechanism; medians of %zu passes with a 95 %% interval, which needs 6. A rapid drop is an "
                "image whose rate is %.0f %% below the one before.",
                form.c_str(), verdict, quantileOf(with, 0.5), quantileOf(without, 0.5), difference.median,
                difference.low, difference.high, quantileOf(rapidDrops(runs[0]), 0.5), difference.pairs,
                kDrop * 100);
  return text;
}

Result<MotionRuns> flyHead(Stage& stage, const Setup& setup, const HeadProfile& profile,
                           const std::function<bool(int image)>& kept, const std::string& what) {
  const std::vector<Place> places = placesOf(setup, 1);
  if (places.empty()) return notOverTerrain(setup);
  GeodeticPosition eye = places[0].ground;
  eye.height = eye.height + Feet{kEyeFt}.as<Metres>();

  MotionRuns runs;
  const int passes = std::max(setup.repeats, 1);
  const double flights = 1.0 + passes * double(kMotionModes.size());
  double flown = 0;
  const auto fly = [&](int r, std::size_t m, double budgetMs, MotionRun& run) -> Findings {
    char text[120];
    std::snprintf(text, sizeof text, "%s %d of %d, %s", what.c_str(), std::max(r, 0) + 1, passes,
                  kMotionModes[m].name);
    const auto go = [&](double part) {
      return !setup.progress || setup.progress((flown + part) / flights, text);
    };
    const Result<ValidatedParameters> parameters = inMode(setup.parameters, kMotionModes[m], budgetMs);
    if (!parameters) return parameters.findings();
    if (!pass(stage, setup, *parameters, eye, profile, kept, r == 0, run, go)) return {cancelled()};
    ++flown;
    return {};
  };
  // A pass before the first builds levels and finds the budget.
  MotionRun warm;
  double budgetMs = setup.parameters.measure.budget.value();
  if (const Findings findings = fly(-1, 0, budgetMs, warm); !findings.empty()) return findings;
  budgetMs = kHeldPart * quantileOf(warm.medians(), 0.5);
  for (int r = 0; r < passes; ++r)
    for (std::size_t m = 0; m < kMotionModes.size(); ++m)
      if (const Findings findings = fly(r, m, budgetMs, runs[m]); !findings.empty()) return findings;
  return runs;
}

std::vector<TerrainForm> formsOf(const Setup& setup) {
  std::vector<TerrainForm> forms;
  for (const TerrainForm wanted :
       {setup.parameters.terrain.form, TerrainForm::tiles, TerrainForm::static_trees}) {
    FrameRequest request;
    request.terrain.form = wanted;
    const auto drawn = scene::formDrawn(request, setup.terrain.get());
    if (drawn && std::find(forms.begin(), forms.end(), *drawn) == forms.end()) forms.push_back(*drawn);
  }
  return forms;
}

std::string nameOf(TerrainForm form) {
  return std::string(findRow("terrain.form")->choices[static_cast<std::size_t>(form)].name);
}

std::vector<std::string> motionColumns() {
  std::vector<std::string> columns{"terrain", "quantity"};
  for (const MotionMode& mode : kMotionModes) columns.emplace_back(mode.name);
  return columns;
}

void addRow(Table& table, const std::string& form, const char* quantity, const MotionRuns& runs,
            const std::function<double(const MotionRun&)>& valueOf) {
  std::vector<Cell> cells{form, std::string(quantity)};
  for (const MotionRun& run : runs) cells.emplace_back(valueOf(run));
  table.rows.push_back(std::move(cells));
}

Plot motionPlot(const std::string& file, const std::string& title, const std::string& label,
                const MotionRuns& runs, const std::function<std::vector<double>(const MotionRun&)>& values) {
  Plot plot{file, title, "time (s)", label, {}, {}};
  for (std::size_t m = 0; m < kMotionModes.size(); ++m) {
    Series series{kMotionModes[m].name, {}, values(runs[m])};
    for (std::size_t i = 0; i < series.y.size(); ++i) series.x.push_back(double(i) / kImagesPerS);
    plot.series.push_back(std::move(series));
  }
  return plot;
}

}  // namespace trimtab::experiment
