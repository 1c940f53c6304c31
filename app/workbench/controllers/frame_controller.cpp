// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame_controller.h"

#include <QSettings>
#include <QTimer>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/link/link.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/viewport/box_outline.h"
#include "image_text.h"
#include "observer_controller.h"
#include "terrain_controller.h"
#include "terrain_summary.h"
#include "trimtab/hold/cost_model_file.h"
#include "trimtab/units/not_finite.h"
#include "views/model/draft.h"

namespace trimtab::workbench {
namespace {

const QString kFillsKey = QStringLiteral("viewport/fills");
/// A longer gap between two images is no frame rate: they are drawn on demand.
constexpr double kLongestRateGapS = 0.5;
/// Each image moves the displayed rate by this share of the way to its own.
constexpr double kRateShare = 0.1;
constexpr double kUnseenStretch = 0.01;
/// How soon an image that misses pages of the terrain is drawn again.
constexpr int kPageWaitMs = 15;

/// Returns the largest size inside the widget at which pixels are square in the view. A preset gives both
/// fields of view, so a widget of another shape would stretch the image. Returns the widget's own size if
/// that stretches by at most a hundredth, which nobody sees.
QSize squarePixels(const Session& session, QSize widget) {
  const TuningParameters& parameters = *session.parameters();
  if (parameters.view.renderSize != RenderSize::fit || !session.hasState() || widget.isEmpty()) return widget;
  const ViewShape view =
      viewShape(parameters.view, widget.width(), widget.height(), session.input().state.view);
  const double wanted = (view.right - view.left) / (view.top - view.bottom);
  const double shape = double(widget.width()) / widget.height();
  if (!(wanted > 0) || std::abs(shape / wanted - 1) <= kUnseenStretch) return widget;
  const QSize fits = shape > wanted ? QSize(int(std::lround(widget.height() * wanted)), widget.height())
                                    : QSize(widget.width(), int(std::lround(widget.width() / wanted)));
  return fits.expandedTo({1, 1});
}

/// Returns the request without the overlays that only the observer sees. Those of static trees stay, because
/// the form and the levels of the terrain depend on them.
FrameRequest pilotsOwn(FrameRequest request) {
  Overlays& all = request.overlays;
  Overlays kept;
  kept.treeDepth = all.treeDepth;
  kept.treePicture = all.treePicture;
  kept.textureSquares = all.textureSquares;
  all = kept;
  return request;
}

}  // namespace

FrameController::FrameController(const Workplace& workplace, const TerrainController& terrain,
                                 ObserverController& observer)
    : at_(workplace),
      terrain_(terrain),
      observer_(observer),
      fit_(QSettings().value(kFillsKey, true).toBool() ? ViewFit::fill : ViewFit::preset) {
  sinceStart_.start();
  Viewport& viewport = at_.viewport;
  viewport.setSource([this](int widthPx, int heightPx) { return nextImage(widthPx, heightPx); });
  connect(&viewport, &Viewport::painted, this, &FrameController::onPainted);
  connect(&viewport, &Viewport::glFailed, this, [this](const QString& why) {
    at_.messages.add(tr("The terrain cannot be drawn"),
                     {{Severity::error, "OpenGL", "", "what the renderer needs", why.toStdString()}});
  });
  connect(&at_.feed, &Feed::statesArrived, &viewport, &Viewport::invalidate);
  connect(&at_.feed, &Feed::flightChanged, &viewport, &Viewport::invalidate);
  connect(&at_.feed, &Feed::decisionChanged, this, &FrameController::onDecision);
  connect(&observer_, &ObserverController::changed, this, &FrameController::onDecision);
  connect(&at_.draft, &views::Draft::activeChanged, this, [this] {
    at_.feed.session().setParameters(at_.draft.active());
    onDecision();
    at_.viewport.invalidate();
  });
}

FrameController::~FrameController() {
  // The viewport and the window are gone: neither can be asked or show anything.
  if (machine_.empty()) return;
  const Findings found = rememberCostModel(at_.feed.session().hold().model(), machine_);
  if (!found.empty())
    std::fprintf(stderr, "trimtab: what images cost is not remembered: %s\n", toString(found).c_str());
}

void FrameController::setOverlays(const Overlays& overlays) {
  overlays_ = overlays;
  at_.viewport.invalidate();
}

void FrameController::setFills(bool fills) {
  fit_ = fills ? ViewFit::fill : ViewFit::preset;
  QSettings().setValue(kFillsKey, fills);
  at_.viewport.invalidate();
}

void FrameController::setOutline(const std::optional<Box>& box) {
  if (!outlined_ && !box) return;
  outlined_ = box;
  at_.viewport.invalidate();
}

const Session& FrameController::session() const {
  return observer_.pilot();
}

std::optional<NextImage> FrameController::nextImage(int widthPx, int heightPx) {
  const double now = link::now();
  at_.feed.advance(now);
  const QSize widget(widthPx, heightPx);
  std::optional<FrameRequest> request =
      observer_.request(now, fills() ? widget : squarePixels(session(), widget), fit_);
  if (!request) return std::nullopt;
  request->overlays = overlays_;
  if (shown_) emit replaced(*shown_);
  shown_ = request;

  NextImage next;
  const auto& last = at_.viewport.lastResult();
  const Legend legend = legendOf(*request, last && last->patches, *terrain_.database());
  next.overlay.banner = observer_.banner();
  next.overlay.legendTitle = legend.title;
  next.overlay.legend = legend.entries;
  next.again = observer_.movesOnItsOwn(now);
  if (observer_.apart()) {
    if (observer_.detached()) next.pilot = pilotsOwn(*request);
    next.request = observer_.seen(*request);
    AircraftState eye;
    eye.position = next.request.eye;
    eye.attitude = next.request.attitude;
    next.hud = [this, eye] { return hud(eye); };
  } else {
    next.request = std::move(*request);
    next.hud = [this, eye = session().eyeState(now)] { return hud(eye); };
  }
  if (outlined_) {
    const FrameRequest& r = next.request;
    const LocalFrame& local = terrain_.database()->index().frame;
    next.overlay.outline =
        outlineOf(*outlined_, {local.fromGeodetic(r.eye), eyeAxes(local, r.eye, r.attitude)}, r.view);
  }
  return next;
}

FrameCost FrameController::costOf(const FrameResult& result) const {
  return observer_.frozen() ? result.cost : at_.feed.session().costOf(result);
}

QString FrameController::hud(const AircraftState& eye) const {
  const FrameResult* const result = at_.viewport.lastResult().get();
  HudFacts facts{eye, result, result ? costOf(*result).total : kNan, terrain_.database().get(), fps_, {}};
  if (at_.viewport.cameraEnabled()) facts.cameraSpeed = MetresPerSecond{at_.viewport.camera().speedMps()};
  return hudText(facts);
}

void FrameController::onPainted() {
  const auto& result = at_.viewport.lastResult();
  // Another terrain was opened between the image and its display.
  if (!result) return;
  const double gap = sinceImage_.isValid() ? double(sinceImage_.nsecsElapsed()) * 1e-9 : kNan;
  sinceImage_.start();
  if (gap > 0 && gap < kLongestRateGapS)
    fps_ = std::isfinite(fps_) ? fps_ + (1 / gap - fps_) * kRateShare : 1 / gap;
  else
    fps_ = kNan;
  CostModel& model = at_.feed.session().hold().model();
  if (machine_.empty()) {
    machine_ = machineName(at_.viewport.gl().renderer);
    if (const Findings found = recallCostModel(model, machine_); !found.empty())
      at_.messages.add(tr("The costs of an image are learned anew"), found);
  }
  lastCost_ = costOf(*result);
  if (!observer_.frozen()) at_.feed.session().finished(*result, link::now());
  if (const auto& why = model.whyAnew(); why && !std::exchange(saidAnew_, true))
    at_.messages.add(tr("The costs of an image are learned anew"), {*why});
  levels_ = levelsDrawn(*result, *terrain_.database());
  views::LiveFrame frame = liveFrame();
  frame.newImage = true;
  emit frameShown(frame);
  emit painted();
  // A page that was missing may have been read by then.
  if (!result->paging.settled) QTimer::singleShot(kPageWaitMs, &at_.viewport, &Viewport::invalidate);
  if (shown_ && !observer_.frozen())
    at_.feed.session().builtAhead(
        at_.viewport.buildAhead(at_.feed.session().nodesAhead(*shown_), session().aheadMs()).left);
}

/// Between two images: the decision is new; the result and its cost are the last image's.
void FrameController::onDecision() {
  if (session().hasState()) emit frameShown(liveFrame());
}

views::LiveFrame FrameController::liveFrame() const {
  views::LiveFrame frame;
  frame.time = clock();
  frame.input = session().input();
  frame.input.signalValues = session().signalValues();
  frame.decision = session().decision();
  frame.cost = lastCost_;
  frame.counts = counts();
  frame.fps = fps_;
  frame.result = at_.viewport.lastResult();
  if (frame.result) frame.levels = levels_;
  if (shown_) {
    frame.levers = shown_->levers;
    frame.hold = shown_->hold;
    frame.holdGains = gainsOf(session().hold().given(), frame.hold, session().parameters()->hold);
  }
  frame.flip = flip_;
  frame.holdOutcome = session().hold().outcome();
  return frame;
}

}  // namespace trimtab::workbench
