#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/experiment/leverage.h"
#include "app/experiment/stage.h"
#include "app/harness/flown_frames.h"
#include "bench_scene.h"
#include "policy_flights.h"
#include "row.h"
#include "tests/shared_scene.h"
#include "tests/support.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/preset/preset.h"
#include "trimtab/scene/error_meter.h"

/// Group `policies`: each policy that ships against the best single fixed setting of the same levers, on
/// flights that it was not made on. The flights that the policies were tuned on are in the results page.

namespace trimtab::bench {
namespace {

using harness::FlownFrame;

constexpr int kWidth = 960, kHeight = 540;

/// A terrain and a flight over it.
struct Scene {
  std::string name;
  std::shared_ptr<const terrain::Database> terrain;
  Flight flight;
};

/// One fixed setting of levers; NaN leaves a lever as the preset has it.
struct Fixed {
  LeverValues levers;

  std::string text() const {
    std::string text;
    for (const LeverRow& row : kLeverRows) {
      if (std::isnan(levers[row.lever])) continue;
      char value[64];
      std::snprintf(value, sizeof value, "%s%s %.3g", text.empty() ? "" : ", ", std::string(row.key).c_str(),
                    levers[row.lever]);
      text += value;
    }
    return text.empty() ? "default" : text;
  }
};

/// What a setting drew over a flight.
struct Drawn {
  std::vector<double> ms, flip;  ///< by frame

  double p95() const { return experiment::quantileOf(ms, 0.95); }
  double meanFlip() const { return experiment::meanOf(flip); }
};

/// All settings that a policy is compared with: each allowed error of its usual range with each value of
/// every other lever that the policy moves. The first is the preset without its policy, which is `default`.
std::vector<Fixed> gridFor(const CompiledPolicy& policy, bool quick) {
  const std::vector<double> errors =
      quick ? std::vector<double>{1, 2, 4, 8} : std::vector<double>{1, 1.4, 2, 2.8, 4, 5.6, 8, 11, 16};
  std::vector<Fixed> grid;
  for (const double error : errors) grid.emplace_back().levers[Lever::screen_space_error] = error;
  const auto multiply = [&](Lever lever, std::initializer_list<double> values) {
    if (!policy.moves(lever)) return;
    const std::size_t before = grid.size();
    for (const double value : values)
      for (std::size_t i = 0; i < before; ++i) {
        Fixed fixed = grid[i];
        fixed.levers[lever] = value;
        grid.push_back(fixed);
      }
  };
  multiply(Lever::render_scale, {0.9, 0.75, 0.5});
  multiply(Lever::lod_scale, {2, 4});
  multiply(Lever::far_distance, {0.75, 0.5});
  multiply(Lever::particle_density, {0.5, 0.25, 0});
  multiply(Lever::blur_strength, {0.5, 0});
  grid.insert(grid.begin(), Fixed{});
  return grid;
}

FrameRequest set(FrameRequest request, const Fixed& fixed, const TuningParameters& parameters) {
  for (const LeverRow& row : kLeverRows)
    if (!std::isnan(fixed.levers[row.lever]))
      request = experiment::withLever(std::move(request), row.lever, fixed.levers[row.lever], parameters);
  return request;
}

/// The frames of one flight, drawn by the policy and by each fixed setting in turns.
class Comparison {
 public:
  Comparison(const Scene& scene, const TuningParameters& parameters, bool quick) : parameters_(parameters) {
    setup_.terrain = scene.terrain;
    setup_.terrainName = scene.name;
    setup_.flight = scene.flight;
    // A p95 needs twenty.
    setup_.frames = quick ? 20 : 24;
    setup_.widthPx = kWidth;
    setup_.heightPx = kHeight;
    repeats_ = quick ? 1 : 3;
  }

