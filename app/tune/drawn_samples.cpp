#include "drawn_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "trimtab/measure/geometric_error.h"
#include "trimtab/measure/image_error.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab::tune {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRepeats = 3;

/// Settings that an image is timed at, so that what it costs by triangle, by pixel and for looking for hidden
/// ground can be told apart.
struct TimedSetting {
  double groundPx, objectPx, smallPx, renderScale;
  bool looksForHidden;
  double blurStrength = 0;  ///< above 0 it is timed only in rows with a trail
};
constexpr std::array kTimedSettings{
    TimedSetting{1, 1, 0, 1, true},   TimedSetting{4, 4, 0, 1, true},   TimedSetting{16, 16, 8, 1, true},
    TimedSetting{2, 8, 2, 1, true},   TimedSetting{8, 2, 0, 0.5, true}, TimedSetting{4, 4, 4, 0.7, true},
    TimedSetting{16, 16, 0, 1, true}, TimedSetting{4, 4, 0, 1, false},  TimedSetting{4, 4, 0, 1, true, 0.8},
};
/// The first of those that move several levers at once.
constexpr std::size_t kFirstTogether = 3;
/// The largest depth map of the shipped presets; looking for hidden ground costs most there.
constexpr OcclusionResolution kLooking{800, 600};

/// Returns the image with every lever at rest: no error to speak of, everything drawn.
FrameRequest atRest(FrameRequest request) {
  FrameLevers& levers = request.levers.drawn;
  levers.lodScale = levers.levelSpread = levers.renderScale = levers.particleShare = 1;
  levers.errorPx = levers.objectErrorPx = levers.treeErrorPx = kLossValues[0][0] / 2;
  request.staticLod.rule = StaticDistanceRule::picture;
  levers.blurStrength = levers.smallFeaturePx = 0;
  levers.objectFarM = WeatherDecision::kUnlimited;
  levers.farM = request.levers.weather.farM;
  levers.occlusion = kLooking;
  request.hold = {};
  request.symbology.reset();
  return request;
}

/// Reports whether a lever moves anything in this image.
bool moves(const FrameRequest& request, Loss loss) {
  if (loss == Loss::far_distance) return std::isfinite(request.levers.drawn.farM);
  return loss != Loss::particles || fallsNow(request).kind != Precipitation::none;
}

/// Returns the image with one lever moved.
FrameRequest moved(FrameRequest request, Loss loss, double value) {
  FrameLevers& levers = request.levers.drawn;
  switch (loss) {
    case Loss::ground_error:
      levers.errorPx = levers.treeErrorPx = value;
      break;
    case Loss::object_error:
      levers.objectErrorPx = value;
      break;
    case Loss::small_feature:
      levers.smallFeaturePx = value;
      break;
    case Loss::object_distance:
      levers.objectFarM = value;
      break;
    case Loss::render_scale:
      levers.renderScale = value;
      break;
    case Loss::far_distance:
      levers.farM *= value;
      break;
    case Loss::particles:
      levers.particleShare = value;
      break;
    case Loss::blur:
      levers.blurStrength = value;
      break;
    case Loss::level_spread:
      levers.errorPx = levers.treeErrorPx = levers.objectErrorPx = kSpreadPx;
      levers.levelSpread = value;
      break;
  }
  return request;
}

FrameRequest timed(FrameRequest request, const TimedSetting& setting) {
  request = atRest(std::move(request));
  FrameLevers& levers = request.levers.drawn;
  levers.errorPx = levers.treeErrorPx = setting.groundPx;
  levers.objectErrorPx = setting.objectPx;
  levers.smallFeaturePx = setting.smallPx;
  levers.renderScale = setting.renderScale;
  levers.blurStrength = setting.blurStrength;
  if (!setting.looksForHidden) levers.occlusion.reset();
  return request;
}

