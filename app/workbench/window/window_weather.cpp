// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "app/workbench/dialogs/weather_wizard.h"
#include "main_window.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/units/geodesy.h"

// The calibration over the picture at hand.
namespace trimtab::workbench {
namespace {

/// From the eye to the farthest corner of the terrain.
double farthestM(const GeodeticPosition& eye, const terrain::TerrainInfo& info) {
  double farthest = 0;
  for (const Degrees latitude : {info.southWest.latitude, info.northEast.latitude})
    for (const Degrees longitude : {info.southWest.longitude, info.northEast.longitude})
      farthest = std::max(farthest, length(toEcef({latitude, longitude, Metres{0}}) - toEcef(eye)));
  return farthest;
}

}  // namespace

void MainWindow::calibrateWeather() {
  if (!shown_ || !terrain_)
    return messages_->note(tr("The weather is calibrated over a picture: open a terrain"));
  FrameRequest request = *shown_;
  request.overlays = {};
  request.frozenEye.reset();
  request.decision.motion = {};
  WeatherStage stage;
  stage.farthestM = farthestM(request.eye, terrain_->info());
  stage.conditions = tr("%1 × %2 px, %L3 triangles in view, drawn by %4.")
                         .arg(request.view.widthPx)
                         .arg(request.view.heightPx)
                         .arg(viewport_->lastResult() ? viewport_->lastResult()->visible.triangles : 0)
                         .arg(QString::fromStdString(viewport_->gl().renderer));
  stage.draw = [this, request](const WeatherDecision& weather) mutable -> std::optional<WeatherStage::Frame> {
    request.decision.weather = weather;
    const auto drawn = viewport_->measure(request);
    if (!drawn) return std::nullopt;
    return WeatherStage::Frame{drawn->ms, drawn->tilesBuilt};
  };
  WeatherWizard wizard(draft_, std::move(stage), this);
  wizard.exec();
  viewport_->invalidate();
}

}  // namespace trimtab::workbench
