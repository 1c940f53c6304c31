// SPDX-License-Identifier: GPL-3.0-or-later
#include <QCoreApplication>
#include <QEvent>
#include <QLabel>
#include <QStatusBar>
#include <QTimer>
#include <cmath>
#include <cstdio>
#include <limits>

#include "app/link/link.h"
#include "app/workbench/dialogs/export_dialog.h"
#include "app/workbench/docks/experiments_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/host_dock.h"
#include "main_window.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/overlay_colours.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/static_lod/static_lod.h"
#include "views/editors/bands_editor.h"

// From states to pictures and from pictures to docks.
namespace trimtab::workbench {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Pictures farther apart than this are not a rate: they are drawn on demand.
constexpr double kLongestRateGapS = 0.5;
constexpr double kStretchUnseen = 0.01;

QColor colourOf(const std::array<std::uint8_t, 3>& c) {
  return {c[0], c[1], c[2]};
}

QList<LegendEntry> reasonLegend() {
  return {{MainWindow::tr("drawn"), colourOf(scene::reasonColour(CullReason::drawn))},
          {MainWindow::tr("outside the frustum"), colourOf(scene::reasonColour(CullReason::outside_frustum))},
          {MainWindow::tr("occluded"), colourOf(scene::reasonColour(CullReason::occluded))},
          {MainWindow::tr("beyond visibility"), colourOf(scene::reasonColour(CullReason::beyond_visibility))},
          {MainWindow::tr("facing away"), colourOf(scene::reasonColour(CullReason::back_facing))}};
}

QList<LegendEntry> levelLegend(std::size_t levels) {
  QList<LegendEntry> entries;
  for (int level = 0; level < static_cast<int>(levels); ++level)
    entries.append({MainWindow::tr("level %1").arg(level), colourOf(scene::levelColour(level))});
  return entries;
}

QList<LegendEntry> pictureLegend() {
  return {{MainWindow::tr("face"), QColor(214, 214, 214)},
          {MainWindow::tr("edge"), QColor(217, 0, 0)},
          {MainWindow::tr("locked edge"), QColor(0, 0, 0)}};
}

/// The largest size inside the widget whose pixels are square in the view: both fields of view are given, so
/// that the widget's own shape would stretch the picture. The whole widget where that is within a hundredth.
QSize squarePixels(const TuningParameters& parameters, const Session& session, QSize widget) {
  if (parameters.view.renderSize != RenderSize::fit || !session.hasState() || widget.isEmpty()) return widget;
  const ViewShape view =
      viewShape(parameters.view, widget.width(), widget.height(), session.input().state.view);
  const double wanted = (view.right - view.left) / (view.top - view.bottom);
  const double shape = double(widget.width()) / widget.height();
  if (!(wanted > 0) || std::abs(shape / wanted - 1) <= kStretchUnseen) return widget;
  const QSize fits = shape > wanted ? QSize(int(std::lround(widget.height() * wanted)), widget.height())
                                    : QSize(widget.width(), int(std::lround(widget.width() / wanted)));
  return fits.expandedTo({1, 1});
}

}  // namespace

std::optional<Picture> MainWindow::picture(int widthPx, int heightPx) {
  const double now = link::now();
  feed_.advance(now);
  const QSize square = squarePixels(*feed_.session().parameters(), feed_.session(), {widthPx, heightPx});
  std::optional<FrameRequest> request = feed_.session().request(now, square.width(), square.height());
  if (!request) return std::nullopt;
  request->overlays = overlays_;
  request->frozenEye = frozenEye_;
  rememberShown();
  shown_ = request;
  Picture picture;
  picture.request = std::move(*request);
  picture.overlay.frozen = frozenEye_.has_value();
  picture.again = feed_.movesOnItsOwn(now);
  picture.hud = [this, eye = feed_.session().eyeState(now)] { return hudText(eye); };
  if (overlays_.treePicture && terrain_->staticLod()) {
    picture.overlay.legendTitle = tr("Document E's picture");
    picture.overlay.legend = pictureLegend();
  } else if (overlays_.colourByReason) {
    picture.overlay.legendTitle = tr("Why a tile is drawn or not");
    picture.overlay.legend = reasonLegend();
  } else if (overlays_.colourByLevel && terrain_->staticLod() && asksForTrees(picture.request)) {
    picture.overlay.legendTitle = tr("Depth in the static trees, 0 is the root");
    picture.overlay.legend = levelLegend(terrain_->staticLod()->counts.levels);
  } else if (overlays_.colourByLevel && viewport_->lastResult() && viewport_->lastResult()->patches) {
    picture.overlay.legendTitle = tr("Depth of the patches, 0 is the coarsest");
    // The deepest stand last.
    const auto& depth = terrain_->patches()->index().depth;
    picture.overlay.legend = levelLegend(depth.empty() ? 0 : depth.back() + std::size_t{1});
  } else if (overlays_.colourByLevel) {
    picture.overlay.legendTitle = tr("Level of detail, 0 is finest");
    picture.overlay.legend = levelLegend(terrain_->index().levels.size());
  }
  return picture;
}

