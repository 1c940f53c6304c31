#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>

#include "tests/core/hold/formula_machine.h"
#include "tests/core/scene/objects/objects_on.h"
#include "tests/core/scene/scene_test.h"
#include "tests/core/scene/terrain/patched_terrain.h"
#include "tests/core/scene/terrain/steep_roofs.h"
#include "tests/core/scene/terrain/synthetic_trees.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/host/encoder.h"
#include "trimtab/host/received_state.h"
#include "trimtab/motion/head_motion.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/weather/calibrate.h"

/// Every parameter has an effect: changed, it changes a decision, a picture or a count. A plot of the
/// parameter itself would not count, so nothing here reads one.
namespace trimtab {
namespace {

using Settings = std::vector<std::pair<std::string, std::string>>;

/// What a run left behind, by what it is: two runs differ where any entry does.
using Observed = std::map<std::string, std::string>;

std::string digest(std::span<const std::uint8_t> bytes) {
  std::uint64_t sum = 1469598103934665603ull;
  for (const std::uint8_t byte : bytes) sum = (sum ^ byte) * 1099511628211ull;
  return std::to_string(sum);
}

/// The packets of half a minute: level and steep, low and high, the head still and sweeping, weather and view
/// of the host's own.
std::vector<AircraftState> packets(const GeodeticPosition& from) {
  std::vector<AircraftState> states;
  for (int i = 0; i < 72; ++i) {
    AircraftState state;
    state.time = i / 60.0;
    state.packet = static_cast<std::uint64_t>(i) + 1;
    state.position = from;
    state.position.latitude = from.latitude + Degrees{i * 2e-5};
    // 2,500 to 9,600 ft, and slowly enough around one band's edge that hysteresis is seen.
    state.position.height = Feet{i < 36 ? 2500.0 + i * 200 : 4480.0 + (i % 6) * 15}.as<Metres>();
    state.aboveGround = state.position.height - Metres{300};
    state.attitude = {Degrees{20}, Degrees{i < 36 ? -35.0 + i * 2 : -2.0 + (i % 6)}, Degrees{i % 12 * 2.0}};
    const double sweep = i < 12 ? 0 : i < 40 ? (i - 12) * 3.0 : 84;
    state.head = Attitude{Degrees{sweep}, Degrees{-5}, {}};
    if (i >= 30) state.time += 0.2;  // a gap
    state.velocity = Velocity{MetresPerSecond{94}, MetresPerSecond{34}, MetresPerSecond{5}};
    state.visibility = Metres{8000};
    state.weather = HostWeather{};
    state.weather->precipitation = Precipitation::rain;
    state.weather->severity = 3;
    state.weather->visibility = Metres{6000};
    state.view = HostView{Metres{3}, Degrees{-20}, Degrees{20}, Degrees{-12}, Degrees{12}};
    states.push_back(state);
  }
  return states;
}

class ParameterEffects : public test::SceneTest {
 protected:
  void SetUp() override {
    SceneTest::SetUp();
    if (!offscreen) return;
    const auto trees = std::make_shared<test::TreeTerrain>(std::make_shared<const test::SyntheticTerrain>(
        4, 1.0 / 1200, GeodeticPosition{Degrees{36.4}, Degrees{128.1}, Metres{0}}, test::mountains));
    const auto objects = test::scattered(*trees, 1000, 4, 8, 3);
    test::lightEach(*objects, Metres{100});
    use(std::make_shared<test::ObjectsOn>(trees, objects));
  }

  // Named in the table of scenarios.
 public:
  static TuningParameters with(const Settings& settings) {
    TuningParameters parameters;
    for (const auto& [key, text] : settings) {
      const ParameterRow* row = findRow(key);
      if (!row) throw std::invalid_argument(key);
      row->set(parameters, *parseValue(*row, text));
    }
    return parameters;
  }

