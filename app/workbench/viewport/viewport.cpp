// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewport.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QOpenGLFramebufferObject>
#include <QPainter>
#include <QScreen>
#include <QTimer>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>
#include <utility>

#include "symbology_editor.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::workbench {
namespace {

constexpr qint64 kDepthMapGapMs = 100;
const QColor kEmptyColour(38, 42, 48);

/// Returns where an image lies in the widget without being distorted. Device pixels, origin at the lower
/// left.
QRect letterbox(QSize image, QSize widget) {
  const QSize fits = image.scaled(widget, Qt::KeepAspectRatio);
  return {QPoint((widget.width() - fits.width()) / 2, (widget.height() - fits.height()) / 2), fits};
}

}  // namespace

Viewport::Viewport(QWidget* parent) : GlWidget(parent), notice_(tr("No terrain yet")) {
  setFocusPolicy(Qt::StrongFocus);
  setMinimumSize(320, 200);
  setAccessibleName(tr("Terrain view"));
  setAttribute(Qt::WA_AcceptTouchEvents, false);
  later_.setSingleShot(true);
  later_.setTimerType(Qt::PreciseTimer);
  connect(&later_, &QTimer::timeout, this, qOverload<>(&QWidget::update));
  qApp->installEventFilter(this);
  connect(this, &GlWidget::frameSwapped, this, [this] {
    if (unreported_) {
      tookMs_ = sincePaint_.elapsed();
      sinceShown_.start();
    }
    report();
    if (std::exchange(again_, false)) paintAgain();
  });
}

Viewport::~Viewport() {
  if (renderer_ == nullptr) return;
  makeCurrent();
  fixedSize_.reset();
  unseen_.reset();
  pilots_.reset();
  renderer_->release();
  doneCurrent();
}

void Viewport::initializeGL() {
  renderer_ = std::make_unique<scene::Renderer>();
  gl_ = renderer_->initialize();
  terrainChanged_ = true;
  if (!gl_.usable) {
    renderer_.reset();
    setNotice(tr("This display cannot draw the terrain: %1 (%2)")
                  .arg(QString::fromStdString(gl_.missing), QString::fromStdString(gl_.renderer)));
    emit glFailed(QString::fromStdString(gl_.missing));
  }
}

void Viewport::setTerrain(std::shared_ptr<const terrain::Database> database) {
  terrain_ = std::move(database);
  terrainChanged_ = true;
  // Its nodes belong to the old terrain.
  result_.reset();
  invalidate();
}

void Viewport::invalidate() {
  if (dirty_) return;
  dirty_ = true;
  if (isVisible()) update();
}

/// Returns how long the next image is to wait, so that controls answer in between.
qint64 Viewport::controlsFirstMs() const {
  constexpr qint64 kMostMs = 100;
  const qint64 pause = std::min(tookMs_, kMostMs);
  const bool inUse = controlHeld_ || (sinceClick_.isValid() && sinceClick_.elapsed() < pause);
  return inUse && sinceShown_.isValid() ? pause - sinceShown_.elapsed() : 0;
}

void Viewport::paintEvent(QPaintEvent* event) {
  const bool fits = sizePx() == paintedPx_ && !isGrabbed();
  if (fits && paused_) return showPaused();
  // Nothing has changed; the place was covered and is seen again.
  if (fits && !dirty_) return showAgain();
  const qint64 wait = controlsFirstMs();
  if (!fits || wait <= 1) return GlWidget::paintEvent(event);
  if (later_.isActive()) return showAgain();
  later_.start(int(wait));
}

bool Viewport::eventFilter(QObject* watched, QEvent* event) {
  if (watched->isWidgetType() && watched != this) {
    const auto type = event->type();
    if (type == QEvent::MouseButtonPress || type == QEvent::MouseButtonRelease) sinceClick_.start();
    // A drag of data ends without a release; the next move says that no button is down.
    if (type == QEvent::MouseButtonPress)
      controlHeld_ = true;
    else if (type == QEvent::MouseButtonRelease || type == QEvent::MouseMove)
      controlHeld_ = static_cast<QMouseEvent*>(event)->buttons() != Qt::NoButton;
  }
  return GlWidget::eventFilter(watched, event);
}

void Viewport::showEvent(QShowEvent* event) {
  GlWidget::showEvent(event);
  update();
}

void Viewport::setCameraEnabled(bool on) {
  cameraEnabled_ = on;
  if (!on) camera_.releaseAll();
}

