// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot_signals.h"

#include <QStringList>
#include <algorithm>
#include <array>
#include <iterator>

#include "theme.h"

namespace trimtab::views {
namespace {

constexpr std::array kSignals{
    PlotSignal{Trace::altitude_membership, "altitude membership", "", 1, 3},
    PlotSignal{Trace::pitch_membership, "pitch membership", "", 1, 3},
    PlotSignal{Trace::total_membership, "total membership", "", 1, 3},
    PlotSignal{Trace::dynamic_scheme, "scheme dynamic", "", 1, 0},
    PlotSignal{Trace::band, "band", "", 1, 0},
    PlotSignal{Trace::depth_map_width_px, "depth map", "px", 1, 0},
    PlotSignal{Trace::lod_scale, "LOD scale", "", 1, 2},
    PlotSignal{Trace::frame_ms, "frame", "ms", 1, 2},
    PlotSignal{Trace::fps, "rate", "fps", 1, 1},
    PlotSignal{Trace::select_ms, "select", "ms", 1, 2},
    PlotSignal{Trace::page_ms, "page", "ms", 1, 2, true},
    PlotSignal{Trace::occlusion_ms, "occlusion", "ms", 1, 2, true},
    PlotSignal{Trace::cull_ms, "cull", "ms", 1, 2},
    PlotSignal{Trace::draw_ms, "draw", "ms", 1, 2},
    PlotSignal{Trace::gpu_ms, "GPU", "ms", 1, 2, true},
    PlotSignal{Trace::blur_ms, "blur", "ms", 1, 2, true},
    PlotSignal{Trace::weather_ms, "weather", "ms", 1, 2, true},
    PlotSignal{Trace::symbology_ms, "symbols", "ms", 1, 2, true},
    PlotSignal{Trace::triangles, "triangles", "k", 1e-3, 1},
    PlotSignal{Trace::vertices, "vertices", "k", 1e-3, 1},
    PlotSignal{Trace::tiles_drawn, "nodes drawn", "", 1, 0},
    PlotSignal{Trace::tiles_outside, "nodes outside", "", 1, 0},
    PlotSignal{Trace::tiles_hidden, "nodes occluded", "", 1, 0},
    PlotSignal{Trace::tiles_built, "nodes uploaded", "", 1, 0},
    PlotSignal{Trace::pages_read, "pages read", "", 1, 0},
    PlotSignal{Trace::page_read_mb, "read from disk", "MB", 1, 2},
    PlotSignal{Trace::pages_waiting, "pages waiting", "", 1, 0},
    PlotSignal{Trace::altitude_ft, "altitude", "ft", 1, 0},
    PlotSignal{Trace::above_ground_ft, "above ground", "ft", 1, 0, true},
    PlotSignal{Trace::pitch_deg, "pitch", "deg", 1, 1},
    PlotSignal{Trace::roll_deg, "roll", "deg", 1, 1, true},
    PlotSignal{Trace::speed_kt, "speed", "kt", 1, 0, true},
    PlotSignal{Trace::climb_ftpmin, "climb", "ft/min", 1, 0, true},
    PlotSignal{Trace::line_of_sight_degps, "line of sight", "deg/s", 1, 1},
    PlotSignal{Trace::sight_rate_degps, "line of sight, filtered", "deg/s", 1, 1, true},
    PlotSignal{Trace::visibility_m, "visibility", "m", 1, 0, true},
    PlotSignal{Trace::load, "load", "", 1, 2, true},
    PlotSignal{Trace::allowed_error_px, "allowed error", "px", 1, 2},
    PlotSignal{Trace::render_scale, "render scale", "", 1, 2},
    PlotSignal{Trace::particle_density, "particle density", "", 1, 2},
    PlotSignal{Trace::blur_strength, "blur strength", "", 1, 2},
    PlotSignal{Trace::far_km, "far distance", "km", 1, 1, true},
    PlotSignal{Trace::predicted_ms, "predicted", "ms", 1, 2, true},
    PlotSignal{Trace::as_asked_ms, "predicted as asked", "ms", 1, 2, true},
    PlotSignal{Trace::flip, "FLIP", "", 1, 4, true},
};
static_assert(kSignals.size() == kCsvTraces, "each recorded value can be plotted");

constexpr QLatin1String kStages("stages");

QString nameOf(Trace trace) {
  return fromView(traceName(trace));
}

}  // namespace

QString PlotSignal::fullName() const {
  return *unit == '\0' ? name() : QStringLiteral("%1 (%2)").arg(name(), QString::fromUtf8(unit));
}

std::span<const PlotSignal> plotSignals() {
  return kSignals;
}

const PlotSignal& signalOf(Trace trace) {
  return *std::ranges::find(kSignals, trace, &PlotSignal::trace);
}

PlotLanes standardLanes() {
  using enum Trace;
  return {{{altitude_membership, pitch_membership, total_membership, line_of_sight_degps}},
          {{triangles, vertices, lod_scale}},
          {{frame_ms, fps}},
          {{}, true}};
}

QString toText(const PlotLanes& lanes) {
  QStringList all;
  for (const PlotLane& lane : lanes) {
    QStringList names;
    if (lane.stages) names << kStages;
    for (const Trace trace : lane.traces) names << nameOf(trace);
    all << names.join(QLatin1Char(' '));
  }
  return all.join(QLatin1Char(';'));
}

std::optional<PlotLanes> lanesOf(const QString& text) {
  PlotLanes lanes;
  for (const QString& part : text.split(QLatin1Char(';'))) {
    PlotLane lane;
    for (const QString& name : part.split(QLatin1Char(' '), Qt::SkipEmptyParts)) {
      if (name == kStages)
        lane.stages = true;
      else if (const auto trace = traceOf(name); trace && std::ranges::count(lane.traces, *trace) == 0)
        lane.traces.push_back(*trace);
    }
    if (lane.stages || !lane.traces.empty()) lanes.push_back(std::move(lane));
  }
  if (lanes.empty()) return std::nullopt;
  return lanes;
}

std::optional<Trace> traceOf(const QString& name) {
  // Saved layouts may have the name that the line of sight had before.
  if (name == QLatin1String("head_rate_degps")) return Trace::line_of_sight_degps;
  for (const PlotSignal& signal : kSignals)
    if (nameOf(signal.trace) == name) return signal.trace;
  return std::nullopt;
}

}  // namespace trimtab::views