  /// Decided packet by packet; some are drawn.
  Observed fly(const ValidatedParameters& parameters) {
    Session session(parameters);
    session.setGround(database);
    Observed seen;
    const Metres highest = *database->highestWithin(database->index().frame.origin().latitude,
                                                    database->index().frame.origin().longitude, Metres{1e5});
    int i = 0;
    for (const AircraftState& state : packets(over(0.5, 0.2, 0))) {
      session.fly(state);
      seen["decision " + std::to_string(i)] =
          explain(session.decision(), parameters) +
          std::to_string(leversOf(session.decision(), *parameters).drawn.lodScale) +
          std::to_string(session.decision().motion.blur.strength) +
          std::to_string(session.decision().motion.blur.remainingMs);
      if (i % 18 == 11) {
        FrameRequest request = *session.request(state.time, 192, 108);
        // The decision is the packet's; the eye stays near the ground, where there is something to see.
        const Metres ground = *database->heightAt(request.eye.latitude, request.eye.longitude);
        request.eye.height = i == 29 ? ground + Metres{20} : highest + Metres{200};
        request.attitude.pitch = Degrees{-8};
        request.waitForPages = request.reproducible = true;
        static const auto kHostSymbols = std::make_shared<const HostSymbols>(exampleSymbols(0));
        if (request.symbology) request.symbology->host = kHostSymbols;
        FrameResult result;
        seen["picture " + std::to_string(i)] = digest(picture(request, &result));
        seen["counts " + std::to_string(i)] = std::to_string(result.visible.triangles) + ' ' +
                                              (result.horizon    ? "horizon"
                                               : result.depthMap ? std::to_string(result.depthMap->widthPx)
                                                                 : "-") +
                                              ' ' + std::to_string(result.paging.heldBack) + ' ' +
                                              std::to_string(result.visible.occluded) + ' ' +
                                              std::to_string(result.visible.backFacing);
        result.cost = {0, 1, 1, 1, 20, 0, 23};  // the clock is no effect
        session.finished(result, state.time);
      }
      ++i;
    }
    seen["over budget"] = std::to_string(session.overBudget());
    return seen;
  }

  /// The same over patches that take some 40 MB: ground so rough that every post counts.
  Observed flyOverPatches(const ValidatedParameters& parameters) {
    static const auto rough = [] {
      std::mt19937 random(5);
      std::uniform_real_distribution<float> height(0, 800);
      terrain::HeightGrid grid;
      grid.posts = {128.1, 36.4, 1.0 / 1200, 1.0 / 1200, 385, 385};
      for (std::size_t i = 0; i < grid.posts.size(); ++i) grid.heights.push_back(height(random));
      return std::make_shared<const test::PatchedTerrain>(std::move(grid), nullptr, false);
    }();
    return flyOver(rough, parameters);
  }

  /// The same over ground so steep that much of it shows its back.
  Observed flyOverRoofs(const ValidatedParameters& parameters) {
    static const auto roofs = std::make_shared<const test::SyntheticTerrain>(
        8, 1.0 / 1200, GeodeticPosition{Degrees{46.2}, Degrees{7.4}, Metres{0}}, test::steepRoofs);
    return flyOver(roofs, parameters);
  }

  Observed flyOverTexture(const ValidatedParameters& parameters) {
    static const auto textured = test::patchedMountains(true);
    return flyOver(textured, parameters);
  }

  Observed flyOver(std::shared_ptr<const terrain::Database> terrain, const ValidatedParameters& parameters) {
    const auto before = database;
    use(std::move(terrain));
    const Observed seen = fly(parameters);
    use(before);
    return seen;
  }

  /// The same packets over a link, with a silence at the end.
  Observed listen(const ValidatedParameters& parameters) {
    Session session(parameters);
    HostDecoder decoder(HostChoice(parameters->host));
    Observed seen;
    double now = 1000;
    for (const AircraftState& state : packets(over(0.5, 0.2, 0))) {
      const std::vector<std::byte> bytes = encodeCigiHost(state, static_cast<std::uint32_t>(state.packet), 0);
      const auto decoded = decoder.accept({bytes, now, "127.0.0.1:1"});
      if (decoded) session.receive(std::vector{ReceivedState{*decoded, now, now}});
      now += 1 / 60.0;
    }
    seen["bad"] = std::to_string(decoder.statistics().bad);
    if (session.hasState()) {
      seen["head"] = session.input().state.head ? "followed" : "ignored";
      seen["eye"] = std::to_string(session.eyeState(now + 0.02).position.latitude.value() * 1e6);
      for (int ms = 0; ms < 1000; ms += 50)
        seen["link " + std::to_string(ms)] = std::string(toText(session.linkState(now + ms * 1e-3)));
    }
    return seen;
  }

