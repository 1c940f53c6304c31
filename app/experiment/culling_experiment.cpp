#include <array>
#include <cmath>
#include <cstdio>

#include "bars.h"
#include "published.h"
#include "stage.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/measure/paired_ratio.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/grid/progress.h"

namespace trimtab::experiment {
namespace {

constexpr std::array<double, 4> kAltitudesFt{2000, 4000, 6000, 8000};
/// The papers' three, and the same decision served by the horizon.
struct Case {
  CullingCase method;
  OcclusionMethod occlusion;
  const char* name;
};
constexpr std::array<Case, 4> kCases{{{CullingCase::none, OcclusionMethod::depth_map, "none"},
                                      {CullingCase::view_frustum, OcclusionMethod::depth_map, "view_frustum"},
                                      {CullingCase::proposed, OcclusionMethod::depth_map, "proposed"},
                                      {CullingCase::proposed, OcclusionMethod::horizon, "ours"}}};

/// One case at one altitude over all views.
struct AltitudeSums {
  std::vector<double> ms, triangles, vertices;
  double differing = 0;
};

/// The decision sees the named altitude; the eye is at that height above the ground.
FrameRequest requestAt(const Setup& setup, const ValidatedParameters& parameters, const Place& place,
                       double altitudeFt) {
  AircraftState state;
  state.position = place.ground;
  state.position.height = Feet{altitudeFt}.as<Metres>();
  state.aboveGround = state.position.height;
  state.attitude = place.attitude;
  Session session(parameters);
  session.look(state);
  FrameRequest request = *session.request(0, setup.widthPx, setup.heightPx);
  request.eye.height = place.ground.height + Feet{altitudeFt}.as<Metres>();
  // Documents A and B draw tiles, which all four cases must have in common.
  request.terrain.form = TerrainForm::tiles;
  request.waitForPages = true;
  return request;
}

Plot casesOf(const char* file, const char* title, const char* yLabel, const Table& table,
             const char* column) {
  Plot plot{file, title, "altitude (ft)", yLabel, {}, {}};
  for (const double altitude : kAltitudesFt) {
    char text[16];
    std::snprintf(text, sizeof text, "%.0f", altitude);
    plot.categories.push_back(text);
  }
  for (const Case& c : kCases) plot.series.push_back(barsOf(c.name, table, column, "case", c.name));
  return plot;
}

/// Plots the triangles of each case as a share of the plain case's, published and ours.
Plot sharesOf(const Table& published, const Table& measured) {
  Plot plot = casesOf("culling-triangles", "Triangles drawn, as a share of the unculled scene", "share",
                      measured, "triangles");
  plot.series.clear();
  for (const auto& [table, whose] : {std::pair{&published, "published"}, std::pair{&measured, "measured"}}) {
    const Series plain = barsOf("none", *table, "triangles", "case", "none");
    for (std::size_t c = 1; c < kCases.size(); ++c) {
      const std::string name = kCases[c].name;
      Series series = barsOf(name + ", " + whose, *table, "triangles", "case", name);
      for (std::size_t i = 0; i < series.y.size(); ++i) series.y[i] /= plain.y[i];
      if (series.y.empty()) continue;  // ours is not published
      plot.series.push_back(std::move(series));
    }
  }
  return plot;
}

}  // namespace

Result<Report> runCulling(const Setup& setup) {
  const Result<ValidatedParameters> parameters = validate(setup.parameters);
  if (!parameters) return parameters.findings();
  auto stage = Stage::open(setup);
  if (!stage) return stage.findings();
  const std::vector<Place> places = placesOf(setup, 20);
  if (places.empty()) return notOverTerrain(setup);

  std::array<std::array<AltitudeSums, kCases.size()>, kAltitudesFt.size()> sums;
  double eyeFt = 0;
  for (std::size_t a = 0; a < kAltitudesFt.size(); ++a)
    for (std::size_t p = 0; p < places.size(); ++p) {
      const double done = double(a * places.size() + p) / double(kAltitudesFt.size() * places.size());
      char what[64];
      std::snprintf(what, sizeof what, "%.0f ft, view %zu of %zu", kAltitudesFt[a], p + 1, places.size());
      if (setup.progress && !setup.progress(done, what)) return cancelled();
      FrameRequest request = requestAt(setup, *parameters, places[p], kAltitudesFt[a]);
      if (a == 0) eyeFt += request.eye.height.in<Feet>() - kAltitudesFt[a];
      std::vector<std::uint8_t> unculled;
      for (std::size_t c = 0; c < kCases.size(); ++c) {
        request.cullingCase = kCases[c].method;
        request.occlusion = kCases[c].occlusion;
        FrameResult last;
        AltitudeSums& s = sums[a][c];
        s.ms.push_back((*stage)->medianMs(request, setup.repeats, last));
        s.triangles.push_back(double(last.visible.triangles));
        s.vertices.push_back(double(last.visible.vertices));
        if (kCases[c].method == CullingCase::none)
          unculled = (*stage)->pixels(request);
        else
          s.differing += double(differingPixels(unculled, (*stage)->pixels(request)));
      }
    }

  Report report{"culling", "A, B: comparison of culling", (*stage)->machine(), publishedCulling(), {}, {},
                {}};
  const terrain::TerrainInfo& info = setup.terrain->info();
  const char* const imagery = !info.hasImage ? "no" : info.scenery ? "land cover" : "yes";
  for (std::size_t c = 0; c < kCases.size(); ++c)
    for (std::size_t a = 0; a < kAltitudesFt.size(); ++a) {
      const AltitudeSums &s = sums[a][c], &plain = sums[a][0];
      const double ms = quantileOf(s.ms, 0.5);
      const PairedRatio ofPlain = pairedRatio(plain.ms, s.ms);
      report.measured.add({{"altitude_ft", kAltitudesFt[a]},
                           {"case", kCases[c].name},
                           {"triangles", std::round(meanOf(s.triangles))},
                           {"vertices", std::round(meanOf(s.vertices))},
                           {"frame_ms", ms},
                           {"fps", 1000 / ms},
                           {"triangles_ratio", meanOf(s.triangles) / meanOf(plain.triangles)},
                           {"vertices_ratio", meanOf(s.vertices) / meanOf(plain.vertices)},
                           {"frame_ms_ratio", ofPlain.median},
                           {"frame_ms_ratio_low", ofPlain.low},
                           {"frame_ms_ratio_high", ofPlain.high},
                           {"imagery", imagery},
                           {"differing_pixels", s.differing}});
    }
  char text[256];
  std::snprintf(
      text, sizeof text,
      "%s, preset %s, %d x %d: %zu level views; the eye stands the named altitude above the highest ground "
      "within 2 km, which lies at %.0f ft on average.",
      setup.terrainName.c_str(), setup.presetName.c_str(), setup.widthPx, setup.heightPx, places.size(),
      eyeFt / double(places.size()));
  report.notes = {
      text,
      "Milliseconds are of the whole frame, without a cap: the published rates stop at 60 a second.",
      "The published counts are primitives and not triangles: compare the shares of the unculled case.",
      "frame_ms_ratio is the median of the views' ratios to the unculled case, with its 95 % interval.",
      "Proposed is as published, with a depth map; ours is the same decision with a horizon about the eye.",
      "The documents' terrain has satellite images. Land cover is the colours of the scenery's materials."};
  report.plots = {
      sharesOf(report.published, report.measured),
      casesOf("culling-frame-ms", "Frame time, measured", "frame time (ms)", report.measured, "frame_ms")};
  return report;
}

}  // namespace trimtab::experiment
