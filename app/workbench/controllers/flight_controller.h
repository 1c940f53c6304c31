// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QString>

#include "workplace.h"

namespace trimtab::workbench {

class FlightDock;
class FrameController;
class HostDock;
class TerrainController;

/// Who moves the aircraft: a host, a flight that is played here, or the free camera.
class FlightController : public QObject {
  Q_OBJECT

 public:
  FlightController(const Workplace& workplace, const FrameController& frame, const TerrainController& terrain,
                   FlightDock& flight, HostDock& host);

  /// Opens a flight, a capture or a trace. Returns false and reports in the Messages dock if it cannot be
  /// read; the flight stays as it was.
  bool open(const QString& file);
  void askOpen();
  void playOrPause();
  void connectOrDisconnectHost();
  /// Puts the free camera over the terrain. Nobody sees that while a host or a flight moves the aircraft.
  void placeCamera();

  FlightDock& flightDock() const { return flight_; }

 signals:
  /// Says in a few words who moves the aircraft.
  void sourceTextChanged(const QString& text);

 private:
  void showSource();
  void showLink();

  Workplace at_;
  const FrameController& frame_;
  const TerrainController& terrain_;
  FlightDock& flight_;
  HostDock& host_;
};

}  // namespace trimtab::workbench
