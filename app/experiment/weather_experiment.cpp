#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "published.h"
#include "stage.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/weather_cut_error.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/weather/calibrate.h"

namespace trimtab::experiment {
namespace {

constexpr std::array<double, 3> kVertices{100000, 120000, 140000};
constexpr double kWithin = 0.05;
constexpr double kEyeFt = 2000;
constexpr int kMostTrials = 6;
/// Particles fall as time goes on: frames are this far apart.
constexpr double kFrameS = 1.0 / 60;

struct Fall {
  const char* name;
  std::array<WeatherStep, 4> steps;
};
constexpr std::array<const char*, 4> kDensities{"clear", "light", "medium", "heavy"};
constexpr std::array<Fall, 2> kFalls{
    {{"rain",
      {WeatherStep::clear, WeatherStep::rain_light, WeatherStep::rain_medium, WeatherStep::rain_heavy}},
     {"snow",
      {WeatherStep::clear, WeatherStep::snow_light, WeatherStep::snow_medium, WeatherStep::snow_heavy}}}};

/// A view over the terrain whose weather can be changed.
class View {
 public:
  View(Stage& stage, const Setup& setup, const ValidatedParameters& parameters, const Place& place)
      : stage_(stage), repeats_(setup.repeats) {
    AircraftState state;
    state.position = place.ground;
    state.position.height = place.ground.height + Feet{kEyeFt}.as<Metres>();
    state.attitude = place.attitude;
    Session session(parameters);
    session.setGround(setup.terrain);
    session.look(state);
    request_ = *session.request(0, setup.widthPx, setup.heightPx);
    request_.decision.weather = {};
  }

  /// Of tiled levels and of static trees, whichever is drawn.
  void setError(double px) {
    request_.lod.screenSpaceError = Pixels{px};
    request_.staticLod.errorPx = Pixels{px};
  }
  double vertices() {
    request_.decision.weather = {};
    return double(stage_.draw(request_).visible.vertices);
  }

  double ms(const WeatherDecision& weather) {
    request_.decision.weather = weather;
    std::vector<double> ms;
    // What was just built, compiled or grown is no frame's cost.
    constexpr int kUncounted = 3;
    for (int i = 0; i < kUncounted + repeats_; ++i) {
      request_.time += kFrameS;
      const double total = stage_.draw(request_).cost.total;
      if (i >= kUncounted) ms.push_back(total);
    }
    return quantileOf(ms, 0.5);
  }

  scene::CutError cutError(const WeatherDecision& weather) {
    request_.decision.weather = weather;
    return stage_.cutError(request_);
  }

 private:
  Stage& stage_;
  int repeats_;
  FrameRequest request_;
};

/// The screen-space error at which so many vertices are in view, by halving; vertices fall as it grows.
double errorFor(View& view, double vertices, double& reached) {
  double fine = std::log(0.05), coarse = std::log(64.0), error = 0;
  for (int i = 0; i < 24; ++i) {
    error = std::exp((fine + coarse) / 2);
    view.setError(error);
    reached = view.vertices();
    if (std::abs(reached / vertices - 1) < kWithin / 10) break;
    (reached > vertices ? fine : coarse) = std::log(error);
  }
  return error;
}

/// From corner to corner of the terrain: a cut there cuts nothing.
double farthest(const Setup& setup) {
  const terrain::TerrainInfo& info = setup.terrain->info();
  return length(toEcef(info.northEast) - toEcef(info.southWest));
}

WeatherDecision weatherOf(const TuningParameters& parameters, WeatherStep step, RatioMode mode) {
  TuningParameters changed = parameters;
  changed.weather.source = WeatherSource::preset;
  changed.weather.step = step;
  changed.weather.ratioMode = mode;
  return decideWeather({}, changed);
}

Plot plotOf(const Table& table, const char* fall) {
  Plot plot{std::string("weather-") + fall,
            std::string("Frame rate in ") + fall + ", fixed ratio against adaptive",
            "vertices in view, density",
            "frame rate (1/s)",
            {},
            {{"fixed ratio", {}, {}}, {"adaptive", {}, {}}}};
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (table.text(row, "precipitation") != fall) continue;
    char text[48];
    std::snprintf(text, sizeof text, "%.0fk %s", table.number(row, "vertices") / 1000,
                  table.text(row, "density").c_str());
    plot.categories.push_back(text);
    plot.series[0].y.push_back(table.number(row, "fps_fixed_ratio"));
    plot.series[1].y.push_back(table.number(row, "fps_adaptive"));
  }
  return plot;
}

}  // namespace

