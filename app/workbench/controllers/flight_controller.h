// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>
#include <optional>

#include "app/workbench/jobs/feed.h"
#include "trimtab/host/column_map.h"
#include "workplace.h"

namespace trimtab::workbench {

class FlightDock;
class HostDock;
class ObserverController;
class TerrainController;

/// Who moves the aircraft: a host, a flight that is played here, or the free camera.
class FlightController : public QObject {
  Q_OBJECT

 public:
  FlightController(const Workplace& workplace, const ObserverController& observer,
                   const TerrainController& terrain, FlightDock& flight, HostDock& host);

  /// Opens a flight, a capture or a trace, with a map of its columns; unset: with what was said of files with
  /// its header. Returns false and reports in the Messages dock if it cannot be read; the flight stays as it
  /// was. If a map may help, a dialog that does not wait for its answer asks for the columns.
  bool open(const QString& file, const std::optional<ColumnMap>& columns = {});
  void askOpen();
  /// Asks for the columns of the open flight, or of a file that it asks for.
  void askColumns();
  void playOrPause();
  void connectOrDisconnectHost();
  /// Listens for a host on this port, on the interface that was chosen last.
  void listen(std::uint16_t port);
  /// Puts the free camera over the terrain: the pilot's eye, or the observer's while it is apart. Nobody sees
  /// that while a host or a flight moves the view.
  void placeCamera();
  void placeCamera(const GeodeticPosition& position, const Attitude& attitude);

  FlightDock& flightDock() const { return flight_; }

 signals:
  /// Says in a few words who moves the aircraft.
  void sourceTextChanged(const QString& text);

 private:
  Findings openWith(const QString& path, const ColumnMap& columns);
  void askColumnsOf(const QString& path, const ColumnMap& columns);
  QString askFile();
  void cameraMoved();
  void takeSeat();
  void showSource();
  void showLink();
  QString sourceText() const;

  Workplace at_;
  const ObserverController& observer_;
  const TerrainController& terrain_;
  FlightDock& flight_;
  HostDock& host_;
  Feed::Source source_ = Feed::Source::camera;  ///< when it was shown last
};

}  // namespace trimtab::workbench