void Viewport::setPaused(bool paused, const QString& why) {
  if (paused == paused_ && why == whyPaused_) return;
  // A reason over the image goes only with another image.
  dirty_ = dirty_ || !whyPaused_.isEmpty();
  paused_ = paused;
  whyPaused_ = why;
  if (!why.isEmpty()) {
    camera_.releaseAll();
    sinceMove_.invalidate();
  }
  if (isVisible()) update();
}

/// The last image, with the reason over it.
void Viewport::showPaused() {
  if (whyPaused_ != shownOverlay_.banner && !whyPaused_.isEmpty() && makeCurrent()) {
    shownOverlay_.banner = whyPaused_;
    paintFlat([this](QPainter& painter) { paintOverlay(painter, rect(), {.banner = whyPaused_}); });
  }
  showAgain();
}

void Viewport::setNotice(const QString& text) {
  notice_ = text;
  invalidate();
}

void Viewport::setDepthMapWanted(bool wanted) {
  if (!std::exchange(depthMapWanted_, wanted) && wanted) invalidate();
}

void Viewport::setPicking(bool on) {
  picking_ = on;
  pickAt_.reset();
  if (on)
    setCursor(Qt::CrossCursor);
  else
    unsetCursor();
}

/// Reads which node and which object own the clicked pixel of the image that was just drawn.
void Viewport::readPicked(QSize image) {
  const QRect at = letterbox(image, sizePx());
  const QPointF place = *std::exchange(pickAt_, std::nullopt) * devicePixelRatioF();
  const double across = (place.x() - at.left()) / at.width(),
               up = (height() * devicePixelRatioF() - place.y() - at.top()) / at.height();
  if (!(across >= 0 && across < 1 && up >= 0 && up < 1)) return;
  const std::size_t pixel =
      static_cast<std::size_t>(up * image.height()) * static_cast<std::size_t>(image.width()) +
      static_cast<std::size_t>(across * image.width());
  const auto numberIn = [pixel](const std::vector<std::uint32_t>& numbers) {
    return pixel < numbers.size() ? numbers[pixel] : scene::Renderer::kNoNode;
  };
  emit picked(numberIn(renderer_->readNodes()), numberIn(renderer_->readObjects()));
}

void Viewport::paintGL() {
  report();
  dirty_ = false;
  ++paints_;
  sincePaint_.start();
  paintedPx_ = sizePx();
  later_.stop();
  if (camera_.moving()) {
    const double step = sinceMove_.isValid() ? double(sinceMove_.nsecsElapsed()) * 1e-9 : 1.0 / 60;
    sinceMove_.start();
    camera_.advance(step);
    emit cameraMoved();
  } else if (sinceMove_.isValid()) {
    sinceMove_.invalidate();
    emit cameraMoved();  // it stands now
  }

  const QSize pixels = sizePx();
  std::optional<NextImage> next;
  if (renderer_ != nullptr && terrain_ != nullptr && source_) next = source_(pixels.width(), pixels.height());
  if (next) {
    FrameRequest& described = next->pilot ? *next->pilot : next->request;
    described.wholeHorizon = depthMapWanted_;
    drawNext(*next, pixels.width(), pixels.height());
    placeImage(*next, pixels);
    next->overlay.image = imageAt_;
    showInset(next->overlay);
    if (next->hud) next->overlay.hud = next->hud();
  } else {
    QOpenGLFunctions& gl = *context()->functions();
    gl.glClearColor(float(kEmptyColour.redF()), float(kEmptyColour.greenF()), float(kEmptyColour.blueF()), 1);
    gl.glClear(GL_COLOR_BUFFER_BIT);
  }
  again_ = camera_.moving() || (next && next->again);
  unreported_ = next.has_value();
  shownOverlay_ = next ? std::move(next->overlay) : OverlayContents{.notice = notice_};
  if (!whyPaused_.isEmpty()) shownOverlay_.banner = whyPaused_;
  paintFlat([this](QPainter& painter) {
    paintOverlay(painter, rect(), shownOverlay_);
    if (editor_ != nullptr) editor_->paint(painter);
  });
}

void Viewport::report() {
  if (std::exchange(unreported_, false)) emit painted();
}

/// A display without vertical sync would otherwise be painted as fast as one core can.
void Viewport::paintAgain() {
  const double refreshHz = screen() != nullptr && screen()->refreshRate() >= 1 ? screen()->refreshRate() : 60;
  const qint64 wait =
      static_cast<qint64>(1000 / refreshHz) - (sincePaint_.isValid() ? sincePaint_.elapsed() : 0);
  if (wait <= 1) return invalidate();
  QTimer::singleShot(wait, Qt::PreciseTimer, this, &Viewport::invalidate);
}

