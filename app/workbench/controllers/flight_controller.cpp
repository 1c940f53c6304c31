// SPDX-License-Identifier: GPL-3.0-or-later
#include "flight_controller.h"

#include <QFileDialog>
#include <QFileInfo>
#include <utility>

#include "app/link/link.h"
#include "app/workbench/dialogs/column_dialog.h"
#include "app/workbench/dialogs/column_memory.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/host_dock.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/viewport/viewport.h"
#include "observer_controller.h"
#include "recent_files.h"
#include "terrain_controller.h"
#include "trimtab/scene/data_extent.h"

namespace trimtab::workbench {
namespace {

constexpr double kCameraAboveFt = 1500, kCameraClearM = 4000, kCameraPitchDeg = -6;

}  // namespace

FlightController::FlightController(const Workplace& workplace, const ObserverController& observer,
                                   const TerrainController& terrain, FlightDock& flight, HostDock& host)
    : at_(workplace), observer_(observer), terrain_(terrain), flight_(flight), host_(host) {
  connect(&at_.viewport, &Viewport::cameraMoved, this, &FlightController::cameraMoved);
  connect(&observer_, &ObserverController::changed, this, &FlightController::showSource);
  connect(&terrain_, &TerrainController::opened, this, [this] { placeCamera(); });
  connect(&at_.feed, &Feed::sourceChanged, this, &FlightController::showSource);
  connect(&at_.feed, &Feed::flightChanged, this, &FlightController::showSource);
  connect(&at_.feed, &Feed::linkChanged, this, &FlightController::showLink);
  connect(&at_.feed, &Feed::jumped, this, [this] {
    at_.messages.note(
        tr("The host moved the aircraft farther than it can fly (jump %L1)").arg(at_.feed.session().jumps()));
  });
  connect(&flight_, &FlightDock::openRequested, this, &FlightController::askOpen);
  connect(&flight_, &FlightDock::columnsRequested, this, &FlightController::askColumns);
}

bool FlightController::open(const QString& file, const std::optional<ColumnMap>& columns) {
  const QString path = QFileInfo(file).absoluteFilePath();
  const ColumnMap map = columns ? *columns : rememberedColumns(LogKind::flight, path);
  const Findings findings = openWith(path, map);
  if (hasError(findings)) {
    at_.messages.add(tr("The flight cannot be opened: %1").arg(file), findings);
    if (mapMayHelp(findings) || !map.empty()) askColumnsOf(path, map);
    return false;
  }
  if (!columns && !map.empty())
    at_.messages.note(tr("%1 is read with the columns that were chosen for files with its header")
                          .arg(QFileInfo(file).fileName()));
  return true;
}

Findings FlightController::openWith(const QString& path, const ColumnMap& columns) {
  Findings findings = flight_.open(path, columns);
  if (hasError(findings)) return findings;
  if (!findings.empty()) at_.messages.add(tr("Opened flight %1").arg(QFileInfo(path).fileName()), findings);
  raiseDock(flight_);
  rememberRecent(QStringLiteral("flight"), path);
  return findings;
}

QString FlightController::askFile() {
  return QFileDialog::getOpenFileName(&at_.window, tr("Open flight"),
                                      folderOfRecent(QStringLiteral("flight")),
                                      tr("Flights and captures (*.csv *.txt *.gpx *.igc *.pcap *.pcapng);;"
                                         "All files (*)"));
}

void FlightController::askOpen() {
  if (const QString file = askFile(); !file.isEmpty()) open(file);
}

void FlightController::askColumns() {
  const QString opened = flight_.file(), path = opened.isEmpty() ? askFile() : opened;
  if (path.isEmpty()) return;
  askColumnsOf(path, opened.isEmpty() ? rememberedColumns(LogKind::flight, path) : flight_.columns());
}

void FlightController::askColumnsOf(const QString& path, const ColumnMap& columns) {
  const auto openIt = [this, path](const ColumnMap& map) { return openWith(path, map); };
  if (const Findings findings = ColumnDialog::ask(LogKind::flight, path, columns, openIt, at_.window);
      !findings.empty())
    at_.messages.add(tr("%1 has no columns to choose").arg(QFileInfo(path).fileName()), findings);
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

void FlightController::listen(std::uint16_t port) {
  host_.setPort(port);
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
  placeCamera(place, {Degrees{0}, Degrees{kCameraPitchDeg}, Degrees{0}});
}

void FlightController::placeCamera(const GeodeticPosition& position, const Attitude& attitude) {
  at_.viewport.camera().place(position, attitude);
  cameraMoved();
}

void FlightController::cameraMoved() {
  if (observer_.apart()) return at_.viewport.invalidate();
  at_.feed.look(at_.viewport.camera());
}

/// The camera starts where the aircraft was, with level wings. The observer's stays where it is.
void FlightController::takeSeat() {
  const Session& session = at_.feed.session();
  if (!session.hasState()) return;
  const Seat seat = seatOf(session);
  FreeCamera camera;
  camera.place(seat.position, seat.attitude);
  if (!observer_.apart()) at_.viewport.camera().place(seat.position, seat.attitude);
  at_.feed.look(camera);
}

void FlightController::showSource() {
  const Feed::Source before = std::exchange(source_, at_.feed.source());
  if (source_ == Feed::Source::camera && before != source_) takeSeat();
  at_.viewport.setCameraEnabled(source_ == Feed::Source::camera || observer_.apart());
  emit sourceTextChanged(sourceText());
}

void FlightController::showLink() {
  if (at_.feed.source() == Feed::Source::host &&
      at_.feed.session().linkState(link::now()) == LinkState::silent)
    at_.messages.note(
        tr("The host on port %1 fell silent; the image stands still").arg(at_.feed.receiver()->port()));
  showSource();
}

QString FlightController::sourceText() const {
  const link::Receiver* const receiver = at_.feed.receiver();
  switch (source_) {
    case Feed::Source::flight:
      return at_.feed.playback().playing() ? tr("flight") : tr("flight, paused");
    case Feed::Source::camera:
      return receiver ? tr("free camera, listening on port %1").arg(receiver->port()) : tr("free camera");
    case Feed::Source::host:
      break;
  }
  if (receiver == nullptr) return {};
  return at_.feed.session().linkState(link::now()) == LinkState::silent
             ? tr("host on port %1 is SILENT").arg(receiver->port())
             : tr("host on port %1").arg(receiver->port());
}

}  // namespace trimtab::workbench
