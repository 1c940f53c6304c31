// SPDX-License-Identifier: GPL-3.0-or-later
#include "flight_controller.h"

#include <QFileDialog>
#include <QFileInfo>
#include <algorithm>

#include "app/link/link.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/host_dock.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/viewport/viewport.h"
#include "frame_controller.h"
#include "recent_files.h"
#include "terrain_controller.h"
#include "trimtab/scene/data_extent.h"

namespace trimtab::workbench {
namespace {

constexpr double kCameraAboveFt = 1500, kCameraClearM = 4000, kCameraPitchDeg = -6;

}  // namespace

FlightController::FlightController(const Workplace& workplace, const FrameController& frame,
                                   const TerrainController& terrain, FlightDock& flight, HostDock& host)
    : at_(workplace), frame_(frame), terrain_(terrain), flight_(flight), host_(host) {
  connect(&at_.viewport, &Viewport::cameraMoved, this, [this] { at_.feed.look(at_.viewport.camera()); });
  connect(&terrain_, &TerrainController::opened, this, &FlightController::placeCamera);
  connect(&at_.feed, &Feed::sourceChanged, this, &FlightController::showSource);
  connect(&at_.feed, &Feed::flightChanged, this, &FlightController::showSource);
  connect(&at_.feed, &Feed::linkChanged, this, &FlightController::showLink);
  connect(&at_.feed, &Feed::jumped, this, [this] {
    at_.messages.note(
        tr("The host moved the aircraft farther than it can fly (jump %L1)").arg(at_.feed.session().jumps()));
  });
  connect(&flight_, &FlightDock::openRequested, this, &FlightController::askOpen);
}

bool FlightController::open(const QString& file) {
  const QString path = QFileInfo(file).absoluteFilePath();
  const Findings findings = flight_.open(path);
  const auto isError = [](const Finding& finding) { return finding.severity == Severity::error; };
  if (std::any_of(findings.begin(), findings.end(), isError)) {
    at_.messages.add(tr("The flight cannot be opened: %1").arg(file), findings);
    return false;
  }
  if (!findings.empty()) at_.messages.add(tr("Opened flight %1").arg(QFileInfo(file).fileName()), findings);
  raiseDock(flight_);
  rememberRecent(QStringLiteral("flight"), path);
  return true;
}

void FlightController::askOpen() {
  const QString file = QFileDialog::getOpenFileName(&at_.window, tr("Open flight"), {},
                                                    tr("Flights and captures (*.csv *.pcap);;All files (*)"));
  if (!file.isEmpty()) open(file);
}

void FlightController::playOrPause() {
  flight_.playing() ? flight_.pause() : flight_.play();
}

void FlightController::connectOrDisconnectHost() {
  if (at_.feed.receiver() != nullptr)
    at_.feed.closeHost();
  else
    host_.connectHost();
}

/// The camera stands south of the middle, above the ground there, and looks north over the terrain.
void FlightController::placeCamera() {
  if (!terrain_.database()) return;
  const terrain::TerrainInfo& info = terrain_.database()->info();
  GeodeticPosition place = scene::placeIn(info, 0.5, 0.3);
  const std::optional<Metres> ground =
      terrain_.database()->highestWithin(place.latitude, place.longitude, Metres{kCameraClearM});
  place.height = (ground ? *ground : info.highest) + Feet{kCameraAboveFt}.as<Metres>();
  at_.viewport.camera().place(place, {Degrees{0}, Degrees{kCameraPitchDeg}, Degrees{0}});
  at_.feed.look(at_.viewport.camera());
}

void FlightController::showSource() {
  const Feed::Source source = at_.feed.source();
  // The camera starts where the aircraft was, with level wings.
  if (const auto& shown = frame_.shown();
      source == Feed::Source::camera && shown && !at_.viewport.cameraEnabled()) {
    at_.viewport.camera().place(shown->eye, {shown->attitude.heading, shown->attitude.pitch, Degrees{0}});
    at_.feed.look(at_.viewport.camera());
  }
  at_.viewport.setCameraEnabled(source == Feed::Source::camera);
  switch (source) {
    case Feed::Source::camera:
      return emit sourceTextChanged(tr("free camera"));
    case Feed::Source::flight:
      return emit sourceTextChanged(at_.feed.playback().playing() ? tr("flight") : tr("flight, paused"));
    case Feed::Source::host:
      return showLink();
  }
}

void FlightController::showLink() {
  if (at_.feed.receiver() == nullptr) {
    if (at_.feed.source() == Feed::Source::host) emit sourceTextChanged({});
    return;
  }
  const std::uint16_t port = at_.feed.receiver()->port();
  switch (at_.feed.session().linkState(link::now())) {
    case LinkState::never:
      return emit sourceTextChanged(tr("free camera, listening on port %1").arg(port));
    case LinkState::live:
    case LinkState::jumped:
      return emit sourceTextChanged(tr("host on port %1").arg(port));
    case LinkState::silent:
      at_.messages.note(tr("The host on port %1 fell silent; the image stands still").arg(port));
      return emit sourceTextChanged(tr("host on port %1 is SILENT").arg(port));
  }
}

}  // namespace trimtab::workbench