void Viewport::drawNext(const NextImage& next, int widthPx, int heightPx) {
  if (terrainChanged_) {
    renderer_->setTerrain(terrain_);
    terrainChanged_ = false;
  }
  QOpenGLExtraFunctions& gl = *context()->extraFunctions();
  const QSize wanted(next.request.view.widthPx, next.request.view.heightPx), have(widthPx, heightPx);
  if (next.pilot)
    drawPilot(*next.pilot);
  else
    pilots_.reset();
  if (wanted == have) {
    fixedSize_.reset();
    drawImage(next, framebuffer());
  } else {
    if (fixedSize_ == nullptr || fixedSize_->size() != wanted)
      fixedSize_ = std::make_unique<QOpenGLFramebufferObject>(wanted);
    drawImage(next, fixedSize_->handle());
    bindFramebuffer();
    gl.glDisable(GL_SCISSOR_TEST);
    gl.glClearColor(0, 0, 0, 1);
    gl.glClear(GL_COLOR_BUFFER_BIT);
    const QRect to = letterbox(wanted, have);
    gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, fixedSize_->handle());
    gl.glBlitFramebuffer(0, 0, wanted.width(), wanted.height(), to.left(), to.top(), to.left() + to.width(),
                         to.top() + to.height(), GL_COLOR_BUFFER_BIT, GL_LINEAR);
  }
  if (pickAt_) readPicked(wanted);
  bindFramebuffer();
}

void Viewport::drawPilot(const FrameRequest& request) {
  const QSize size(request.view.widthPx, request.view.heightPx);
  if (pilots_ == nullptr || pilots_->size() != size)
    pilots_ = std::make_unique<QOpenGLFramebufferObject>(size);
  result_ = std::make_shared<const FrameResult>(renderer_->draw(request, pilots_->handle()));
  readDepthMap();
}

void Viewport::drawImage(const NextImage& next, unsigned framebuffer) {
  FrameResult result = renderer_->draw(next.request, framebuffer);
  if (next.pilot) return;
  result_ = std::make_shared<const FrameResult>(std::move(result));
  readDepthMap();
}

/// Copies the pilot's image over the observer's, which is in the widget already.
void Viewport::showInset(OverlayContents& overlay) {
  if (pilots_ == nullptr) return;
  overlay.inset = insetIn(imageAt_.toRect(), pilots_->size(), QFontMetrics(font()));
  const double scale = devicePixelRatioF();
  const QRect to(QPoint(int(overlay.inset.left() * scale),
                        int((height() - overlay.inset.top() - overlay.inset.height()) * scale)),
                 overlay.inset.size() * scale);
  QOpenGLExtraFunctions& gl = *context()->extraFunctions();
  gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, pilots_->handle());
  gl.glBlitFramebuffer(0, 0, pilots_->width(), pilots_->height(), to.left(), to.top(), to.left() + to.width(),
                       to.top() + to.height(), GL_COLOR_BUFFER_BIT, GL_LINEAR);
  bindFramebuffer();
}

std::optional<Viewport::Measured> Viewport::measure(const FrameRequest& request) {
  if (renderer_ == nullptr || terrain_ == nullptr) return std::nullopt;
  makeCurrent();
  if (std::exchange(terrainChanged_, false)) renderer_->setTerrain(terrain_);
  const QSize size(request.view.widthPx, request.view.heightPx);
  if (unseen_ == nullptr || unseen_->size() != size)
    unseen_ = std::make_unique<QOpenGLFramebufferObject>(size);
  QOpenGLFunctions& gl = *context()->functions();
  gl.glFinish();
  QElapsedTimer timer;
  timer.start();
  const FrameResult result = renderer_->draw(request, unseen_->handle());
  gl.glFinish();
  const double ms = double(timer.nsecsElapsed()) * 1e-6;
  bindFramebuffer();
  doneCurrent();
  return Measured{ms, result.counters.tilesBuilt};
}

scene::BuiltAhead Viewport::buildAhead(std::span<const std::uint32_t> nodes, double withinMs) {
  if (renderer_ == nullptr || terrainChanged_ || nodes.empty()) return {};
  const bool current = QOpenGLContext::currentContext() == context();
  if (!current) makeCurrent();
  const scene::BuiltAhead ahead = renderer_->buildAhead(nodes, withinMs);
  if (!current) doneCurrent();
  return ahead;
}

