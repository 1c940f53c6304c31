// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDateTime>
#include <QTimer>
#include <QWidget>

#include "app/workbench/jobs/feed.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSlider;

namespace trimtab::workbench {

/// Plays a flight: here, or over real UDP into this program's own port.
class FlightDock : public QWidget {
  Q_OBJECT

 public:
  explicit FlightDock(Feed& feed, QWidget* parent = nullptr);

  Findings open(const QString& file);
  /// Where the open flight was read from; empty: nowhere, or the file is no longer the one that was read.
  QString file() const;
  void play();
  void pause();
  void stop();  ///< pauses and returns to the start
  bool playing() const;
  /// Takes the flight to a place, seconds from its start, whether it plays or not.
  void seek(double position);
  /// Where it is; over UDP what was sent last.
  double position() const;

 signals:
  void openRequested();
  void refused(const QString& what, const trimtab::Findings& findings);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  enum Via { here, udpCigi, udpNativeFdm };
  bool overUdp() const;
  void showState();
  void showPosition();

  Feed& feed_;
  QLabel *name_, *time_, *where_;
  QPushButton *play_, *stop_;
  QSlider* scrub_;
  QDoubleSpinBox* speed_;
  QCheckBox* loop_;
  QComboBox* via_;
  QString file_;
  QDateTime fileOf_;  ///< when it was written last, as it was read
  bool udpPaused_ = false;
  QTimer refresh_;  ///< runs only while a flight plays and this can be seen
};

}  // namespace trimtab::workbench