Result<Report> runWeather(const Setup& setup) {
  TuningParameters plain = setup.parameters;
  plain.motion.control = MotionControl::off;
  const Result<ValidatedParameters> parameters = validate(plain);
  if (!parameters) return parameters.findings();
  auto stage = Stage::open(setup);
  if (!stage) return stage.findings();
  const std::vector<Place> places = placesOf(setup, 1);
  if (places.empty()) return notOverTerrain(setup);

  Report report{"weather", "D: frame rates with weather", (*stage)->machine(), publishedWeather(), {}, {},
                {}};
  report.measured.columns = {"vertices",
                             "precipitation",
                             "density",
                             "fps_fixed_ratio",
                             "fps_adaptive",
                             "frame_ms_uncut",
                             "frame_ms",
                             "frame_ms_ratio",
                             "far_km",
                             "visibility_km",
                             "density_that_fits",
                             "cut_changed_pixels",
                             "cut_largest_of_255",
                             "outcome"};
  View view(**stage, setup, *parameters, places[0]);
  const double runs = double(kVertices.size() * kFalls.size() * kDensities.size());
  double done = 0;
  for (const double wanted : kVertices) {
    if (setup.progress && !setup.progress(done / runs, "finding the view")) return cancelled();
    double reached = 0;
    const double error = errorFor(view, wanted, reached);
    if (std::abs(reached / wanted - 1) > kWithin) {
      char note[160];
      std::snprintf(note, sizeof note,
                    "%.0f vertices could not be reached: the terrain gives %.0f at %.2g px.", wanted, reached,
                    error);
      report.notes.push_back(note);
    }
    for (const Fall& fall : kFalls)
      for (std::size_t d = 0; d < kDensities.size(); ++d, ++done) {
        char what[96];
        std::snprintf(what, sizeof what, "%.0f vertices, %s, %s", reached, fall.name, kDensities[d]);
        if (setup.progress && !setup.progress(done / runs, what)) return cancelled();
        const double clearMs = view.ms({});
        if (d == 0) {
          report.measured.rows.push_back({reached, fall.name, "clear", 1000 / clearMs, 1000 / clearMs,
                                          clearMs, clearMs, 1.0, Cell(), Cell(), Cell(), 0.0, 0.0,
                                          "nothing falls, nothing is cut"});
          continue;
        }
        const WeatherStep step = fall.steps[d];
        const double fixedMs = view.ms(weatherOf(plain, step, RatioMode::fixed));
        CalibrationSettings settings;
        settings.tolerance = plain.weather.tolerance.value();
        settings.repeats = 1;  // a view's measurement is a median already
        settings.mostTrials = kMostTrials;
        settings.farthestM = farthest(setup);
        const auto found = calibrateStep(
            step, plain,
            [&](const WeatherDecision& weather) -> std::optional<double> {
              if (setup.progress && !setup.progress(done / runs, what)) return std::nullopt;
              return view.ms(weather);
            },
            settings);
        if (!found) return cancelled();
        // Where no cut wins back what falls, the strongest cut at the preset's density is what the mode can
        // do.
        const bool tooMuch = found->outcome == CalibrationOutcome::cut_not_enough ||
                             found->outcome == CalibrationOutcome::fog_not_enough;
        const double ms = tooMuch ? found->strongestMs : found->matchedMs;
        TuningParameters tuned = plain;
        if (tooMuch)
          stepParameters(tuned, step)->farStretch = Ratio{1};
        else
          apply(*found, tuned);
        const WeatherDecision weather = weatherOf(tuned, step, RatioMode::adaptive);
        const scene::CutError lost = view.cutError(weather);
        report.measured.rows.push_back({reached, fall.name, kDensities[d], 1000 / fixedMs, 1000 / ms,
                                        found->uncutMs, ms, ms / found->clearMs, weather.farM / 1000,
                                        weather.visibilityM / 1000, found->density, double(lost.changed),
                                        double(lost.largest), std::string(toText(found->outcome))});
      }
  }
  char text[320];
  std::snprintf(
      text, sizeof text,
      "%s, preset %s, %d x %d, %.0f ft above the highest ground within 2 km; the vertices are reached by the "
      "screen-space error. Fixed ratio: %.3g. Adaptive: calibrated for each row to the clear frame's time, "
      "within %.0f %%.",
      setup.terrainName.c_str(), setup.presetName.c_str(), setup.widthPx, setup.heightPx, kEyeFt,
      plain.weather.fixedRatio.value(), plain.weather.tolerance.value() * 100);
  report.notes.insert(report.notes.begin(), text);
  report.notes.push_back(
      "frame_ms_ratio is to the clear frame measured just before. Where the outcome says that the cut is not "
      "enough, what "
      "falls costs more than the whole terrain: density_that_fits is what this machine can show.");
  report.notes.push_back(
      "cut_changed_pixels counts pixels that the far cut changed in the fogged picture, of 255.");
  for (const Fall& fall : kFalls) report.plots.push_back(plotOf(report.measured, fall.name));
  return report;
}

}  // namespace trimtab::experiment
