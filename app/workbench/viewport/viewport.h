// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QImage>
#include <QOpenGLWidget>
#include <QRectF>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "free_camera.h"
#include "overlay.h"
#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"

class QOpenGLFramebufferObject;

namespace trimtab::workbench {

class SymbologyEditor;

/// What the next picture is made of; asked for once in each paint.
struct Picture {
  FrameRequest request;
  OverlayContents overlay;
  std::function<QString()> hud;  ///< asked for once the picture is drawn and `lastResult` is its own
  bool again = false;            ///< something moves on its own: paint again as soon as the display takes it
};

/// The terrain through scene::Renderer. Paints on demand only: `invalidate` any number of times gives one
/// paint, and nothing is painted while hidden. Without terrain it says how to open some.
class Viewport : public QOpenGLWidget {
  Q_OBJECT

 public:
  using Source = std::function<std::optional<Picture>(int widthPx, int heightPx)>;

  explicit Viewport(QWidget* parent = nullptr);
  ~Viewport() override;

  void setSource(Source source) { source_ = std::move(source); }
  void setTerrain(std::shared_ptr<const terrain::Database> database);
  void invalidate();
  FreeCamera& camera() { return camera_; }
  /// Mouse and keys move the camera only while this is on.
  void setCameraEnabled(bool on);
  bool cameraEnabled() const { return cameraEnabled_; }
  /// While it is active it has the mouse and the keys first.
  void setSymbologyEditor(SymbologyEditor* editor);
  /// From now on `pointed` tells where in the picture the pointer is, pressed or not.
  void setPointerWanted(bool wanted);
  /// Shown instead of a picture, until there is one.
  void setNotice(const QString& text);
  struct Measured {
    double ms = 0;  ///< until the picture was finished
    std::uint64_t tilesBuilt = 0;
  };
  /// Draws a picture that nobody sees. None without terrain or a context that can draw it.
  std::optional<Measured> measure(const FrameRequest& request);
  /// From now on `depthMapRead` tells each depth map that was drawn, and `horizonRead` each horizon that
  /// served, at most ten a second. `who` may stop wanting it without another's map.
  void setDepthMapWanted(const QObject* who, bool wanted);
  /// Until a node is picked, or it is called off: a click tells `nodePicked`.
  void setPicking(bool on);

  const OverlayContents& overlayContents() const { return shownOverlay_; }
  const scene::GlReport& gl() const { return gl_; }
  std::uint64_t paints() const { return paints_; }
  /// Null until the open terrain has been drawn once.
  const std::shared_ptr<const FrameResult>& lastResult() const { return result_; }
  /// Pages of the terrain that could not be read.
  Findings pageFailures() const { return renderer_ ? renderer_->pageFailures() : Findings{}; }

 signals:
  void cameraMoved();
  void pointed(QPointF place);  ///< -1..1 to the right and up, of the picture's edges
  void painted();               ///< the picture is on the display; `lastResult` is new
  void depthMapRead(const QImage& grey);
  /// Empty where none served.
  void horizonRead(const std::vector<float>& elevationDeg);
  void nodePicked(std::uint32_t node);  ///< scene::Renderer::kNoNode: the sky
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

 private:
  void releaseGl();
  void drawPicture(const Picture& picture, int widthPx, int heightPx);
  void readDepthMap();
  void readPicked(QSize picture);
  void paintOverlays();
  void placePicture(const Picture& picture, QSize pixels);
  void report();
  void paintAgain();

  Source source_;
  OverlayContents shownOverlay_;
  std::unique_ptr<scene::Renderer> renderer_;
  std::unique_ptr<QOpenGLFramebufferObject> fixedSize_, unseen_;
  std::shared_ptr<const terrain::Database> terrain_;
  bool terrainChanged_ = false;
  scene::GlReport gl_;
  std::shared_ptr<const FrameResult> result_;
  FreeCamera camera_;
  SymbologyEditor* editor_ = nullptr;
  QRectF pictureAt_;  ///< where the last picture lies in the widget
  bool cameraEnabled_ = true, dirty_ = false, again_ = false, pointerWanted_ = false, picking_ = false;
  std::set<const QObject*> depthMapWanted_;
  std::optional<QPointF> pickAt_;  ///< in the widget, where the next picture tells
  QPointF lastMouse_;
  QString notice_;
  QElapsedTimer sinceMove_, sinceDepthMap_, sincePaint_;
  bool unreported_ = false;  ///< `painted` is due
  std::uint64_t paints_ = 0;
};

}  // namespace trimtab::workbench