  /// Returns the policy's frames and, in the order of `grid`, those of the settings; nothing without GL.
  std::vector<Drawn> draw(const std::vector<Fixed>& grid) {
    auto stage = experiment::Stage::open(setup_);
    scene::ErrorMeter meter;
    if (!stage || !meter.initialize().usable) return {};
    meter.setTerrain(setup_.terrain);
    TuningParameters plain = parameters_;
    plain.policy.enabled = false;
    const Flight& flight = *setup_.flight;
    const auto rows = harness::sampledRows(flight, *setup_.terrain, setup_.frames);
    const harness::Flying flying{setup_.terrain, kWidth, kHeight, false, 1, {}};
    const auto decided = *harness::flyFrames(**stage, flying, flight, *validate(parameters_), rows);
    const auto bare = *harness::flyFrames(**stage, flying, flight, *validate(plain), rows);
    std::vector<Drawn> drawn(grid.size() + 1);
    for (std::size_t i = 0; i < bare.size(); ++i) {
      const auto at = [&](const Fixed& fixed) {
        FlownFrame::Image image = bare[i].ofRepeat(0);
        image.request = set(std::move(image.request), fixed, plain);
        for (FrameRequest& before : image.before) before = set(std::move(before), fixed, plain);
        return image;
      };
      std::vector<FlownFrame::Image> images{decided[i].ofRepeat(0)};
      for (const Fixed& fixed : grid) images.push_back(at(fixed));
      for (std::size_t k = 0; k < drawn.size(); ++k) {
        const FlownFrame::Image& m = images[k];
        const std::span<const FrameRequest> traces =
            m.before.size() > 1 ? std::span<const FrameRequest>(m.before) : std::span<const FrameRequest>();
        drawn[k].flip.push_back(meter.measure(m.request, traces, nullptr).flip);
      }
      time(**stage, images, i, drawn);
    }
    meter.release();
    return drawn;
  }

 private:
  /// Each draw follows one of another setting, so that all do the work of a new frame; nobody is always
  /// first. What was blurred before is drawn before.
  void time(experiment::Stage& stage, const std::vector<FlownFrame::Image>& images, std::size_t frame,
            std::vector<Drawn>& drawn) const {
    std::vector<std::vector<double>> ms(images.size());
    for (int repeat = -1; repeat < repeats_; ++repeat)
      for (std::size_t turn = 0; turn < images.size(); ++turn) {
        const std::size_t k = (turn + frame + static_cast<std::size_t>(repeat + 1)) % images.size();
        if (images[k].before.size() > 1) stage.draw(images[k].before.back());
        const double total = stage.draw(images[k].request).cost.total;
        if (repeat >= 0) ms[k].push_back(total);
      }
    for (std::size_t k = 0; k < images.size(); ++k) drawn[k].ms.push_back(experiment::quantileOf(ms[k], 0.5));
  }

