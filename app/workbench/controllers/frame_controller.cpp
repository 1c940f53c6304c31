// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame_controller.h"

#include <QTimer>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/link/link.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/jobs/feed.h"
#include "image_text.h"
#include "terrain_controller.h"
#include "terrain_summary.h"
#include "trimtab/hold/cost_model_file.h"
#include "views/model/draft.h"

namespace trimtab::workbench {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// A longer gap between two images is no frame rate: they are drawn on demand.
constexpr double kLongestRateGapS = 0.5;
/// Each image moves the displayed rate by this share of the way to its own.
constexpr double kRateShare = 0.1;
constexpr double kUnseenStretch = 0.01;
/// How soon an image that lacks pages of the terrain is drawn again.
constexpr int kPageWaitMs = 15;

/// Returns the largest size inside the widget at which pixels are square in the view. A preset gives both
/// fields of view, so a widget of another shape would stretch the image. Returns the widget's own size if
/// that stretches by at most a hundredth, which nobody sees.
QSize squarePixels(const TuningParameters& parameters, const Session& session, QSize widget) {
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

}  // namespace

FrameController::FrameController(const Workplace& workplace, const TerrainController& terrain)
    : at_(workplace), terrain_(terrain) {
  sinceStart_.start();
  Viewport& viewport = at_.viewport;
  viewport.setSource([this](int widthPx, int heightPx) { return picture(widthPx, heightPx); });
  connect(&viewport, &Viewport::painted, this, &FrameController::onPainted);
  connect(&viewport, &Viewport::glFailed, this, [this](const QString& why) {
    at_.messages.add(tr("The terrain cannot be drawn"),
                     {{Severity::error, "OpenGL", "", "what the renderer needs", why.toStdString()}});
  });
  connect(&at_.feed, &Feed::statesArrived, &viewport, &Viewport::invalidate);
  connect(&at_.feed, &Feed::flightChanged, &viewport, &Viewport::invalidate);
  connect(&at_.feed, &Feed::decisionChanged, this, &FrameController::onDecision);
  connect(&at_.draft, &views::Draft::activeChanged, this, [this] {
    at_.feed.session().setParameters(at_.draft.active());
    onDecision();
    at_.viewport.invalidate();
  });
}

FrameController::~FrameController() {
  if (!recalled_) return;
  const Findings found = rememberCostModel(at_.feed.session().hold().model(), at_.viewport.gl().renderer);
  // There is no window any more that could show it.
  if (!found.empty())
    std::fprintf(stderr, "trimtab: what images cost is not remembered: %s\n", toString(found).c_str());
}

void FrameController::setOverlays(const Overlays& overlays) {
  overlays_ = overlays;
  at_.viewport.invalidate();
}

void FrameController::setFrozenEye(const std::optional<EyePose>& eye) {
  frozenEye_ = eye;
  at_.viewport.invalidate();
}

std::optional<Picture> FrameController::picture(int widthPx, int heightPx) {
  const double now = link::now();
  Session& session = at_.feed.session();
  at_.feed.advance(now);
  const QSize square = squarePixels(*session.parameters(), session, {widthPx, heightPx});
  std::optional<FrameRequest> request = session.request(now, square.width(), square.height());
  if (!request) return std::nullopt;
  request->overlays = overlays_;
  request->frozenEye = frozenEye_;
  if (shown_) emit replaced(*shown_);
  shown_ = request;

  Picture picture;
  const auto& last = at_.viewport.lastResult();
  const Legend legend = legendOf(*request, last && last->patches, *terrain_.database());
  picture.request = std::move(*request);
  picture.overlay.frozen = frozenEye_.has_value();
  picture.overlay.legendTitle = legend.title;
  picture.overlay.legend = legend.entries;
  picture.again = at_.feed.movesOnItsOwn(now);
  picture.hud = [this, eye = session.eyeState(now)] { return hud(eye); };
  return picture;
}

QString FrameController::hud(const AircraftState& eye) const {
  HudFacts facts{eye, at_.viewport.lastResult().get(), terrain_.database().get(), fps_, {}};
  if (at_.feed.source() == Feed::Source::camera)
    facts.cameraSpeed = MetresPerSecond{at_.viewport.camera().speedMps()};
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
  if (!std::exchange(recalled_, true))
    if (const Findings found = recallCostModel(model, at_.viewport.gl().renderer); !found.empty())
      at_.messages.add(tr("The costs of an image are learned anew"), found);
  lastCost_ = at_.feed.session().finished(*result, link::now());
  levels_ = levelsDrawn(*result, *terrain_.database());
  views::LiveFrame frame = liveFrame();
  frame.newImage = true;
  emit frameShown(frame);
  emit painted();
  // A page that was missing may have been read by then.
  if (!result->paging.settled) QTimer::singleShot(kPageWaitMs, &at_.viewport, &Viewport::invalidate);
}

/// Between two images: the decision is new; the result and its cost are the last image's.
void FrameController::onDecision() {
  if (at_.feed.session().hasState()) emit frameShown(liveFrame());
}

views::LiveFrame FrameController::liveFrame() const {
  views::LiveFrame frame;
  frame.time = clock();
  frame.input = at_.feed.session().input();
  frame.decision = at_.feed.session().decision();
  frame.cost = lastCost_;
  frame.fps = fps_;
  frame.result = at_.viewport.lastResult();
  if (frame.result) frame.levels = levels_;
  if (shown_) frame.hold = shown_->hold;
  frame.holdOutcome = at_.feed.session().hold().outcome();
  return frame;
}

}  // namespace trimtab::workbench
