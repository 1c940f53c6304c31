#include "drawn_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "trimtab/measure/image_error.h"
#include "trimtab/scene/error_meter.h"

namespace trimtab::tune {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kRepeats = 3;
/// Losses are drawn at this part of the width and height.
constexpr double kSmall = 0.5;

/// Settings that an image is timed at, so that what it costs by triangle, by pixel and for looking for hidden
/// ground can be told apart.
struct TimedSetting {
  double groundPx, objectPx, smallPx, renderScale;
  bool looksForHidden;
};
constexpr std::array kTimedSettings{
    TimedSetting{1, 1, 0, 1, true},   TimedSetting{4, 4, 0, 1, true},   TimedSetting{16, 16, 8, 1, true},
    TimedSetting{2, 8, 2, 1, true},   TimedSetting{8, 2, 0, 0.5, true}, TimedSetting{4, 4, 4, 0.7, true},
    TimedSetting{16, 16, 0, 1, true}, TimedSetting{4, 4, 0, 1, false},
};
/// The largest depth map of the shipped presets; looking for hidden ground costs most there.
constexpr OcclusionResolution kLooking{800, 600};

/// Returns the image with every lever at rest: no error to speak of, everything drawn.
FrameRequest atRest(FrameRequest request) {
  FrameLevers& levers = request.levers.drawn;
  levers.lodScale = levers.levelSpread = levers.renderScale = levers.particleShare = 1;
  levers.errorPx = levers.objectErrorPx = kLossValues[0][0] / 2;
  levers.blurStrength = levers.smallFeaturePx = 0;
  levers.objectFarM = WeatherDecision::kUnlimited;
  levers.farM = request.levers.weather.farM;
  levers.occlusion = kLooking;
  request.hold = {};
  request.symbology.reset();
  return request;
}

/// Returns the image with one lever moved; nothing if it moves nothing in this image.
std::optional<FrameRequest> moved(FrameRequest request, Loss loss, double value) {
  FrameLevers& levers = request.levers.drawn;
  switch (loss) {
    case Loss::ground_error:
      levers.errorPx = value;
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
      if (!std::isfinite(levers.farM)) return std::nullopt;
      levers.farM *= value;
      break;
    case Loss::particles:
      if (fallsNow(request).kind == Precipitation::none) return std::nullopt;
      levers.particleShare = value;
      break;
  }
  return request;
}

/// Returns the same image at a part of its size, with the levels of the whole one.
FrameRequest small(FrameRequest request) {
  request.imagePxPerRadian = errorPxPerRadian(request);
  request.view = scaledShape(request.view, kSmall);
  return request;
}

bool movesObjects(Loss loss) {
  return loss == Loss::object_error || loss == Loss::small_feature || loss == Loss::object_distance;
}

void drawLosses(experiment::Stage& stage, const FrameRequest& request, DrawnRow& row) {
  const FrameRequest rest = small(atRest(request));
  const std::vector<std::uint8_t> reference = stage.pixels(scene::referenceOf(rest));
  const FrameResult finest = stage.draw(rest);
  const auto lost = [&] {
    return flip(reference, stage.shown(), rest.view.widthPx, rest.view.heightPx, {},
                kSmall * kFlipPixelsPerDegree);
  };
  row.flipAtRest = lost();
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
    if (movesObjects(loss) && finest.objects.all() == 0) continue;
    auto* const kept = keptOf(loss);
    auto* const instances = loss == Loss::small_feature     ? &row.smallInstances
                            : loss == Loss::object_distance ? &row.farInstances
                                                            : nullptr;
    const double all = trianglesOf(finest, loss);
    for (std::size_t step = 0; step < kLossSteps; ++step) {
      if (step > 0 && kLossValues[l][step] == kLossValues[l][step - 1]) {
        row.flip[l][step] = row.flip[l][step - 1];
        for (auto* parts : {kept, instances})
          if (parts) (*parts)[step] = (*parts)[step - 1];
        continue;
      }
      const std::optional<FrameRequest> image = moved(rest, loss, kLossValues[l][step]);
      if (!image) break;
      const FrameResult drawn = stage.draw(*image);
      if (kept && all > 0) (*kept)[step] = trianglesOf(drawn, loss) / all;
      if (instances && row.instances > 0)
        (*instances)[step] = static_cast<double>(drawn.objects.drawn) / row.instances;
      row.flip[l][step] = std::max(lost() - row.flipAtRest, 0.0);
    }
  }
}

FrameRequest timed(FrameRequest request, const TimedSetting& setting) {
  request = atRest(std::move(request));
  FrameLevers& levers = request.levers.drawn;
  levers.errorPx = setting.groundPx;
  levers.objectErrorPx = setting.objectPx;
  levers.smallFeaturePx = setting.smallPx;
  levers.renderScale = setting.renderScale;
  if (!setting.looksForHidden) levers.occlusion.reset();
  return request;
}

/// Times the settings of one row once. Each image follows the one before it, as in flight; the first turn
/// makes what the second finds.
void timeImages(experiment::Stage& stage, const SampleRow& sample, std::span<TimedImage> images) {
  for (std::size_t s = 0; s < kTimedSettings.size(); ++s) {
    const TimedSetting& setting = kTimedSettings[s];
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
                  falls.kind != Precipitation::none ? falls.amount : 0, false};
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
    if (counted > 0 && setting.smallPx == 0)
      (setting.looksForHidden ? hidden : open).push_back(images[s].load.triangles / counted);
  }
  if (!hidden.empty()) row.drawnHidden = experiment::quantileOf(hidden, 0.5);
  if (!open.empty()) row.drawnOpen = experiment::quantileOf(open, 0.5);
}

}  // namespace

std::optional<DrawnSamples> drawSamples(experiment::Stage& stage, std::span<const SampleRow> rows,
                                        const std::function<bool(double)>& goOn) {
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
    row.groundMpx = rows[r].groundMpx;
    compareCounts(rows[r], of(r), row);
    drawLosses(stage, rows[r].request, row);
    samples.rows.push_back(row);
    if (!goOn(static_cast<double>(++done) / steps)) return std::nullopt;
  }
  return samples;
}

std::string toJson(const DrawnSamples& samples) {
  Json rows = Json::array(), images = Json::array();
  for (const DrawnRow& row : samples.rows)
    rows.push_back({{"row", row.row},
                    {"ground_mpx", row.groundMpx},
                    {"flip_at_rest", row.flipAtRest},
                    {"drawn_hidden", row.drawnHidden},
                    {"drawn_open", row.drawnOpen},
                    {"flip", row.flip},
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
      row.groundMpx = r.at("ground_mpx");
      row.flipAtRest = r.at("flip_at_rest");
      row.drawnHidden = r.at("drawn_hidden");
      row.drawnOpen = r.at("drawn_open");
      row.flip = r.at("flip").get<decltype(row.flip)>();
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
           {i.at("triangles"), i.at("ground_mpx"), i.at("scene_mpx"), i.at("particles"), false},
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
