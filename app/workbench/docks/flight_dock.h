// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDateTime>
#include <QIcon>
#include <QStyle>
#include <QTimer>
#include <QWidget>

#include "app/workbench/jobs/feed.h"
#include "trimtab/host/column_map.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSlider;

namespace trimtab::workbench {

/// Plays a flight, either inside this program or over real UDP into this program's own port.
class FlightDock : public QWidget {
  Q_OBJECT

 public:
  explicit FlightDock(Feed& feed, QWidget* parent = nullptr);

  /// Opens a file, with a map of its columns. Returns what was wrong with it. An error among the findings
  /// means that it was not opened.
  Findings open(const QString& file, const ColumnMap& columns = {});
  /// Plays states that were recorded here, inside this program and with their own line of sight.
  void fly(const std::vector<AircraftState>& states);
  /// Returns the file that the open flight was read from; empty if there is none, or if the file has changed
  /// since.
  QString file() const;
  /// Returns the map with which that file was read.
  const ColumnMap& columns() const { return columns_; }
  /// Closes the flight; the free camera starts where the aircraft was.
  void close();
  void play();
  void pause();
  void stop();  ///< pauses and returns to the start
  bool playing() const;
  /// Moves the flight to this many seconds from its start, whether it plays or not.
  void seek(double position);
  /// Returns seconds from the flight's start; over UDP, the state that was sent last.
  double position() const;

 signals:
  void openRequested();
  void columnsRequested();
  void refused(const QString& what, const trimtab::Findings& findings);

 protected:
  void changeEvent(QEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  QIcon symbol(QStyle::StandardPixmap which) const;
  enum Via { here, udpCigi, udpNativeFdm, udpCigi4 };
  bool overUdp() const;
  void showState();
  void showPosition();

  Feed& feed_;
  QLabel *name_, *time_, *where_;
  QPushButton *play_, *stop_, *close_;
  QSlider* scrub_;
  QDoubleSpinBox* speed_;
  QCheckBox* loop_;
  QComboBox* via_;
  QString file_;
  ColumnMap columns_;
  QDateTime fileOf_;  ///< the file's time stamp when it was read
  bool udpPaused_ = false;
  QTimer refresh_;  ///< runs only while a flight plays and the dock is visible
};

}  // namespace trimtab::workbench