/// Draws the images of a row and measures them. Whatever is done to an image is done to the one before it
/// too, as a preset's levers are.
class RowMeter {
 public:
  /// `size` is the part of the width and height at which it draws.
  RowMeter(experiment::Stage& stage, ErrorKind kind, double size, const SampleRow& row)
      : stage_(stage), kind_(kind), size_(size), now_(small(atRest(row.request))) {
    if (row.before) before_ = small(atRest(*row.before));
    if (row.trail)
      for (const FrameRequest& request : *row.trail) trail_.push_back(small(atRest(request)));
    if (pops()) referenceBefore_ = stage_.pixels(scene::referenceOf(*before_));
    reference_ = stage_.pixels(scene::referenceOf(now_));
    if (kind_ == ErrorKind::geometric) distances_ = stage_.distances();
  }

  /// Draws the image that `change` makes of the row's with every lever at rest, and returns its error; 0 for
  /// a pop without an image before. A blurred image follows those that it reaches back to.
  template <class Change>
  double error(const Change& change) {
    const FrameRequest request = change(now_);
    const double strength = request.levers.drawn.blurStrength;
    if (strength > 0)
      for (const FrameRequest& earlier : trail_)
        if (earlier.time >= now_.time - blurReachS(strength)) stage_.draw(change(earlier));
    std::vector<std::uint8_t> shownBefore;
    if (pops())
      shownBefore = stage_.pixels(change(*before_));
    else if (strength > 0 && before_)
      stage_.draw(change(*before_));
    drawn_ = stage_.draw(request);
    const ViewShape& view = request.view;
    switch (kind_) {
      case ErrorKind::flip:
        return flip(reference_, stage_.shown(), view.widthPx, view.heightPx, {},
                    size_ * kFlipPixelsPerDegree);
      case ErrorKind::geometric:
        return geometricError(distancesUpTo(farCutM(request), distances_), stage_.distances(), view).maxPx /
               size_;
      case ErrorKind::pop:
        return pops() ? scene::temporalPop(referenceBefore_, reference_, shownBefore, stage_.shown()) : 0;
    }
    return 0;
  }
  const FrameResult& drawn() const { return drawn_; }
  /// Returns the row's image with every lever at rest.
  const FrameRequest& atRestNow() const { return now_; }

 private:
  bool pops() const { return kind_ == ErrorKind::pop && before_; }
  /// Returns the same image at the size of losses, with the levels of the whole one.
  FrameRequest small(FrameRequest request) const {
    // As the reference is drawn: what a software rasteriser does to slivers is no lever's loss.
    request.exactSlivers = true;
    request.imagePxPerRadian = errorPxPerRadian(request);
    request.view = scaledShape(request.view, size_);
    return request;
  }

  experiment::Stage& stage_;
  const ErrorKind kind_;
  const double size_;
  const FrameRequest now_;
  std::optional<FrameRequest> before_;
  std::vector<FrameRequest> trail_;
  std::vector<std::uint8_t> referenceBefore_, reference_;
  std::vector<float> distances_;  ///< of the reference
  FrameResult drawn_;             ///< what the last image gave
};

bool movesObjects(Loss loss) {
  return loss == Loss::object_error || loss == Loss::small_feature || loss == Loss::object_distance;
}