void Viewport::readDepthMap() {
  if (!depthMapWanted_) return;
  if (sinceDepthMap_.isValid() && sinceDepthMap_.elapsed() < kDepthMapGapMs) {
    // The view may come to rest before the next reading is due: then this image would never be shown.
    if (!std::exchange(depthMapDue_, true))
      QTimer::singleShot(kDepthMapGapMs, this, [this] {
        depthMapDue_ = false;
        invalidate();
      });
    return;
  }
  sinceDepthMap_.start();
  constexpr int kBearings = 720;
  emit horizonRead(renderer_->readHorizon(kBearings));
  const scene::DistanceImage grey = renderer_->readDepthMap();
  if (grey.width <= 0 || grey.height <= 0) {
    emit depthMapRead({});
    return;
  }
  const QImage rows(grey.pixels.data(), grey.width, grey.height, grey.width, QImage::Format_Grayscale8);
  emit depthMapRead(rows.mirrored());
}

void Viewport::setSymbologyEditor(SymbologyEditor* editor) {
  editor_ = editor;
  connect(editor, &SymbologyEditor::changed, this, [this] {
    setMouseTracking(editor_->active() || pointerWanted_);
    if (!editor_->active()) unsetCursor();
    invalidate();
  });
}

void Viewport::placeImage(const NextImage& next, QSize pixels) {
  const ViewShape& view = next.request.view;
  const QRect at = letterbox({view.widthPx, view.heightPx}, pixels);
  const double scale = 1 / devicePixelRatioF();
  imageAt_ = {at.left() * scale, (pixels.height() - at.top() - at.height()) * scale, at.width() * scale,
              at.height() * scale};
  if (editor_ != nullptr && editor_->active()) editor_->setImage(next.request.symbology, view, imageAt_);
}

void Viewport::keyPressEvent(QKeyEvent* event) {
  if (editor_ != nullptr && editor_->key(*event)) return;
  if (!cameraEnabled_ || event->modifiers() & (Qt::ControlModifier | Qt::AltModifier) ||
      !camera_.press(event->key()))
    return GlWidget::keyPressEvent(event);
  invalidate();
}

void Viewport::keyReleaseEvent(QKeyEvent* event) {
  if (event->isAutoRepeat()) return;
  if (!camera_.release(event->key())) GlWidget::keyReleaseEvent(event);
}

void Viewport::focusOutEvent(QFocusEvent* event) {
  camera_.releaseAll();
  GlWidget::focusOutEvent(event);
}

void Viewport::setPointerWanted(bool wanted) {
  pointerWanted_ = wanted;
  setMouseTracking(wanted || (editor_ != nullptr && editor_->active()));
}

void Viewport::mousePressEvent(QMouseEvent* event) {
  if (editor_ != nullptr && event->button() == Qt::LeftButton && editor_->press(event->position())) {
    setCursor(editor_->cursor(event->position()));
    return;
  }
  if (picking_ && event->button() == Qt::LeftButton) {
    pickAt_ = event->position();
    return invalidate();
  }
  lastMouse_ = event->position();
}

void Viewport::mouseReleaseEvent(QMouseEvent* event) {
  if (editor_ != nullptr && editor_->release()) setCursor(editor_->cursor(event->position()));
}

void Viewport::mouseMoveEvent(QMouseEvent* event) {
  if (editor_ != nullptr && editor_->moveTo(event->position())) {
    setCursor(editor_->cursor(event->position()));
    return;
  }
  if (pointerWanted_ && !imageAt_.isEmpty()) {
    const QPointF from = (event->position() - imageAt_.center()) * 2;
    emit pointed({from.x() / imageAt_.width(), -from.y() / imageAt_.height()});
  }
  if (!cameraEnabled_ || picking_ || !(event->buttons() & Qt::LeftButton)) return;
  const QPointF moved = event->position() - lastMouse_;
  lastMouse_ = event->position();
  // The image follows the mouse: dragging over the height of the widget turns by 36 degrees, which is the
  // shipped field of view.
  const double degreesPerPx = 36.0 / std::max(1, height());
  camera_.look(Degrees{-moved.x() * degreesPerPx}, Degrees{moved.y() * degreesPerPx});
  emit cameraMoved();
  invalidate();
}

void Viewport::wheelEvent(QWheelEvent* event) {
  if (!cameraEnabled_) return;
  camera_.changeSpeed(event->angleDelta().y() / 120.0);
  invalidate();
}

}  // namespace trimtab::workbench
