// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDialog>
#include <functional>
#include <optional>
#include <vector>

#include "trimtab/weather/calibrate.h"
#include "views/model/draft.h"

class QLabel;
class QListWidget;
class QProgressBar;
class QPushButton;
class QSpinBox;
class QTableWidget;

namespace trimtab::views {
class ReportPlot;
}

namespace trimtab::workbench {

/// What the wizard measures with: the picture at hand, drawn again and again.
struct WeatherStage {
  struct Frame {
    double ms = 0;  ///< until the picture was finished
    std::uint64_t tilesBuilt =
        0;  ///< since the renderer was made: a picture that builds tiles does not count
  };
  /// Draws the picture with this weather; none where nothing can be drawn any more.
  std::function<std::optional<Frame>(const WeatherDecision&)> draw;
  double farthestM = 0;  ///< from the eye to the terrain's farthest corner
  QString conditions;    ///< what is drawn, how large, by what
};

/// Document D's calibration on this machine: what each weather step costs, what the cut wins back, and the
/// far plane and density at which both match, written into the draft as one undo step. Measures on the main
/// thread a picture at a time; between two pictures the window answers.
class WeatherWizard : public QDialog {
  Q_OBJECT

 public:
  WeatherWizard(views::Draft& draft, WeatherStage stage, QWidget* parent = nullptr);

  /// Measures the chosen steps; returns when all are done or somebody cancelled.
  void start();
  void cancel() { cancelled_ = true; }
  bool running() const { return running_; }
  /// Of the steps that were measured to their end.
  const std::vector<StepCalibration>& results() const { return results_; }
  /// The results into the draft.
  void write();

  void reject() override;

 private:
  std::vector<WeatherStep> chosenSteps() const;
  std::optional<double> measure(const WeatherDecision& decision);
  std::optional<WeatherStage::Frame> drawn(const WeatherDecision& decision);
  void setRunning(bool running);
  void addRow(const StepCalibration& result);
  void showPlot();

  views::Draft& draft_;
  WeatherStage stage_;
  bool running_ = false, cancelled_ = false, failed_ = false, closing_ = false;
  std::optional<WeatherDecision> last_;
  std::vector<StepCalibration> results_;
  int measured_ = 0;

  QListWidget* steps_;
  QSpinBox* frames_;
  QPushButton *run_, *write_, *close_;
  QProgressBar* progress_;
  QLabel* status_;
  QTableWidget* table_;
  views::ReportPlot* plot_;
};

}  // namespace trimtab::workbench
