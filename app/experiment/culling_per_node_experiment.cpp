#include <array>
#include <cmath>
#include <cstdio>

#include "bars.h"
#include "head_motion_run.h"
#include "stage.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::experiment {
namespace {

constexpr std::array<double, 4> kNodeAltitudesFt{500, 2000, 5000, 8000};
/// Level, and a climb at which the altitude alone decides between the schemes.
constexpr std::array<double, 2> kPitchesDeg{0, 26};
/// Farther than any node is drawn.
constexpr double kFarthestFt = 5e6;

enum class Loop { frame, node };
constexpr std::array<const char*, 2> kLoops{"frame", "node"};

/// Returns the request for a level line of sight, as a helmet has it, decided for a height or distance and a
/// pitch.
FrameRequest requestFor(const Setup& setup, const ValidatedParameters& parameters, const Place& place,
                        double feet, double pitchDeg) {
  AircraftState state;
  state.position = place.ground;
  state.position.height = Feet{feet}.as<Metres>();
  state.aboveGround = state.position.height;
  state.attitude = place.attitude;
  state.attitude.pitch = Degrees{pitchDeg};
  Session session(parameters);
  session.look(state);
  FrameRequest request = *session.request(0, setup.widthPx, setup.heightPx);
  request.attitude = place.attitude;
  request.waitForPages = true;
  return request;
}

/// Returns the distance up to which the rule base, asked with a distance for the altitude, wants nodes
/// tested, feet.
double testedWithinFt(const std::function<FrameDecision(double feet)>& decide) {
  if (!decide(0).occlusionResolution) return 0;
  if (decide(kFarthestFt).occlusionResolution) return kFarthestFt;
  double tested = 0, untested = kFarthestFt;
  while (untested - tested > 1)
    (decide((tested + untested) / 2).occlusionResolution ? tested : untested) = (tested + untested) / 2;
  return tested;
}

/// Bars of one column for each loop.
Plot loopsOf(const char* file, const char* title, const char* label, const Table& table, const char* column) {
  Plot plot{file, title, "terrain, pitch, altitude", label, {}, {}};
  for (const char* loop : kLoops) plot.series.push_back(barsOf(loop, table, column, "decision", loop));
  for (std::size_t row = 0; row < table.rows.size(); row += kLoops.size()) {
    char text[64];
    std::snprintf(text, sizeof text, "%s, %.0f deg, %.0f ft", table.text(row, "terrain").c_str(),
                  table.number(row, "pitch_deg"), table.number(row, "altitude_ft"));
    plot.categories.push_back(text);
  }
  return plot;
}

struct NodeSums {
  std::vector<double> ms, triangles, texels;
  double differing = 0, frames = 0;
};

}  // namespace

Result<Report> runCullingPerNode(const Setup& setup) {
  const Result<ValidatedParameters> parameters = validate(setup.parameters);
  if (!parameters) return parameters.findings();
  auto stage = Stage::open(setup);
  if (!stage) return stage.findings();
  const std::vector<Place> places = placesOf(setup, 12);
  if (places.empty()) return notOverTerrain(setup);
  std::vector<TerrainForm> forms{TerrainForm::levels};
  if (setup.terrain->staticLod() != nullptr) forms.push_back(TerrainForm::static_trees);

  Report report{"culling-per-node", "A: Figure 2, lines 4 to 12", (*stage)->machine(), {}, {}, {}, {}};
  report.measured.columns = {"terrain",    "pitch_deg", "altitude_ft", "decision",        "maps_drawn",
                             "map_texels", "triangles", "frame_ms",    "differing_pixels"};
  const double steps = double(forms.size() * kPitchesDeg.size() * kNodeAltitudesFt.size() * places.size());
  double done = 0;
  for (const TerrainForm form : forms)
    for (const double pitch : kPitchesDeg)
      for (const double altitude : kNodeAltitudesFt) {
        std::array<NodeSums, kLoops.size()> sums;
        for (const Place& place : places) {
          char what[96];
          std::snprintf(what, sizeof what, "%s, %.0f degrees, %.0f ft", nameOf(form).c_str(), pitch,
                        altitude);
          if (setup.progress && !setup.progress(done++ / steps, what)) return cancelled();
          const auto decided = [&](double feet) {
            return requestFor(setup, *parameters, place, feet, pitch).decision;
          };
          const Metres eye = place.ground.height + Feet{altitude}.as<Metres>();
          FrameRequest request = requestFor(setup, *parameters, place, eye.in<Feet>(), pitch);
          request.eye.height = eye;
          request.staticLod.terrain = form;
          request.method = CullingCase::view_frustum;
          const std::vector<std::uint8_t> unculled = (*stage)->pixels(request);
          request.method = CullingCase::proposed;
          request.occlusion = OcclusionMethod::depth_map;
          for (std::size_t loop = 0; loop < kLoops.size(); ++loop) {
            if (Loop(loop) == Loop::node) {
              // No node is nearer than the ground below, so the largest map that any node asks for is that of
              // the height above it.
              request.testedWithinM = Feet{testedWithinFt(decided)}.as<Metres>().value();
              request.decision = decided(altitude);
              request.levers = leversOf(request.decision, **parameters);
            }
            FrameResult last;
            NodeSums& s = sums[loop];
            s.ms.push_back((*stage)->medianMs(request, setup.repeats, last));
            s.triangles.push_back(double(last.visible.triangles));
            const OcclusionResolution map = last.depthMap.value_or(OcclusionResolution{});
            s.texels.push_back(double(map.widthPx) * map.heightPx);
            s.frames += last.depthMap.has_value();
            s.differing += double(differingPixels(unculled, (*stage)->pixels(request)));
          }
        }
        for (std::size_t loop = 0; loop < kLoops.size(); ++loop) {
          const NodeSums& s = sums[loop];
          report.measured.rows.push_back({nameOf(form), pitch, altitude, std::string(kLoops[loop]), s.frames,
                                          std::round(meanOf(s.texels)), std::round(meanOf(s.triangles)),
                                          quantileOf(s.ms, 0.5), s.differing});
        }
      }
  char text[320];
  std::snprintf(
      text, sizeof text,
      "%s, preset %s, %d x %d: %zu views; the eye stands the named altitude above the highest ground "
      "within 2 km and looks level, as through a helmet, while the aircraft has the named pitch.",
      setup.terrainName.c_str(), setup.presetName.c_str(), setup.widthPx, setup.heightPx, places.size());
  report.notes = {text,
                  "frame: one decision, of the altitude above the sea. node: document A's loop, in which "
                  "each node is decided "
                  "by its distance from the eye; one map serves all, as large as the nearest node asks for, "
                  "and a node that "
                  "asks for none is drawn without a test.",
                  "maps_drawn counts the views in which a depth map shaped the picture; differing_pixels "
                  "compares with view "
                  "frustum culling."};
  report.plots = {loopsOf("culling-per-node-frame-ms", "Frame time, decided by frame and by node",
                          "frame time (ms)", report.measured, "frame_ms"),
                  loopsOf("culling-per-node-triangles", "Triangles, decided by frame and by node",
                          "triangles", report.measured, "triangles")};
  return report;
}

}  // namespace trimtab::experiment