QString MainWindow::hudText(const AircraftState& eye) const {
  QStringList parts;
  parts << tr("%L1 ft").arg(eye.position.height.in<Feet>(), 0, 'f', 0);
  parts << tr("heading %1°")
               .arg(std::fmod(std::round(eye.attitude.heading.value()) + 360, 360.0), 3, 'f', 0,
                    QLatin1Char('0'));
  parts << tr("pitch %1°").arg(eye.attitude.pitch.value(), 0, 'f', 1);
  if (const auto& last = viewport_->lastResult()) {
    parts << tr("%L1 triangles").arg(last->visible.triangles);
    parts << tr("%1 ms").arg(last->cost.total, 0, 'f', 1);
  }
  if (terrain_ && !terrain_->heightAt(eye.position.latitude, eye.position.longitude))
    parts << tr("not over the terrain");
  if (std::isfinite(fps_)) parts << tr("%1 fps").arg(fps_, 0, 'f', 0);
  if (feed_.source() == Feed::Source::camera)
    parts << tr("free camera, keys move it at %L1 kt")
                 .arg(MetresPerSecond{viewport_->camera().speedMps()}.in<Knots>(), 0, 'f', 0);
  return parts.join(QStringLiteral("   "));
}

void MainWindow::onPainted() {
  const double gap = sincePicture_.isValid() ? double(sincePicture_.nsecsElapsed()) * 1e-9 : kNan;
  sincePicture_.start();
  if (gap > 0 && gap < kLongestRateGapS)
    fps_ = std::isfinite(fps_) ? fps_ + (1 / gap - fps_) * 0.1 : 1 / gap;
  else
    fps_ = kNan;
  lastCost_ = feed_.session().finished(*viewport_->lastResult(), link::now());
  levels_ = levelsDrawn(*viewport_->lastResult());
  drainTrace(false);
  showInDocks(liveFrame());
  followErrors();
  if (const std::uint64_t failed = viewport_->lastResult()->paging.failed; failed != pagesFailed_) {
    if (failed > pagesFailed_)
      messages_->add(tr("The terrain stays coarser where its pages cannot be read"),
                     viewport_->pageFailures());
    pagesFailed_ = failed;
  }
  if (const Findings damage = terrain_ ? terrain_->damage() : Findings{}; damage.size() != damageTold_) {
    messages_->add(tr("The terrain's heights are damaged; where they are, its lowest ground is drawn"),
                   damage);
    damageTold_ = damage.size();
  }
  // What was drawn coarser for want of a page is drawn again when it may be there.
  constexpr int kPageWaitMs = 15;
  if (!viewport_->lastResult()->paging.settled)
    QTimer::singleShot(kPageWaitMs, viewport_, &Viewport::invalidate);
  if (options_.afterS >= 0 && !options_.screenshot.isEmpty() && !scheduledShot_) {
    scheduledShot_ = true;
    QTimer::singleShot(static_cast<int>(options_.afterS * 1000), this, &MainWindow::takeScreenshot);
  }
}

/// Between two pictures: the decision is new, the picture and its cost are the last one's.
void MainWindow::onDecision() {
  if (!feed_.session().hasState()) return;
  showInDocks(liveFrame());
}

void MainWindow::changeEvent(QEvent* event) {
  QMainWindow::changeEvent(event);
  if (event->type() == QEvent::WindowStateChange) feed_.setPicturesDrawn(!isMinimized());
}