  /// Drawn twice for each packet, with 40,000 vertices in each image.
  Observed listenAndDraw(const ValidatedParameters& parameters) {
    Session session(parameters);
    Observed seen;
    double now = 1000;
    for (const AircraftState& state : packets(over(0.5, 0.2, 0))) {
      session.receive(std::vector{ReceivedState{state, now, now}});
      for (int image = 0; image < 2; ++image, now += 1 / 120.0) {
        FrameResult result;
        result.visible.vertices = 40000;
        const auto request = session.request(now, 192, 108);
        seen["decision " + std::to_string(now)] = explain(request->decision.motion);
        session.finished(result, now + 1e-3);
      }
    }
    return seen;
  }

  /// A budget held over a sweeping head in heavy rain, on a machine that becomes faster.
  Observed holdBudget(const ValidatedParameters& parameters) {
    static const CostModel slow = test::formulaMachine(1), fast = test::formulaMachine(0.4);
    Session session(parameters);
    session.setGround(database);
    session.setLoadIndex(scene::loadIndexOf(database));
    Observed seen;
    AircraftState state = packets(over(0.5, 0.2, 0)).front();
    state.weather->severity = 5;
    for (int i = 0; i < 150; ++i) {
      state.time = i / 60.0;
      state.head = Attitude{Degrees{3.0 * std::clamp(i - 40, 0, 40)}, Degrees{-5}, {}};
      session.hold().model() = i < 90 ? slow : fast;
      session.fly(state);
      const FrameRequest request = *session.request(state.time, 640, 360);
      seen["hold " + std::to_string(i)] = explain(request.hold);
      FrameResult result;
      result.visible.triangles = static_cast<std::uint64_t>(12e4 / request.levers.drawn.errorPx);
      result.cost = {0, 1, 1, 1, 20, 0, 23};  // the clock is no effect
      session.finished(result, state.time);
    }
    return seen;
  }

