// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QPointer>
#include <QString>
#include <deque>
#include <optional>

#include "app/workbench/docks/error_dock.h"
#include "app/workbench/jobs/draw_thread.h"
#include "run_inputs.h"
#include "trimtab/frame/frame_request.h"
#include "workplace.h"

class QDockWidget;

namespace trimtab::workbench {

class FlightController;
class FrameController;
class SplitView;
class TerrainController;
class TraceController;

/// Run time against error: measures the live session, runs benchmarks along the flight, keeps the cursor of
/// the results and the flight together, and compares two presets.
class ErrorsController : public QObject {
  Q_OBJECT

 public:
  struct Neighbours {
    const FrameController& frame;
    const TerrainController& terrain;
    FlightController& flight;
    const TraceController& trace;
    const RunInputs& inputs;
  };
  ErrorsController(const Workplace& workplace, DrawThread& measuring, const Neighbours& neighbours);

  /// The window docks it after the controllers are made; call `attach` then.
  ErrorDock& dock() { return *dock_; }
  /// Compares two presets on the frame that is shown; the window docks it too.
  SplitView& splitView() { return *split_; }
  /// Follows whether a person can see the docks: nothing is measured live while nobody does.
  void attach();
  void askOpenResults();
  void askAndMeasure();
  bool openResults(const QString& file);
  /// Lets two presets draw the frame of the viewport, and raises the dock that says how they differ.
  void compare();
  /// Does so with this preset on the right: a file, or a shipped name.
  void compareWith(const QString& preset);
  /// Shows the viewport alone again, and puts the docks as they were before compare().
  void endComparison();

 signals:
  /// Asks the status bar to show a short hint.
  void hint(const QString& text);
  /// Presets are to be measured, and the current workspace does not have the dock for their results.
  void placeWanted();

 private:
  std::optional<ErrorDock::Inputs> benchInputs(const QString& folder);
  void remember(const FrameRequest& before);
  void onPainted();
  void onTerrainOpened();
  void followFlight();
  void seekFlight(double timeS);
  QString whyNotMeasured() const;
  QString missing() const;

  Workplace at_;
  DrawThread& measuring_;
  Neighbours by_;
  std::deque<FrameRequest> shownBefore_;  ///< while errors are measured live; oldest first
  QString hinted_;                        ///< what `seekFlight` reported last
  ErrorDock* dock_;
  SplitView* split_ = nullptr;
  QPointer<QDockWidget> coveredByCompare_;  ///< the dock that was in front in its place
  bool broughtToFront_ = false, compareWasHidden_ = false;
};

}  // namespace trimtab::workbench