views::LiveFrame MainWindow::liveFrame() const {
  views::LiveFrame frame;
  frame.time = double(sinceStart_.nsecsElapsed()) * 1e-9;
  frame.input = feed_.session().input();
  frame.decision = feed_.session().decision();
  frame.cost = lastCost_;
  frame.fps = fps_;
  frame.result = viewport_->lastResult();
  if (frame.result) frame.levels = levels_;
  return frame;
}

void MainWindow::showInDocks(const views::LiveFrame& frame) {
  for (const auto& show : liveDocks_) show(frame);
}

void MainWindow::setFrozen(bool frozen) {
  if (frozen && shown_ && terrain_) {
    const LocalFrame& local = terrain_->index().frame;
    frozenEye_ = EyePose{local.fromGeodetic(shown_->eye), eyeAxes(local, shown_->eye, shown_->attitude)};
  } else {
    frozenEye_.reset();
  }
  viewport_->invalidate();
}

/// South of the middle, looking north over it, above the ground there.
void MainWindow::placeCamera() {
  const terrain::TerrainInfo& info = terrain_->info();
  GeodeticPosition at = scene::placeIn(info, 0.5, 0.3);
  const std::optional<Metres> ground = terrain_->highestWithin(at.latitude, at.longitude, Metres{4000});
  at.height = (ground ? *ground : info.highest) + Feet{1500}.as<Metres>();
  viewport_->camera().place(at, {Degrees{0}, Degrees{-6}, Degrees{0}});
}

void MainWindow::onSource() {
  const Feed::Source source = feed_.source();
  // The camera takes over where the aircraft is, wings level.
  if (source == Feed::Source::camera && shown_ && !viewport_->cameraEnabled()) {
    viewport_->camera().place(shown_->eye, {shown_->attitude.heading, shown_->attitude.pitch, Degrees{0}});
    feed_.look(viewport_->camera());
  }
  viewport_->setCameraEnabled(source == Feed::Source::camera);
  switch (source) {
    case Feed::Source::camera:
      sourceLabel_->setText(tr("free camera"));
      break;
    case Feed::Source::flight:
      sourceLabel_->setText(feed_.playback().playing() ? tr("flight") : tr("flight, paused"));
      break;
    case Feed::Source::host:
      onLink();
      break;
  }
}

void MainWindow::onLink() {
  if (feed_.receiver() == nullptr) {
    if (feed_.source() == Feed::Source::host) sourceLabel_->clear();
    return;
  }
  const std::uint16_t port = feed_.receiver()->port();
  switch (feed_.session().linkState(link::now())) {
    case LinkState::never:
      sourceLabel_->setText(tr("free camera, listening on port %1").arg(port));
      break;
    case LinkState::live:
    case LinkState::jumped:
      sourceLabel_->setText(tr("host on port %1").arg(port));
      break;
    case LinkState::silent:
      sourceLabel_->setText(tr("host on port %1 is SILENT").arg(port));
      messages_->note(tr("The host on port %1 fell silent; the picture stands still").arg(port));
      break;
  }
}

void MainWindow::start(const Options& options) {
  options_ = options;
  if (options.window) resize(*options.window);
  show();
  viewport_->setFocus();
  if (!options.preset.isEmpty()) openPreset(options.preset);
  if (options.terrain.isEmpty())
    terrainJob_.openSample();
  else
    openTerrain(options.terrain);
  if (!options.flight.isEmpty() && openFlight(options.flight)) flightDock_->play();
  if (!options.head.isEmpty()) openHead(options.head);
  if (options.listenPort) {
    hostDock_->setPort(*options.listenPort);
    hostDock_->connectHost();
  }
  if (options.screenshot.isEmpty()) {
    if (!options.exportFile.isEmpty())
      exportPreset(options.exportFile, exportFormatOf(options.exportFile), {}, {});
    offerRecovery();
  }
}

void MainWindow::takeScreenshot() {
  bool good = grab().save(options_.screenshot);
  if (!good)
    std::fprintf(stderr, "trimtab: the picture cannot be saved: %s\n", qPrintable(options_.screenshot));
  if (!options_.exportFile.isEmpty())
    good = exportPreset(options_.exportFile, exportFormatOf(options_.exportFile), {}, {}) && good;
  keepUnsavedEdits();
  QCoreApplication::exit(good ? 0 : 1);
}

void MainWindow::keepUnsavedEdits() {
  document_.keepCopyNow();
  stopTrace();
}

}  // namespace trimtab::workbench