  /// Document D's calibration on a cost that rises with the far plane and the density.
  static Observed calibrate(const ValidatedParameters& parameters) {
    Observed seen;
    CalibrationSettings settings;
    settings.tolerance = parameters->weather.tolerance.value();
    const auto found = calibrateStep(
        WeatherStep::rain_light, *parameters,
        [](const WeatherDecision& w) -> std::optional<double> {
          return 2 + 8 * std::min(w.farM, 60e3) / 60e3 + 2 * w.density;
        },
        settings);
    seen["far"] = std::to_string(found->farM);
    return seen;
  }
};

/// Other values of a row, likely ones first.
std::vector<ParameterValue> otherValues(const ParameterRow& row, const ParameterValue& now) {
  std::vector<ParameterValue> values;
  switch (row.kind) {
    case Kind::scalar: {
      const double value = std::get<double>(now);
      const auto tidy = [&row](double v) { return row.whole ? std::round(v) : v; };
      for (const double v : {value * 2, value / 2, row.usual.high, row.usual.low, value + row.step,
                             (row.usual.low + row.usual.high) / 2})
        if (tidy(v) != value && tidy(v) >= row.hard.low && tidy(v) <= row.hard.high)
          values.emplace_back(tidy(v));
      break;
    }
    case Kind::flag:
      values.emplace_back(!std::get<bool>(now));
      break;
    case Kind::choice:
      for (std::size_t i = 0; i < row.choices.size(); ++i)
        if (i != std::get<ChoiceIndex>(now).index) values.emplace_back(ChoiceIndex{i});
      break;
    case Kind::curve: {
      CurvePoints curve = std::get<CurvePoints>(now);
      for (std::size_t i = 0; i < curve.size; ++i) curve.point[i].y *= 0.5;
      values.emplace_back(curve);
      break;
    }
    case Kind::bands: {
      BandList bands = std::get<BandList>(now);
      bands.band[bands.size - 1].widthPx /= 2;
      values.emplace_back(bands);
      bands.size = 1;
      values.emplace_back(bands);
      break;
    }
    case Kind::lines: {
      TextLines lines = std::get<TextLines>(now);
      for (std::string& line : lines.line)
        for (const auto& [from, to] : {std::pair{" and ", " or "}, std::pair{"2000", "9000"}})
          if (const std::size_t at = line.find(from); at != std::string::npos)
            line.replace(at, std::string(from).size(), to);
      values.emplace_back(lines);
      break;
    }
  }
  return values;
}

TEST_F(ParameterEffects, everyParameterChangesADecisionAPictureOrACount) {
  // Settings under which a parameter counts at all: what reads it is switched on.
  struct Scenario {
    std::string prefixes;  ///< space-separated; of the keys that it is for
    Settings settings;
    Observed (ParameterEffects::*run)(const ValidatedParameters&) = &ParameterEffects::fly;
  };
  const std::vector<Scenario> scenarios{
      {"fuzzy. culling. lod. objects. view. motion. static_lod. symbology. weather.source weather.step "
       "weather.haze "
       "measure.",
       {}},
      {"fuzzy.altitude", {{"fuzzy.altitude.reading", "equation_a"}}},
      {"fuzzy.altitude", {{"fuzzy.altitude.reference", "above_ground"}}},
      {"fuzzy.pitch", {{"fuzzy.pitch.reading", "rounded_step"}}},
      {"view.", {{"view.render_size", "fixed"}, {"view.width_px", "160"}, {"view.height_px", "96"}}},
      {"view.", {{"view.source", "host"}}},
      {"motion.",
       {{"motion.blur_frames", "3"}, {"motion.left_fov_deg", "30"}, {"motion.right_fov_deg", "30"}}},
      {"motion.", {{"motion.dwell", "milliseconds"}, {"motion.blur_dwell_ms", "50"}}},
      {"lod.level_spread", {{"lod.level_spread", "0.6"}, {"lod.scale", "4"}}},
      {"policy.",
       {{"policy.enabled", "true"},
        {"policy.terms", "altitude low = ramp 30000 -2000 | pitch up = ramp -90 90"},
        {"policy.rules",
         "if altitude is low and pitch is up then lod_scale = 4 | if altitude is any then lod_scale = 1"}}},
      {"hold. measure.",
       {{"hold.enabled", "true"}, {"weather.source", "host"}},
       &ParameterEffects::holdBudget},
      {"hold.error hold.loss_error",
       {{"hold.enabled", "true"}, {"weather.source", "host"}, {"hold.loss_error", "0.001"}},
       &ParameterEffects::holdBudget},
      {"hold.caution",
       {{"hold.enabled", "true"},
        {"weather.source", "host"},
        {"hold.margin", "0"},
        {"measure.budget_ms", "6"}},
       &ParameterEffects::holdBudget},
      {"lod.texture", {{"terrain.form", "patches"}, {"lod.scale", "4"}}, &ParameterEffects::flyOverTexture},
      {"motion.frames", {}, &ParameterEffects::listenAndDraw},
      {"motion.lod_over",
       {{"motion.frames", "drawn"}, {"motion.left_fov_deg", "15"}},
       &ParameterEffects::listenAndDraw},
      {"static_lod.", {{"terrain.form", "static_trees"}}},
      {"terrain.form", {{"terrain.form", "static_trees"}}},
      {"static_lod.", {{"terrain.form", "static_trees"}, {"static_lod.rule", "factor"}}},
      {"terrain.",
       {{"terrain.form", "patches"}, {"terrain.cache_mb", "16"}, {"lod.screen_space_error_px", "0.25"}},
       &ParameterEffects::flyOverPatches},
      {"culling.back", {}, &ParameterEffects::flyOverRoofs},
      {"symbology. symbol", {{"symbology.enabled", "true"}}},
      {"symbology.host.", {{"symbology.enabled", "true"}, {"symbology.host.recolour", "true"}}},
      {"weather.haze weather.clear weather.contrast weather.ratio weather.default",
       {{"weather.haze", "true"}, {"weather.clear_visibility_m", "5000"}}},
      {"weather.rain_light.", {{"weather.step", "rain_light"}, {"weather.clear_visibility_m", "8000"}}},
      {"weather.rain_medium.", {{"weather.step", "rain_medium"}, {"weather.clear_visibility_m", "16000"}}},
      {"weather.rain_heavy.", {{"weather.step", "rain_heavy"}, {"weather.clear_visibility_m", "40000"}}},
      {"weather.snow_light.", {{"weather.step", "snow_light"}, {"weather.clear_visibility_m", "16000"}}},
      {"weather.snow_medium.", {{"weather.step", "snow_medium"}, {"weather.clear_visibility_m", "40000"}}},
      {"weather.snow_heavy.", {{"weather.step", "snow_heavy"}, {"weather.clear_visibility_m", "90000"}}},
      {"weather.rain. weather.wind weather.precipitation",
       {{"weather.step", "rain_heavy"},
        {"weather.clear_visibility_m", "40000"},
        {"weather.wind_speed_mps", "15"}}},
      {"weather.snow.", {{"weather.step", "snow_heavy"}, {"weather.clear_visibility_m", "90000"}}},
      {"weather.visibility weather.typed weather.contrast",
       {{"weather.step", "rain_light"},
        {"weather.visibility_from", "typed"},
        {"weather.typed_visibility_m", "4000"}}},
      {"weather.air weather.layer",
       {{"weather.air", "layer"},
        {"weather.layer_top_m", "1500"},
        {"weather.visibility_from", "typed"},
        {"weather.typed_visibility_m", "4000"}}},
      {"weather.fixed weather.default weather.ratio",
       {{"weather.step", "rain_light"}, {"weather.ratio_mode", "fixed"}, {"weather.fixed_ratio", "0.0003"}}},
      {"weather.severity", {{"weather.source", "host"}}},
      {"weather.tolerance", {}, nullptr},
      {"host.", {}, &ParameterEffects::listen},
  };

  std::vector<std::optional<Observed>> before(scenarios.size());
  std::set<std::string> without;
  for (const ParameterRow& row : parameterRows()) {
    bool effective = false;
    for (std::size_t s = 0; s < scenarios.size() && !effective; ++s) {
      const Scenario& scenario = scenarios[s];
      std::istringstream prefixes(scenario.prefixes);
      bool meant = false;
      for (std::string prefix; prefixes >> prefix;) meant = meant || row.key.starts_with(prefix);
      if (!meant) continue;
      const auto observe = [&](const ValidatedParameters& parameters) {
        return scenario.run ? (this->*scenario.run)(parameters) : calibrate(parameters);
      };
      const TuningParameters base = with(scenario.settings);
      const auto valid = validate(base);
      ASSERT_TRUE(valid) << scenario.prefixes << toString(valid.findings());
      if (!before[s]) {
        before[s] = observe(*valid);
        const Observed again = observe(*valid);
        for (const auto& [what, text] : again)
          ASSERT_EQ(text, (*before[s])[what]) << "the same again: " << scenario.prefixes << ", " << what;
      }
      for (const ParameterValue& value : otherValues(row, row.get(base))) {
        TuningParameters changed = base;
        row.set(changed, value);
        const auto other = validate(changed);
        if (!other) continue;
        if (observe(*other) != *before[s]) {
          effective = true;
          break;
        }
      }
    }
    if (!effective) without.insert(std::string(row.key));
  }
  EXPECT_EQ(without, std::set<std::string>{});
}

TEST_F(ParameterEffects, everyWayToHiddenGroundDoesWorkOfItsOwn) {
  use(test::syntheticMountains());
  const ParameterRow& row = *findRow("culling.occlusion");
  const auto workOf = [](const FrameResult& r) {
    return std::array{r.counters.horizonsBuilt + r.counters.horizonsMoved, r.counters.depthMapsDrawn};
  };
  std::map<decltype(workOf({})), std::vector<std::string_view>> ways;  // by their work
  std::set<std::string> pictures;
  for (const auto& way : row.choices) {
    const auto parameters = validate(with({{"culling.occlusion", std::string(way.name)}}));
    ASSERT_TRUE(parameters) << toString(parameters.findings());
    Session session(*parameters);
    session.setGround(database);
    FrameResult result;
    renderer.setTerrain(database);  // what an earlier way left is no work of this one
    picture(request(over(0.5, 0.5, 6000), {}), &result);
    auto work = workOf(result);
    session.fly(packets(over(0.5, 0.5, 0)).front());
    FrameRequest low = *session.request(0, 192, 108);
    ASSERT_TRUE(low.levers.drawn.occlusion);
    low.eye = over(0.5, 0.5, 60);
    low.attitude = {Degrees{40}, Degrees{-3}, Degrees{0}};
    low.waitForPages = low.reproducible = true;
    pictures.insert(digest(picture(low, &result)));
    const auto now = workOf(result);
    for (std::size_t k = 0; k < now.size(); ++k) work[k] = now[k] - work[k];
    ways[work].push_back(way.name);
  }
  // Where counts depend on no clock, the automatic way is the horizon's.
  EXPECT_EQ(ways.size() + 1, row.choices.size()) << ::testing::PrintToString(ways);
  EXPECT_EQ(pictures.size(), 1u) << "none changes a pixel";
}

}  // namespace
}  // namespace trimtab
