// SPDX-License-Identifier: GPL-3.0-or-later
#include "weather_controller.h"

#include <algorithm>

#include "app/workbench/dialogs/weather_wizard.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/view_pause.h"
#include "app/workbench/viewport/viewport.h"
#include "frame_controller.h"
#include "terrain_controller.h"
#include "trimtab/units/geodesy.h"
#include "views/panels/weather_panel.h"

namespace trimtab::workbench {
namespace {

/// Returns the distance, metres, from the eye to the farthest corner of the terrain.
double farthestM(const GeodeticPosition& eye, const terrain::TerrainInfo& info) {
  double farthest = 0;
  for (const Degrees latitude : {info.southWest.latitude, info.northEast.latitude})
    for (const Degrees longitude : {info.southWest.longitude, info.northEast.longitude})
      farthest = std::max(farthest, length(toEcef({latitude, longitude, Metres{0}}) - toEcef(eye)));
  return farthest;
}

}  // namespace

WeatherController::WeatherController(const Workplace& workplace, const FrameController& frame,
                                     const TerrainController& terrain, views::WeatherPanel& panel)
    : at_(workplace), frame_(frame), terrain_(terrain) {
  connect(&panel, &views::WeatherPanel::calibrationAsked, this, &WeatherController::calibrate);
}

void WeatherController::calibrate() {
  if (!frame_.shown() || !terrain_.database())
    return at_.messages.note(tr("Open a terrain first: the weather is calibrated over an image of it"));
  FrameRequest request = *frame_.shown();
  request.overlays = {};
  request.decision.motion = {};
  WeatherStage stage;
  stage.farthestM = farthestM(request.eye, terrain_.database()->info());
  const auto& last = at_.viewport.lastResult();
  stage.conditions = tr("%1 × %2 px, %L3 triangles in view, drawn by %4.")
                         .arg(request.view.widthPx)
                         .arg(request.view.heightPx)
                         .arg(last ? last->visible.triangles : 0)
                         .arg(QString::fromStdString(at_.viewport.gl().renderer));
  stage.draw = [this, request, preset = *at_.draft.active()](
                   const WeatherDecision& weather) mutable -> std::optional<WeatherStage::Frame> {
    request.decision.weather = weather;
    request.levers = leversIn(weather, request.decision, preset);
    request.fading.reset();
    const auto drawn = at_.viewport.measure(request);
    if (!drawn) return std::nullopt;
    return WeatherStage::Frame{drawn->ms, drawn->tilesBuilt};
  };
  WeatherWizard wizard(at_.draft, std::move(stage), &at_.window);
  at_.pause.follow(wizard, &WeatherWizard::measuringChanged, tr("the weather is calibrated"));
  wizard.exec();
  at_.viewport.invalidate();
}

}  // namespace trimtab::workbench
