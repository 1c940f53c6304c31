// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTimer>
#include <QWidget>

#include "views/model/live.h"

class QLabel;

namespace trimtab::views {
class Draft;
}

namespace trimtab::workbench {

class Feed;

/// What has to be in sight all day, at the foot of the window: the workspace, the frame time against the
/// budget, whether a trace is being recorded, and who moves the aircraft, with the age of a host's last
/// packet; and the image generator for which the preset is tuned. Each has a place of its own width, so that
/// none moves another. Nothing runs while nothing changes.
class StatusStrip : public QWidget {
  Q_OBJECT

 public:
  StatusStrip(const Feed& feed, const views::Draft& draft, QWidget* parent = nullptr);

  void showFrame(const views::LiveFrame& frame);

 public slots:
  void showWorkspace(const QString& name);
  void showSource(const QString& text);
  void showRecording(bool recording);

 private:
  QLabel* addPlace(const QString& name, const QString& widest, const QString& toolTip);
  void showAge();
  void showImageGenerator();

  const Feed& feed_;
  const views::Draft& draft_;
  QLabel *workspace_, *budget_, *recording_, *source_, *ig_;
  QString sourceText_;
  QTimer ages_;  ///< runs only while a link for a host is open
};

}  // namespace trimtab::workbench
