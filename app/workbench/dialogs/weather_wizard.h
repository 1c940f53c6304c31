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

/// What the wizard measures with: the current view, drawn again and again.
struct WeatherStage {
  struct Frame {
    double ms = 0;  ///< until the image was finished
    std::uint64_t tilesBuilt =
        0;  ///< since the renderer was made: a picture that builds tiles does not count
  };
  /// Draws the view in this weather. Returns nothing if it cannot be drawn any more.
  std::function<std::optional<Frame>(const WeatherDecision&)> draw;
  double farthestM = 0;  ///< from the eye to the terrain's farthest corner
  QString conditions;    ///< says what is drawn, at which size and by which renderer
};

/// Runs document D's calibration on this machine. It measures what each weather step costs and what the cut
/// saves, and finds the far plane and the density at which both match; these are written into the draft as
/// one undo step. It measures on the main thread, one image at a time; between two images the window
/// responds.
class WeatherWizard : public QDialog {
  Q_OBJECT

 public:
  WeatherWizard(views::Draft& draft, WeatherStage stage, QWidget* parent = nullptr);

  /// Measures the chosen steps. Returns when all are done, or when the person cancels.
  void start();
  void cancel() { cancelled_ = true; }
  bool running() const { return running_; }
  /// Returns the results of the steps that were measured completely.
  const std::vector<StepCalibration>& results() const { return results_; }
  /// Writes the results into the draft, but none that the calibration rejects.
  void write();

  void reject() override;

 signals:
  void measuringChanged(bool measuring);

 private:
  std::vector<WeatherStep> chosenSteps() const;
  std::optional<double> measure(const WeatherDecision& decision);
  std::optional<WeatherStage::Frame> drawn(const WeatherDecision& decision);
  void setRunning(bool running);
  void addRow(const StepCalibration& result);
  void showWhatIsRejected();
  void showPlot();

  views::Draft& draft_;
  WeatherStage stage_;
  bool running_ = false, cancelled_ = false, failed_ = false, closing_ = false;
  std::optional<WeatherDecision> last_;
  std::vector<StepCalibration> results_;
  int measured_ = 0;

  QListWidget* steps_;
  QSpinBox* frames_;
  QPushButton *run_, *write_;
  QLabel* rejected_;
  QPushButton* close_;
  QProgressBar* progress_;
  QLabel* status_;
  QTableWidget* table_;
  views::ReportPlot* plot_;
};

}  // namespace trimtab::workbench