void drawLosses(experiment::Stage& stage, ErrorKind kind, const SampleRow& sample, DrawnRow& row) {
  RowMeter meter(stage, kind, rowOf(kind).size, sample);
  row.atRest = meter.error(std::identity());
  // What a render scale loses are the finest details, of which an image of half the size has others.
  RowMeter whole(stage, kind, 1, sample);
  const double wholeAtRest = whole.error(std::identity());
  const FrameResult finest = meter.drawn();
  for (auto* kept : {&row.smallKept, &row.objectsKept, &row.airKept, &row.smallInstances, &row.farInstances})
    kept->fill(1);
  row.instances = static_cast<double>(finest.objects.drawn);
  const auto keptOf = [&](Loss loss) {
    return loss == Loss::small_feature     ? &row.smallKept
           : loss == Loss::object_distance ? &row.objectsKept
           : loss == Loss::far_distance    ? &row.airKept
                                           : nullptr;
  };
  const auto trianglesOf = [](const FrameResult& drawn, Loss loss) {
    return static_cast<double>(movesObjects(loss) ? drawn.objects.triangles : drawn.visible.triangles);
  };
  for (std::size_t l = 0; l < kLosses; ++l) {
    const auto loss = static_cast<Loss>(l);
    if (!moves(meter.atRestNow(), loss) || (movesObjects(loss) && finest.objects.all() == 0) ||
        (loss == Loss::blur && !sample.trail))
      continue;
    auto* const kept = keptOf(loss);
    auto* const instances = loss == Loss::small_feature     ? &row.smallInstances
                            : loss == Loss::object_distance ? &row.farInstances
                                                            : nullptr;
    const double all = trianglesOf(finest, loss);
    for (std::size_t step = 0; step < kLossSteps; ++step) {
      if (step > 0 && kLossValues[l][step] == kLossValues[l][step - 1]) {
        row.error[l][step] = row.error[l][step - 1];
        for (auto* parts : {kept, instances})
          if (parts) (*parts)[step] = (*parts)[step - 1];
        continue;
      }
      const auto change = [&](const FrameRequest& request) {
        return moved(request, loss, kLossValues[l][step]);
      };
      if (loss == Loss::render_scale) {
        row.error[l][step] = row.atRest + whole.error(change) - wholeAtRest;
        continue;
      }
      row.error[l][step] = meter.error(change);
      const FrameResult& drawn = meter.drawn();
      if (kept && all > 0) (*kept)[step] = trianglesOf(drawn, loss) / all;
      if (instances && row.instances > 0)
        (*instances)[step] = static_cast<double>(drawn.objects.drawn) / row.instances;
    }
  }
  for (std::size_t setting = 0; setting < kTogether; ++setting)
    row.together[setting] = row.atRest - wholeAtRest + whole.error([&](const FrameRequest& request) {
      return together(request, setting);
    });
}

/// Times the settings of one row once. Each image follows the one before it, as in flight; the first turn
/// makes what the second finds.
void timeImages(experiment::Stage& stage, const SampleRow& sample, std::span<TimedImage> images) {
  for (std::size_t s = 0; s < kTimedSettings.size(); ++s) {
    const TimedSetting& setting = kTimedSettings[s];
    if (setting.blurStrength > 0 && !sample.trail) continue;
    FrameResult drawn;
    for (int turn = 0; turn < 2; ++turn) {
      if (sample.before) stage.draw(timed(*sample.before, setting));
      drawn = stage.draw(timed(sample.request, setting));
    }
    const double area = setting.renderScale * setting.renderScale;
    const ViewShape& view = sample.request.view;
    const FadingPrecipitation falls = fallsNow(sample.request);
    TimedImage& image = images[s];
    image.row = sample.row;
    image.load = {static_cast<double>(drawn.visible.triangles), sample.groundMpx * area,
                  1e-6 * view.widthPx * view.heightPx * area,
                  falls.kind != Precipitation::none ? falls.amount : 0, setting.blurStrength > 0};
    image.instances = static_cast<double>(drawn.objects.drawn);
    image.looksForHidden = setting.looksForHidden;
    image.ms = std::min(image.ms, drawn.cost.total);
    image.repeatsMs.push_back(drawn.cost.total);
  }
}

/// Takes from the images of a row how many triangles are drawn of those that are counted.
void compareCounts(const SampleRow& sample, std::span<const TimedImage> images, DrawnRow& row) {
  std::vector<double> hidden, open;
  for (std::size_t s = 0; s < kTimedSettings.size(); ++s) {
    const TimedSetting& setting = kTimedSettings[s];
    const double counted = sample.counted(setting.groundPx, setting.objectPx);
    // What is too small is in no index's count.
    if (counted > 0 && setting.smallPx == 0 && std::isfinite(images[s].ms))
      (setting.looksForHidden ? hidden : open).push_back(images[s].load.triangles / counted);
  }
  if (!hidden.empty()) row.drawnHidden = experiment::quantileOf(hidden, 0.5);
  if (!open.empty()) row.drawnOpen = experiment::quantileOf(open, 0.5);
}

}  // namespace

FrameRequest together(FrameRequest request, std::size_t setting) {
  return timed(std::move(request), kTimedSettings[kFirstTogether + setting]);
}

double blurReachS(double strength) {
  // BlurPass keeps `strength` of the images before in a sixtieth of a second.
  return strength > 0 ? std::log(64) / (60 * -std::log(strength)) : 0;
}

