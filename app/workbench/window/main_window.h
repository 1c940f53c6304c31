// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QMainWindow>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "app/workbench/jobs/feed.h"
#include "app/workbench/jobs/terrain_job.h"
#include "app/workbench/viewport/draw_thread.h"
#include "app/workbench/viewport/symbology_editor.h"
#include "app/workbench/viewport/viewport.h"
#include "document.h"
#include "message_panel.h"
#include "options.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/measure/trace.h"
#include "trimtab/preset/preset.h"
#include "trimtab/terrain/format/database.h"
#include "views/model/draft.h"
#include "views/model/live.h"

class QAction;
class QActionGroup;
class QDockWidget;
class QLabel;
class QMenu;
class QProgressBar;
class QPushButton;

namespace trimtab::views {
class BandsEditor;
class CullingPanel;
class MotionPanel;
class PlotsPanel;
class StaticLodPanel;
class TerrainPanel;
}  // namespace trimtab::views

namespace trimtab::workbench {

class ErrorDock;
class ExperimentsDock;
struct ExperimentInputs;
class FlightDock;
class HostDock;
class NoticeBar;
class SplitView;

/// The workbench: viewport in the middle, docks around it, one draft, one feed.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  MainWindow();
  ~MainWindow() override;

  /// Shows itself and does what the command line asks for.
  void start(const Options& options);
  /// Before an end that asks nobody.
  void keepUnsavedEdits();

  // What menus, drops and tests call. All of them report failures in the Messages dock and leave the state
  // untouched.
  bool openPreset(const QString& nameOrFile);
  bool savePreset(const QString& file);
  void openTerrain(const QString& source);
  bool openFlight(const QString& file);
  /// A head log, or a sweep as `--head` takes it.
  bool openHead(const QString& fileOrSweep);
  /// By content's ending: preset, flight, else terrain.
  void openAny(const QString& path);
  bool exportPreset(const QString& file, ExportFormat format, const QString& author, const QString& comment);
  bool startTrace(const QString& file);
  void stopTrace();
  void setFrozen(bool frozen);
  void resetLayout();

  views::Draft& draft() { return draft_; }
  Document& document() { return document_; }
  Feed& feed() { return feed_; }
  Viewport& viewport() { return *viewport_; }
  MessagePanel& messages() { return *messages_; }
  TerrainJob& terrainJob() { return terrainJob_; }
  HostDock& hostDock() { return *hostDock_; }
  FlightDock& flightDock() { return *flightDock_; }
  ExperimentsDock& experiments() { return *experiments_; }
  ErrorDock& errors() { return *errors_; }
  /// Null until it was asked for.
  SplitView* splitView() const { return split_; }
  void showSplitView();
  SymbologyEditor& symbologyEditor() { return symbologyEditor_; }
  NoticeBar& notices() { return *notices_; }
  bool hasTerrain() const { return terrain_ != nullptr; }
  QDockWidget* dock(const QString& name) const;

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  // main_window.cpp: what it is made of
  void makeStatusBar();
  void connectParts();
  // window_docks.cpp
  /// Order of the places a dock can stand at.
  enum class DockPlace { edit, effect, foot };
  struct Dock {
    QDockWidget* widget;
    DockPlace place;
  };
  /// A panel with `showFrame` is told every frame.
  template <class Panel>
  Panel* addDock(const char* name, const QString& title, DockPlace place, Panel* content);
  void makeDocks();
  void raiseEditorOf(const QString& key);
  void arrangeDocks();
  // window_menus.cpp
  void makeMenus();
  void makeFileMenu();
  void makeEditMenu();
  void makeViewMenu();
  void makeFlightMenu();
  void makeHelpMenu();
  void fillRecentMenu();
  void remember(const QString& kind, const QString& path);
  void showKeys();
  void showReference();
  void showAbout();
  // window_files.cpp
  bool mayLoseEdits();
  bool save();
  bool saveAs();
  void askOpenPreset();
  void askOpenTerrain(bool folder);
  void askOpenFlight();
  void askExport();
  void askTrace();
  void offerRecovery();
  void onChangedOnDisk(bool gone);
  void onTerrainOpened(std::shared_ptr<const terrain::Database> database);
  void drainTrace(bool all);
  std::optional<ExperimentInputs> experimentInputs(const QString& folder);
  void updateTitle();
  // window_motion.cpp
  void connectMotion();
  void showHeadSource();
  void askOpenHead();
  // window_frame.cpp
  std::optional<Picture> picture(int widthPx, int heightPx);
  void onPainted();
  void onDecision();
  void onSource();
  void onLink();
  void placeCamera();
  views::LiveFrame liveFrame() const;
  void showInDocks(const views::LiveFrame& frame);
  QString hudText(const AircraftState& eye) const;
  void takeScreenshot();
  // window_error.cpp
  ErrorDock* makeErrorDock();
  void connectErrors();
  void raiseErrors();
  void rememberShown();
  void followErrors();
  void followFlight();
  QString whyNotMeasured();
  void seekFlight(double timeS);
  // window_terrain.cpp
  views::TerrainPanel* makeTerrainPanel();
  void showTerrain();
  /// With files and folders to begin with.
  void askBake(const QStringList& sources = {});
  LevelsFrame levelsDrawn(const FrameResult& result) const;
  // window_culling.cpp
  views::CullingPanel* makeCullingPanel();
  void connectCulling();
  void showDepthMap(const QImage& grey);
  void showPicked(std::uint32_t node);
  // window_weather.cpp
  void calibrateWeather();