  TuningParameters parameters_;
  experiment::Setup setup_;
  int repeats_ = 3;
};

/// The policy's value and that of the fixed setting it is held against, with its name.
struct Held {
  double ours = 0, theirs = std::numeric_limits<double>::infinity();
  std::string setting;
};

/// The least `value` among the settings whose `bound` is at most that of the policy.
template <class Value, class Bound>
Held bestFixed(const std::vector<Drawn>& drawn, const std::vector<Fixed>& grid, const Value& value,
               const Bound& bound) {
  Held held;
  held.ours = value(drawn[0]);
  for (std::size_t k = 1; k < drawn.size(); ++k)
    if (bound(drawn[k]) <= bound(drawn[0]) && value(drawn[k]) < held.theirs) {
      held.theirs = value(drawn[k]);
      held.setting = grid[k - 1].text();
    }
  return held;
}

/// One row over the flights: geometric means, each flight's own ratio in the sentence.
Row rowOver(const std::string& id, std::string what, const char* unit, const std::vector<Held>& flights,
            const std::vector<std::string>& names) {
  double ours = 0, theirs = 0;
  std::size_t held = 0;
  for (std::size_t i = 0; i < flights.size(); ++i) {
    const Held& f = flights[i];
    char text[200];
    if (std::isfinite(f.theirs)) {
      ours += std::log(f.ours), theirs += std::log(f.theirs), ++held;
      std::snprintf(text, sizeof text, "; %s %.2f (%s)", names[i].c_str(), f.ours / f.theirs,
                    f.setting.c_str());
    } else {
      std::snprintf(text, sizeof text, "; %s: no fixed setting reaches it", names[i].c_str());
    }
    what += text;
  }
  Row row{.id = id, .what = what, .unit = unit, .peer = "best fixed setting of the same levers"};
  row.peerFrom = "run";
  if (held > 0) {
    row.value = std::exp(ours / static_cast<double>(held));
    row.peerValue = std::exp(theirs / static_cast<double>(held));
  }
  return row;
}

/// A terrain of the shared data, or null with a message.
std::shared_ptr<const terrain::Database> shared(const char* folder) {
  if (!std::filesystem::exists(test::sharedDir() / "data" / folder)) {
    std::cerr << "skipped: needs " << test::sharedDir() / "data" / folder << '\n';
    return nullptr;
  }
  const auto opened = test::bakedOnce(folder);
  if (!opened) std::cerr << toString(opened.findings());
  return opened ? *opened : nullptr;
}

Flight flightOf(const std::filesystem::path& file) {
  const auto flight = readFlight(file);
  if (!flight) std::cerr << toString(flight.findings());
  return flight ? *flight : Flight{};
}

Flight shipped(const char* name) {
  return flightOf(test::sourceDir() / "resources/flights" / (std::string(name) + ".csv"));
}

/// The flights of each policy. None of them is one that it was tuned on.
std::vector<Scene> scenesFor(const std::string& policy) {
  constexpr const char *kKansai = "fg-kansai-e135n35", *kEverest = "dem-srtm3-everest",
                       *kIceland = "fg-debian-iceland-reykjanes";
  std::vector<Scene> scenes;
  const auto add = [&](const char* name, std::shared_ptr<const terrain::Database> terrain,
                       const auto& flight) {
    if (!terrain) return;
    Flight flown = flight(*terrain);
    if (!flown.states.empty()) scenes.push_back({name, std::move(terrain), std::move(flown)});
  };
  const auto file = [](const char* name) {
    return [name](const terrain::Database&) { return shipped(name); };
  };
  const auto sample = [] { return sampleTerrain(60); };
  if (policy == "low-level") {
    add("Kansai", shared(kKansai), file("kansai-valley"));
    add("Everest", shared(kEverest), file("everest-pass"));
    add("sample", sample(), [](const auto& t) { return lowFlight(t, {0.15, 0.2}, {0.85, 0.75}, 500); });
  } else if (policy == "approach") {
    add("Iceland", shared(kIceland),
        [](const auto&) { return flightOf(test::sharedDir() / "data/flight-fg-keflavik/reg_flight.csv"); });
    add("Kansai", shared(kKansai), [](const auto& t) { return approachFlight(t, {0.45, 0.4}, 240); });
    add("sample", sample(), file("yecheon-circuit"));
  } else if (policy == "helmet-search") {
    const auto head =
        readHeadLog(test::sharedDir() / "data/headmotion-mv360/user1_euler.txt", BadRows::leave_out);
    if (!head) {
      std::cerr << "skipped: needs the head logs of the shared data\n";
      return scenes;
    }
    const auto searched = [&](const char* name) {
      return [&head, name](const terrain::Database&) { return withHead(shipped(name), *head, 20); };
    };
    add("Kansai", shared(kKansai), searched("kansai-valley"));
    add("Everest", shared(kEverest), searched("everest-pass"));
    add("sample", sample(), searched("yecheon-circuit"));
  } else {
    const auto across = [](double altitudeFt) {
      return [altitudeFt](const terrain::Database& t) {
        return cruiseFlight(t, {0.1, 0.3}, {0.9, 0.6}, altitudeFt);
      };
    };
    add("Kansai", shared(kKansai), across(31000));
    add("Everest", shared(kEverest), across(37000));
    add("sample", sample(), across(33000));
  }
  return scenes;
}

void compare(Report& report, const std::string& name) {
  const auto preset = loadPreset(name);
  const auto valid = preset ? validate(preset->parameters) : preset.findings();
  if (!valid) {
    std::cerr << toString(valid.findings());
    return;
  }
  const CompiledPolicy& policy = *valid->policy();
  const std::vector<Fixed> grid = gridFor(policy, report.quick());
  std::vector<Held> flips, times, defaults;
  std::vector<std::string> names;
  for (const Scene& scene : scenesFor(name)) {
    const auto drawn = Comparison(scene, preset->parameters, report.quick()).draw(grid);
    if (drawn.empty()) continue;
    names.push_back(scene.name);
    const auto flip = [](const Drawn& d) { return d.meanFlip(); };
    const auto p95 = [](const Drawn& d) { return d.p95(); };
    flips.push_back(bestFixed(drawn, grid, flip, p95));
    times.push_back(bestFixed(drawn, grid, p95, flip));
    char text[80];
    std::snprintf(text, sizeof text, "FLIP %.4f, default %.4f", flip(drawn[0]), flip(drawn[1]));
    defaults.push_back({p95(drawn[0]), p95(drawn[1]), text});
  }
  if (names.empty()) return;
  Row beside = rowOver("policies." + name + ".default",
                       "95th percentile of the frame time, beside the preset default on the same flights",
                       "ms", defaults, names);
  beside.peer = "default";
  report.add(ratioAtMost(1, beside));
  report.add(ratioAtMost(
      1, rowOver("policies." + name + ".p95",
                 "95th percentile of the frame time, against the fastest fixed setting of no worse mean FLIP",
                 "ms", times, names)));
  report.add(
      ratioAtMost(0.8, rowOver("policies." + name + ".flip",
                               "mean FLIP, against the best fixed setting of no longer 95th percentile",
                               "FLIP", flips, names)));
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  trimtab::bench::Report report(argc, argv);
  for (const char* name : {"low-level", "approach", "helmet-search", "high-cruise"})
    if (report.wants(name)) trimtab::bench::compare(report, name);
  return report.finish();
}