std::optional<DrawnSamples> drawSamples(experiment::Stage& stage, std::span<const SampleRow> rows,
                                        ErrorKind kind, const std::function<bool(double)>& goOn) {
  DrawnSamples samples;
  constexpr std::size_t kSettings = kTimedSettings.size();
  samples.images.resize(rows.size() * kSettings);
  for (TimedImage& image : samples.images) image.ms = std::numeric_limits<double>::infinity();
  const auto of = [&](std::size_t row) {
    return std::span(samples.images).subspan(row * kSettings, kSettings);
  };
  const double steps = static_cast<double>(rows.size()) * (kRepeats + 1);
  std::size_t done = 0;
  // The quickest time of a row counts, and its times lie far apart: what another program takes for some
  // seconds spoils no row.
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    for (std::size_t r = 0; r < rows.size(); ++r) {
      timeImages(stage, rows[r], of(r));
      if (!goOn(static_cast<double>(++done) / steps)) return std::nullopt;
    }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    DrawnRow row;
    row.row = rows[r].row;
    compareCounts(rows[r], of(r), row);
    drawLosses(stage, kind, rows[r], row);
    samples.rows.push_back(row);
    if (!goOn(static_cast<double>(++done) / steps)) return std::nullopt;
  }
  std::erase_if(samples.images, [](const TimedImage& image) { return !std::isfinite(image.ms); });
  return samples;
}

std::string toJson(const DrawnSamples& samples) {
  Json rows = Json::array(), images = Json::array();
  for (const DrawnRow& row : samples.rows)
    rows.push_back({{"row", row.row},
                    {"drawn_hidden", row.drawnHidden},
                    {"drawn_open", row.drawnOpen},
                    {"at_rest", row.atRest},
                    {"error", row.error},
                    {"together", row.together},
                    {"small_kept", row.smallKept},
                    {"objects_kept", row.objectsKept},
                    {"air_kept", row.airKept},
                    {"instances", row.instances},
                    {"small_instances", row.smallInstances},
                    {"far_instances", row.farInstances}});
  for (const TimedImage& image : samples.images)
    images.push_back({{"row", image.row},
                      {"triangles", image.load.triangles},
                      {"ground_mpx", image.load.groundMpx},
                      {"scene_mpx", image.load.sceneMpx},
                      {"particles", image.load.particles},
                      {"blurs", image.load.blurs},
                      {"instances", image.instances},
                      {"looks_for_hidden", image.looksForHidden},
                      {"ms", image.ms},
                      {"repeats_ms", image.repeatsMs}});
  return Json{{"format", "trimtab-tune-samples"}, {"rows", rows}, {"images", images}}.dump(1) + '\n';
}

Result<DrawnSamples> parseSamples(std::string_view json, const std::string& where) {
  const Finding bad{Severity::error, where, "", "samples that a tuning run has written", "something else"};
  try {
    const Json document = Json::parse(json);
    if (document.at("format") != "trimtab-tune-samples") return bad;
    DrawnSamples samples;
    for (const Json& r : document.at("rows")) {
      DrawnRow row;
      row.row = r.at("row");
      row.drawnHidden = r.at("drawn_hidden");
      row.drawnOpen = r.at("drawn_open");
      row.atRest = r.at("at_rest");
      row.error = r.at("error").get<decltype(row.error)>();
      row.together = r.at("together").get<decltype(row.together)>();
      row.smallKept = r.at("small_kept").get<decltype(row.smallKept)>();
      row.objectsKept = r.at("objects_kept").get<decltype(row.objectsKept)>();
      row.airKept = r.at("air_kept").get<decltype(row.airKept)>();
      row.instances = r.at("instances");
      row.smallInstances = r.at("small_instances").get<decltype(row.smallInstances)>();
      row.farInstances = r.at("far_instances").get<decltype(row.farInstances)>();
      samples.rows.push_back(row);
    }
    for (const Json& i : document.at("images"))
      samples.images.push_back(
          {i.at("row"),
           {i.at("triangles"), i.at("ground_mpx"), i.at("scene_mpx"), i.at("particles"), i.at("blurs")},
           i.at("instances"),
           i.at("looks_for_hidden"),
           i.at("ms"),
           i.at("repeats_ms")});
    return samples;
  } catch (const Json::exception&) {
    return bad;
  }
}

}  // namespace trimtab::tune
