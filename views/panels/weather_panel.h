// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <array>
#include <vector>

#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

class QGridLayout;
class QLabel;
class QPushButton;
class QTableWidget;

namespace trimtab::views {

class ParameterLine;

/// The Weather dock: what falls and how far one sees, what is cut and why, what each weather step means, and
/// the button for the calibration.
class WeatherPanel : public QWidget {
  Q_OBJECT
 public:
  explicit WeatherPanel(Draft& draft, QWidget* parent = nullptr);
  void showFrame(const LiveFrame& frame);

  /// Returns the line of a parameter; null if it is not shown.
  ParameterLine* line(std::string_view key) const;
  QTableWidget& steps() { return *steps_; }
  QPushButton& calibrateButton() { return *calibrate_; }
  QString reason() const;

 signals:
  void calibrationAsked();

 private:
  void makeLines(QGridLayout& grid);
  void showLines();
  void showSteps();
  void refresh();
  QLabel* addValue(QGridLayout& grid, const QString& name, const QString& toolTip);

  Draft& draft_;
  LiveFrame frame_;
  bool any_ = false;
  QLabel *now_, *reason_;
  QLabel *visibility_ = nullptr, *density_ = nullptr, *ratio_ = nullptr, *far_ = nullptr, *cut_ = nullptr,
         *host_ = nullptr;
  std::vector<ParameterLine*> lines_;
  QTableWidget* steps_;
  QPushButton* calibrate_;
  Throttle throttle_;
};

/// Returns a distance as text, such as "12,500 m (6.75 NM)"; "unlimited" for infinity.
QString distanceText(double metres);

}  // namespace trimtab::views
