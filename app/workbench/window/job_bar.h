// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

class QLabel;
class QProgressBar;

namespace trimtab::workbench {

class TerrainJob;

/// Shows in the status bar how far opening or baking terrain is, with a button that cancels it. Hidden while
/// nothing runs.
class JobBar : public QWidget {
  Q_OBJECT

 public:
  explicit JobBar(TerrainJob& job, QWidget* parent = nullptr);

 private:
  void say(const QString& what);
  void end();

  QLabel* what_;
  QProgressBar* progress_;
};

}  // namespace trimtab::workbench
