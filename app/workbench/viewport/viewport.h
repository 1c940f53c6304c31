// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QImage>
#include <QRectF>
#include <QTimer>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "app/workbench/jobs/free_camera.h"
#include "gl_widget.h"
#include "overlay.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"

class QOpenGLFramebufferObject;

namespace trimtab::workbench {

class SymbologyEditor;

/// What the next image is made of. The viewport asks for it once per paint.
struct NextImage {
  FrameRequest request;
  /// If set, `request` shows what an observer sees of this one, which is drawn too, as an inset; `lastResult`
  /// and the depth maps are this one's.
  std::optional<FrameRequest> pilot;
  OverlayContents overlay;
  std::function<QString()> hud;  ///< called once the image is drawn; `lastResult` is its result by then
  bool again = false;            ///< something moves on its own: paint again as soon as the display is ready
};

/// Shows the terrain that scene::Renderer draws. It paints on demand only: any number of calls of
/// `invalidate` give one paint, and nothing is painted while it is hidden or paused. Controls go first: while
/// the mouse holds one, such as a point of a curve, and just after a click elsewhere, the viewport waits
/// after an image for as long as the image took, at most 100 ms. Without terrain it says how to open some.
class Viewport : public GlWidget {
  Q_OBJECT

 public:
  using Source = std::function<std::optional<NextImage>(int widthPx, int heightPx)>;

  explicit Viewport(QWidget* parent = nullptr);
  ~Viewport() override;

  void setSource(Source source) { source_ = std::move(source); }
  void setTerrain(std::shared_ptr<const terrain::Database> database);
  void invalidate();
  FreeCamera& camera() { return camera_; }
  /// Mouse and keys move the camera only while this is on.
  void setCameraEnabled(bool on);
  bool cameraEnabled() const { return cameraEnabled_; }
  /// While the editor is active, it receives mouse and keys first.
  void setSymbologyEditor(SymbologyEditor* editor);
  /// While this is on, `pointed` reports where in the image the pointer is, whether a button is pressed or
  /// not.
  void setPointerWanted(bool wanted);
  /// While this is on, nothing is drawn but what a new size needs. `why` stands over the last image, and keys
  /// that are held are released; with an empty one, for a moment, the camera flies on.
  void setPaused(bool paused, const QString& why);
  bool paused() const { return paused_; }
  /// Sets the text that is shown until there is an image.
  void setNotice(const QString& text);
  struct Measured {
    double ms = 0;  ///< until the image was finished
    std::uint64_t tilesBuilt = 0;
  };
  /// Draws an image that nobody sees and times it. Returns nothing without terrain, or without a GL context
  /// that can draw it.
  std::optional<Measured> measure(const FrameRequest& request);
  /// Builds meshes for coming images, for so long (Renderer::buildAhead).
  scene::BuiltAhead buildAhead(std::span<const std::uint32_t> nodes, double withinMs);
  /// While this is on, `depthMapRead` reports the depth maps that were drawn, and `horizonRead` the horizons
  /// that were used, at most ten per second.
  void setDepthMapWanted(bool wanted);
  /// While this is on, a click emits `picked` instead of turning the camera.
  void setPicking(bool on);

  const OverlayContents& overlayContents() const { return shownOverlay_; }
  const scene::GlReport& gl() const { return gl_; }
  std::uint64_t paints() const { return paints_; }
  /// Null until the open terrain has been drawn once.
  const std::shared_ptr<const FrameResult>& lastResult() const { return result_; }
  /// Returns the pages of the terrain that could not be read.
  Findings pageFailures() const { return renderer_ ? renderer_->pageFailures() : Findings{}; }

 signals:
  void cameraMoved();
  void pointed(QPointF place);  ///< -1..1 from edge to edge of the image, to the right and up
  void painted();               ///< the image is on the display; `lastResult` is new
  void depthMapRead(const QImage& grey);
  /// Elevation angles all round, degrees; empty if no horizon was used.
  void horizonRead(const std::vector<float>& elevationDeg);
  /// A node, an object that hides it, or neither: scene::Renderer::kNoNode stands for none.
  void picked(std::uint32_t node, std::uint32_t object);
  void glFailed(const QString& why);

 protected:
  void initializeGL() override;
  void paintGL() override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void drawNext(const NextImage& next, int widthPx, int heightPx);
  void drawPilot(const FrameRequest& request);
  void drawImage(const NextImage& next, unsigned framebuffer);
  void showInset(OverlayContents& overlay);
  void readDepthMap();
  void readPicked(QSize image);
  void showPaused();
  void placeImage(const NextImage& next, QSize pixels);
  void report();
  void paintAgain();
  qint64 controlsFirstMs() const;

  Source source_;
  OverlayContents shownOverlay_;
  std::unique_ptr<scene::Renderer> renderer_;
  std::unique_ptr<QOpenGLFramebufferObject> fixedSize_, unseen_, pilots_;
  std::shared_ptr<const terrain::Database> terrain_;
  bool terrainChanged_ = false;
  scene::GlReport gl_;
  std::shared_ptr<const FrameResult> result_;
  FreeCamera camera_;
  SymbologyEditor* editor_ = nullptr;
  QRectF imageAt_;  ///< where the last image lies in the widget
  bool cameraEnabled_ = true, dirty_ = false, again_ = false, pointerWanted_ = false, picking_ = false;
  bool depthMapWanted_ = false;
  bool depthMapDue_ = false;       ///< a repaint that reads the map is under way
  std::optional<QPointF> pickAt_;  ///< in the widget: where the next image is asked for its node
  QPointF lastMouse_;
  QString notice_;
  QElapsedTimer sinceMove_, sinceDepthMap_, sincePaint_;
  bool controlHeld_ = false;  ///< the mouse holds a control that is not this widget
  QElapsedTimer sinceClick_;  ///< since the last click elsewhere
  qint64 tookMs_ = 0;         ///< the last image, until it was on the display
  QSize paintedPx_;           ///< the widget's size, of the last image
  QElapsedTimer sinceShown_;  ///< since then
  QTimer later_;              ///< runs while an image waits
  bool paused_ = false;
  QString whyPaused_;
  bool unreported_ = false;  ///< `painted` has not been emitted for the last image
  std::uint64_t paints_ = 0;
};

}  // namespace trimtab::workbench
