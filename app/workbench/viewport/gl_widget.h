// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QOffscreenSurface>
#include <QWidget>
#include <functional>
#include <memory>

class QOpenGLContext;
class QOpenGLFramebufferObject;

namespace trimtab::workbench {

/// A widget that OpenGL draws, in a native window of its own inside the main window. With QOpenGLWidget, Qt
/// (6.4) puts the whole main window together with OpenGL each time that anything in it changes, a number in a
/// dock too. A software rasteriser needs about as long for that as for an image. Beside this widget, what
/// changes in a dock is sent to the display as it is.
///
/// Images are drawn into a framebuffer that lasts, and are then copied to the window. A widget that lies over
/// this one must be native too (`Qt::WA_NativeWindow`), or this one covers it.
class GlWidget : public QWidget {
  Q_OBJECT

 public:
  explicit GlWidget(QWidget* parent = nullptr);
  ~GlWidget() override;

  /// Null until the first image is due.
  QOpenGLContext* context() const { return context_.get(); }
  /// Makes the context current, also while the widget is hidden, and binds the framebuffer. Returns false if
  /// it cannot.
  bool makeCurrent();
  void doneCurrent();
  /// Draws an image and returns it. It is null if there is no OpenGL.
  QImage grabFramebuffer();

 signals:
  /// The image was sent to the display.
  void frameSwapped();

 protected:
  /// Is called once, with the context current, before the first image.
  virtual void initializeGL() = 0;
  /// Draws an image, with the context current and the framebuffer bound.
  virtual void paintGL() = 0;
  /// Binds the framebuffer, which has a depth and a stencil buffer, in such a way that QPainter finds it
  /// again.
  void bindFramebuffer();
  /// Paints over the image in the framebuffer. The context is current, in any state.
  void paintFlat(const std::function<void(QPainter&)>& paint);
  /// Returns the name of the framebuffer, for what does not use Qt.
  unsigned framebuffer() const;
  /// Sends the last image once more, as after another window lay over it.
  void showAgain();
  /// Whether the paint event under way is for a copy of the window (QWidget::grab), not for the display.
  bool isGrabbed() const;
  QSize sizePx() const { return size() * devicePixelRatioF(); }

  QPaintEngine* paintEngine() const override { return nullptr; }
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  bool begin();
  void send();

  QOffscreenSurface hidden_;  ///< stands in for the window while that does not exist
  std::unique_ptr<QOpenGLContext> context_;
  std::unique_ptr<QOpenGLFramebufferObject> framebuffer_;
  bool failed_ = false;
};

}  // namespace trimtab::workbench
