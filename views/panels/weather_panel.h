// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <array>
#include <string_view>
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

/// Shows the weather of document D in the dock *Weather*: the precipitation and the visibility, the far plane
/// beyond which nothing is drawn with the reason for it, a table of the weather steps (light, medium and
/// heavy rain and snow), and a button that opens the calibration of those steps.
class WeatherPanel : public QWidget {
  Q_OBJECT
 public:
  /// `draft` holds the parameters that are edited; it must outlive the panel.
  explicit WeatherPanel(Draft& draft, QWidget* parent = nullptr);
  /// Shows the newest frame, a few times a second at most.
  void showFrame(const LiveFrame& frame);

  /// Returns the line in which a parameter is edited; null if the panel has none for that key.
  ParameterLine* line(std::string_view key) const;
  QTableWidget& steps() { return *steps_; }
  QPushButton& calibrateButton() { return *calibrate_; }
  /// Returns the text that says why the far plane is where it is.
  QString reason() const;

 signals:
  void calibrationAsked();  ///< the button was pressed

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

/// Returns a distance as text in the locale's form, such as "12,500 m (6.75 NM)"; "unlimited" for infinity.
QString distanceText(double metres);

}  // namespace trimtab::views
