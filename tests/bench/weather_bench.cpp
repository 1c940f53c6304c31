#include <cmath>
#include <random>
#include <string>

#include "bench_scene.h"
#include "row.h"
#include "tests/shared_scene.h"
#include "tests/support.h"
#include "trimtab/preset/table.h"
#include "trimtab/weather/weather.h"
#include "weather_peer.h"

/// Group `weather`: what falls, in both forms, beside OpenSceneGraph's own effect, what fog costs, and the
/// fixed ratio against the adaptive one.

namespace trimtab::bench {
namespace {

void decisions(Report& report) {
  std::mt19937 random(5);
  std::vector<AircraftState> states(report.quick() ? 20'000 : 200'000);
  for (AircraftState& s : states) {
    s.weather = HostWeather{static_cast<Precipitation>(random() % 3), static_cast<int>(random() % 6), {}};
    if (random() % 2) s.visibility = Metres{500.0 + static_cast<double>(random() % 40'000)};
  }
  TuningParameters p = *defaultParameters();
  p.weather.source = WeatherSource::host;
  const auto seconds = leastSeconds(report.quick() ? 5 : 15, [&] {
    double sum = 0;
    for (const AircraftState& s : states) sum += decideWeather(s, p).extinctionPerM;
    keep(sum);
  });
  report.add(valueAtLeast(1e6, {.id = "weather.per_second",
                                .what = "weather decisions a second, of any host's weather",
                                .value = static_cast<double>(states.size()) / seconds,
                                .unit = "1/s"}));
}

/// The picture with what falls less the picture without, ours and theirs in turn over a sky. Both draw the
/// same drops; the effect as it ships shows far rain as points, ours as streaks.
void falling(Report& report) {
  BenchScene ours(nullptr);
  OsgPrecipitation theirs(BenchScene::kWidth, BenchScene::kHeight);
  if (!ours.ready() || !theirs.ready()) return;
  struct Case {
    const char* name;
    Precipitation kind;
    double density;
  };
  for (const Case& c : {Case{"rain_light", Precipitation::rain, 0.25}, Case{"rain", Precipitation::rain, 0.5},
                        Case{"rain_heavy", Precipitation::rain, 1.0}, Case{"snow", Precipitation::snow, 0.5},
                        Case{"snow_heavy", Precipitation::snow, 1.0}}) {
    auto dry = ours.request();
    dry.attitude.pitch = Degrees{0};
    double wet = 0;
    const Pairs pairs = inTurn(
        report.quick() ? 9 : 25,
        [&](int i) {
          auto r = dry;
          r.time = 10 + i / 60.0;
          const double without = ours.ms(r);
          r.decision.weather.precipitation = c.kind;
          r.decision.weather.density = c.density;
          r.precipitationForm = PrecipitationForm::effect;
          return ours.ms(r) - without;
        },
        [&](int i) {
          const double without = theirs.ms(c.kind, 0, 10 + i / 60.0);
          const double with = theirs.ms(c.kind, c.density, 10 + i / 60.0);
          wet = theirs.wetShare();
          return with - without;
        });
    Row row = rowOf(pairs, {.id = std::string("weather.") + c.name,
                            .what = "what " + std::string(c.name) + " adds to a frame, 1280 x 720, density " +
                                    std::to_string(c.density).substr(0, 4),
                            .peer = "osgParticle::PrecipitationEffect of the same density"});
    if (!(wet > 1e-4)) row.ratio = NAN;
    report.add(ratioAtMost(1, row));
  }
}

WeatherDecision decided(WeatherStep step, RatioMode mode) {
  TuningParameters p = *defaultParameters();
  p.weather.step = step;
  p.weather.ratioMode = mode;
  return decideWeather({}, p);
}

/// A layer of haze with all ground in it, seen from the benchmarks' eye.
WeatherDecision hazed(const BenchScene& bench, RatioMode mode) {
  TuningParameters p = *defaultParameters();
  p.weather.air = AirModel::layer;
  p.weather.layerTop = Metres{3000};
  p.weather.visibilityFrom = VisibilitySource::typed;
  p.weather.typedVisibility = Metres{8000};
  p.weather.ratioMode = mode;
  AircraftState state;
  state.position = bench.request().eye;
  return decideWeather(state, p, bench.highestGround());
}

void frames(Report& report, BenchScene& bench) {
  const int pairs = report.quick() ? 9 : 31;
  const auto frame = [&](const WeatherDecision& weather) {
    return [&bench, weather](int i) {
      auto r = bench.request();
      r.time = 10 + i / 60.0;
      r.eye.height = r.eye.height + Metres{0.01 * i};
      r.decision.weather = weather;
      r.levers.drawn.farM = r.decision.weather.farM;
      r.precipitationForm = PrecipitationForm::effect;
      return bench.ms(r);
    };
  };
  WeatherDecision fog = decided(WeatherStep::rain_light, RatioMode::off);
  fog.precipitation = Precipitation::none;
  fog.density = 0;
  const Pairs foggy = inTurn(pairs, frame(fog), frame({}));
  report.add(ratioAtMost(1.1, rowOf(foggy, {.id = "weather.fog",
                                            .what = "a frame in fog, nothing cut and nothing falling",
                                            .peer = "the same frame in clear air"})));
  const WeatherDecision whole = hazed(bench, RatioMode::off), cut = hazed(bench, RatioMode::adaptive);
  const Pairs layered = inTurn(pairs, frame(whole), frame({}));
  report.add(ratioAtMost(1.1, rowOf(layered, {.id = "weather.haze_layer",
                                              .what = "a frame in a layer of haze, nothing cut",
                                              .peer = "the same frame in clear air"})));
  const Pairs safe = inTurn(pairs, frame(cut), frame(whole));
  report.add(ratioAtMost(1, rowOf(safe, {.id = "weather.safe_cut",
                                         .what = "a frame in haze of 8 km, cut at the safe far distance of " +
                                                 std::to_string(static_cast<int>(cut.farM)) + " m",
                                         .peer = "the same frame without the cut"})));
  for (const auto& [name, step] : {std::pair{"rain_light", WeatherStep::rain_light},
                                   {"rain_medium", WeatherStep::rain_medium},
                                   {"rain_heavy", WeatherStep::rain_heavy}}) {
    const Pairs modes =
        inTurn(pairs, frame(decided(step, RatioMode::adaptive)), frame(decided(step, RatioMode::fixed)));
    report.add(ratioAtMost(1, rowOf(modes, {.id = std::string("weather.adaptive_") + name,
                                            .what = std::string("a frame in ") + name +
                                                    ", adaptive ratio as preset (not calibrated here)",
                                            .peer = "the same frame, fixed ratio"})));
  }
}

/// What the bounded form adds to a frame over Kansai, beside the clear frame and beside what the published
/// effect adds. Both fall in the same fog; dry frames in that fog are subtracted.
void bounded(Report& report) {
  constexpr const char* kKansai = "fg-kansai-e135n35";
  if (!std::filesystem::exists(test::sharedDir() / "data" / kKansai)) {
    std::cerr << "skipped: needs " << kKansai << " of the shared data\n";
    return;
  }
  const auto kansai = test::bakedOnce(kKansai);
  if (!kansai) {
    std::cerr << toString(kansai.findings());
    return;
  }
  BenchScene bench(*kansai);
  if (!bench.ready()) return;
  struct Case {
    const char* name;
    WeatherStep step;
    double ofClear, ofEffect;  ///< goals
  };
  for (const Case& c : {Case{"rain_light", WeatherStep::rain_light, 0.15, 0.1},
                        Case{"rain_heavy", WeatherStep::rain_heavy, 0.35, 0.2},
                        Case{"snow_light", WeatherStep::snow_light, 0.15, 0.1},
                        Case{"snow_heavy", WeatherStep::snow_heavy, 0.35, 0.2}}) {
    const WeatherDecision wet = decided(c.step, RatioMode::off);
    WeatherDecision dry = wet;
    dry.precipitation = Precipitation::none;
    dry.density = 0;
    const auto ms = [&](int i, const WeatherDecision& weather, PrecipitationForm form) {
      auto r = bench.request();
      r.eye = {Degrees{35.32}, Degrees{135.8958}, Metres{400 + 0.01 * i}};
      r.attitude.heading = Degrees{200};
      r.velocity = Velocity{MetresPerSecond{-60}, MetresPerSecond{-20}, MetresPerSecond{0}};
      r.time = 10 + i / 60.0;
      r.waitForPages = true;
      r.decision.weather = weather;
      r.levers.drawn.farM = r.decision.weather.farM;
      r.precipitationForm = form;
      return bench.ms(r);
    };
    const auto added = [&](PrecipitationForm form) {
      return [&ms, &wet, &dry, form](int i) {
        const double without = ms(i, dry, form);
        return ms(i, wet, form) - without;
      };
    };
    const int pairs = report.quick() ? 9 : 25;
    const Pairs beside = inTurn(pairs, added(PrecipitationForm::bounded), added(PrecipitationForm::effect));
    const Pairs ofClear = inTurn(pairs, added(PrecipitationForm::bounded),
                                 [&](int i) { return ms(i, {}, PrecipitationForm::bounded); });
    const std::string what = std::string("what ") + c.name + " of the bounded form adds, Kansai, 1280 x 720";
    report.add(ratioAtMost(c.ofClear, rowOf(ofClear, {.id = std::string("weather.bounded_") + c.name,
                                                      .what = what,
                                                      .peer = "the whole frame in clear air"})));
    report.add(
        ratioAtMost(c.ofEffect, rowOf(beside, {.id = std::string("weather.bounded_of_effect_") + c.name,
                                               .what = what,
                                               .peer = "what osgParticle::PrecipitationEffect adds to it"})));
  }
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  using namespace trimtab;
  bench::Report report(argc, argv);
  if (report.wants("decisions")) bench::decisions(report);
  if (report.wants("falling")) bench::falling(report);
  if (report.wants("bounded")) bench::bounded(report);
  const auto terrain = bench::sampleTerrain(40);
  if (!terrain) return 1;
  bench::BenchScene scene(terrain);
  if (report.wants("frames") && scene.ready()) bench::frames(report, scene);
  return report.finish();
}