  views::Draft draft_;
  Document document_{draft_};
  Feed feed_{draft_.active()};
  TerrainJob terrainJob_;
  std::shared_ptr<const terrain::Database> terrain_;
  QString terrainSource_;  ///< what was asked for last; empty for the sample
  QString openedTerrain_;  ///< where `terrain_` comes from
  DrawThread measuring_;

  SymbologyEditor symbologyEditor_{draft_};
  Viewport* viewport_ = nullptr;
  NoticeBar* notices_ = nullptr;
  std::vector<Dock> docks_;
  std::vector<std::function<void(const views::LiveFrame&)>> liveDocks_;
  views::BandsEditor* bands_ = nullptr;
  views::CullingPanel* culling_ = nullptr;
  views::PlotsPanel* plots_ = nullptr;
  views::MotionPanel* motion_ = nullptr;
  views::StaticLodPanel* staticLod_ = nullptr;
  views::TerrainPanel* terrainPanel_ = nullptr;
  HostDock* hostDock_ = nullptr;
  FlightDock* flightDock_ = nullptr;
  ExperimentsDock* experiments_ = nullptr;
  ErrorDock* errors_ = nullptr;
  SplitView* split_ = nullptr;
  MessagePanel* messages_ = nullptr;
  QByteArray defaultLayout_;

  QList<QAction*> terrainActions_, overlayActions_, cullingActions_;  ///< that docks have as buttons too
  QMenu *recentMenu_ = nullptr, *dockMenu_ = nullptr;
  QAction *freezeAction_ = nullptr, *traceAction_ = nullptr;
  QActionGroup* caseActions_ = nullptr;
  QLabel *sourceLabel_ = nullptr, *jobLabel_ = nullptr;
  QProgressBar* jobBar_ = nullptr;
  QPushButton* jobCancel_ = nullptr;

  Overlays overlays_;
  std::optional<EyePose> frozenEye_;
  std::optional<FrameRequest> shown_;     ///< the last request
  std::deque<FrameRequest> shownBefore_;  ///< while errors are measured; oldest first
  std::optional<TraceWriter> trace_;
  std::vector<TraceRow> traceRows_;
  std::uint64_t traceCount_ = 0;
  // Of the terrain, what the Messages dock has told of.
  std::uint64_t pagesFailed_ = 0;
  LevelsFrame levels_;  ///< of the last picture
  std::size_t damageTold_ = 0;
  QString saidOfFlight_;               ///< why the results' times mean nothing in the open flight
  QString traceFile_, recordedTrace_;  ///< being written; the last one that is whole
  FrameCost lastCost_;
  QElapsedTimer sincePicture_, sinceStart_;
  double fps_ = std::numeric_limits<double>::quiet_NaN();
  Options options_;
  bool scheduledShot_ = false;
};

}  // namespace trimtab::workbench
