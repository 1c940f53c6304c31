#pragma once

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "app/harness/results.h"
#include "tests/support.h"
#include "trimtab/scene/offscreen.h"

/// Results as a run leaves them, made without a run.
namespace trimtab::harness::test_results {

struct Size {
  std::size_t presets = 3, frames = 60;
  std::vector<std::string> flights{"Keflavik circuit", "Kansai valley"};
  std::vector<std::string> cases{"none", "view_frustum", "proposed"};
};

inline void setAll(MeasuredFrame& frame, std::size_t preset, std::size_t method, double t, double time) {
  const double p = static_cast<double>(preset), m = static_cast<double>(method);
  const double wave = 1 + 0.25 * std::sin(t * 9 + p) + (std::abs(t - 0.7) < 0.01 ? 1.5 : 0);
  frame.timeS = time;
  frame.cost.total = (24 - 7 * m) / (1 + 0.5 * p) * wave;
  frame.repeatsMs = {frame.cost.total};
  frame.cost.decide = 0.004;
  frame.cost.select = 0.09 + 0.02 * m;
  frame.cost.occlusion = method == 2 ? 1.1 : FrameCost::kNotMeasured;
  frame.cost.cull = 0.02;
  frame.cost.draw = frame.cost.total * 0.85;
  frame.cost.page = t > 0.4 && t < 0.6 ? 2.5 : FrameCost::kNotMeasured;
  frame.cost.gpu = FrameCost::kNotMeasured;
  frame.cost.symbology = 0.3;
  frame.counts = {static_cast<std::uint64_t>((900000 - 250000 * m) / (1 + p) * wave),
                  400000,
                  static_cast<std::uint64_t>(600 / (m + 1)),
                  method > 0 ? 380u : 0u,
                  method > 1 ? 90u : 0u,
                  0};
  frame.error.geometricMaxPx = 1.7 * p * wave;
  frame.error.geometricMeanPx = 0.11 * p * wave;
  frame.error.flip = 0.004 * p * p * wave;
  frame.error.ssim = 1 - 0.002 * p * wave;
  frame.error.psnrDb = preset == 0 ? std::numeric_limits<double>::infinity() : 45 - 4 * p * wave;
  frame.error.pop = 0.05 * p * wave;
  frame.error.hiddenDrawnShare = 0.4 - 0.15 * m;
}

inline Results results(const Size& size) {
  Results r;
  r.terrain = "Iceland";
  r.machine = "some processor, 2 cores, llvmpipe";
  r.version = "0.1.0";
  r.widthPx = 1280;
  r.heightPx = 720;
  r.repeats = 5;
  r.budgetMs = 16.7;
  r.notes = {"Frames are evenly spread over the flight.", "Drawn without a window."};
  const std::vector<std::string> names{"default", "as-published", "as-printed"};
  for (const std::string& flight : size.flights)
    for (std::size_t p = 0; p < size.presets; ++p)
      for (std::size_t m = 0; m < size.cases.size(); ++m) {
        Unit unit;
        unit.name = {flight, p < names.size() ? names[p] : "preset " + std::to_string(p), size.cases[m]};
        for (std::size_t i = 0; i < size.frames; ++i) {
          MeasuredFrame frame;
          frame.row = i * 600;
          setAll(frame, p, m, static_cast<double>(i) / static_cast<double>(size.frames),
                 static_cast<double>(i) * 10);
          unit.frames.push_back(frame);
        }
        if (size.frames > 0) {
          const std::size_t at = size.frames * 7 / 10;
          const std::string stem = std::to_string(p) + "-" + (size.cases[m] == "proposed" ? "b" : "a");
          unit.worst = {
              {at, "largest FLIP", stem + "-reference.png", stem + "-ours.png", stem + "-difference.png"}};
        }
        unit.skips = {{"blur at rest", 40, size.frames, 0.8, {1.06, 1.02, 1.11, 40}},
                      {"horizon while the head turns", 0, size.frames, std::nan(""), {}}};
        r.units.push_back(unit);
      }
  for (const std::string& flight : size.flights)
    for (std::size_t p = 1; p < size.presets; ++p) {
      const double q = static_cast<double>(p);
      r.comparisons.push_back(
          {{flight, names[0], size.cases.back()},
           {flight, p < names.size() ? names[p] : "preset " + std::to_string(p), size.cases.back()},
           {1.3 - 0.2 * q, 1.25 - 0.2 * q, 1.37 - 0.2 * q, 300}});
    }
  return r;
}

/// The pictures that `results` names, `widthPx` wide.
inline void writePictures(const std::filesystem::path& folder, const Results& results, int widthPx,
                          int heightPx) {
  for (const Unit& unit : results.units)
    for (const WorstFrame& worst : unit.worst) {
      int kind = 0;
      for (const std::string& name : {worst.reference, worst.ours, worst.difference}) {
        std::vector<std::uint8_t> rgba;
        for (int y = 0; y < heightPx; ++y)
          for (int x = 0; x < widthPx; ++x) {
            const int blue = kind == 0 ? 200 : static_cast<int>(name[0]) * 3 % 256;
            for (const int c : {x * 255 / widthPx, y * 255 / heightPx, blue, 255})
              rgba.push_back(static_cast<std::uint8_t>(c));
          }
        (void)scene::writePng(folder / name, rgba, widthPx, heightPx);
        ++kind;
      }
    }
}

}  // namespace trimtab::harness::test_results
