// SPDX-License-Identifier: GPL-3.0-or-later
#include "gl_widget.h"

#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QOpenGLFramebufferObject>
#include <QOpenGLPaintDevice>
#include <QPainter>
#include <QWindow>

namespace trimtab::workbench {
namespace {

constexpr GLuint kPainterArrays = 8;

/// OSG leaves its own GL state behind, but QPainter expects the default of what it does not set itself.
void prepareForPainter(QOpenGLExtraFunctions& gl, QSize pixels) {
  gl.glBindVertexArray(0);
  gl.glUseProgram(0);
  gl.glBindSampler(0, 0);
  // Arrays that OSG left on would be read by the painter's draws, with the painter's counts.
  for (GLuint array = 0; array < kPainterArrays; ++array) {
    gl.glDisableVertexAttribArray(array);
    gl.glVertexAttribDivisor(array, 0);
  }
  gl.glBindBuffer(GL_ARRAY_BUFFER, 0);
  gl.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
  gl.glActiveTexture(GL_TEXTURE0);
  for (const GLenum off : {GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST, GL_STENCIL_TEST}) gl.glDisable(off);
  gl.glStencilMask(0xff);
  gl.glDepthMask(GL_TRUE);
  gl.glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  gl.glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.glViewport(0, 0, pixels.width(), pixels.height());
}

}  // namespace

GlWidget::GlWidget(QWidget* parent) : QWidget(parent) {
  // The widgets around this one stay without windows of their own.
  setAttribute(Qt::WA_DontCreateNativeAncestors);
  setAttribute(Qt::WA_NativeWindow);
  setAttribute(Qt::WA_PaintOnScreen);
  setAttribute(Qt::WA_NoSystemBackground);
  setAttribute(Qt::WA_OpaquePaintEvent);
  windowHandle()->setSurfaceType(QSurface::OpenGLSurface);
  hidden_.create();
}

GlWidget::~GlWidget() {
  if (context_ == nullptr) return;
  makeCurrent();
  framebuffer_.reset();
  doneCurrent();
}

/// Makes what is missing: context, framebuffer, and what the image needs. Returns false if there is no
/// OpenGL.
bool GlWidget::begin() {
  if (failed_) return false;
  if (context_ == nullptr) {
    context_ = std::make_unique<QOpenGLContext>();
    failed_ = !context_->create();
    if (failed_) {
      context_.reset();
      return false;
    }
  }
  if (!makeCurrent()) return false;
  const bool first = framebuffer_ == nullptr;
  const QSize wanted = sizePx().expandedTo({1, 1});
  if (first || framebuffer_->size() != wanted)
    framebuffer_ =
        std::make_unique<QOpenGLFramebufferObject>(wanted, QOpenGLFramebufferObject::CombinedDepthStencil);
  if (first) initializeGL();
  bindFramebuffer();
  return true;
}

bool GlWidget::makeCurrent() {
  if (context_ == nullptr) return false;
  QSurface* surface = &hidden_;
  if (windowHandle() != nullptr && windowHandle()->handle() != nullptr) surface = windowHandle();
  if (!context_->makeCurrent(surface)) return false;
  if (framebuffer_ != nullptr) bindFramebuffer();
  return true;
}

void GlWidget::doneCurrent() {
  if (context_ != nullptr) context_->doneCurrent();
}

void GlWidget::bindFramebuffer() {
  framebuffer_->bind();
}

unsigned GlWidget::framebuffer() const {
  return framebuffer_ != nullptr ? framebuffer_->handle() : 0;
}

/// Paints on a device of its own: while the window is grabbed, Qt redirects a painter on the widget itself
/// away from GL.
void GlWidget::paintFlat(const std::function<void(QPainter&)>& paint) {
  const QSize pixels = sizePx();
  prepareForPainter(*context_->extraFunctions(), pixels);
  QOpenGLPaintDevice device(pixels);
  device.setDevicePixelRatio(devicePixelRatioF());
  QPainter painter(&device);
  painter.setFont(font());
  paint(painter);
}

QImage GlWidget::grabFramebuffer() {
  if (!begin()) return {};
  paintGL();
  QImage image = framebuffer_->toImage();
  doneCurrent();
  image.setDevicePixelRatio(devicePixelRatioF());
  return image;
}

bool GlWidget::isGrabbed() const {
  QPoint ignored;
  return redirected(&ignored) != nullptr;
}

void GlWidget::paintEvent(QPaintEvent*) {
  if (isGrabbed()) {
    const QImage image = grabFramebuffer();
    QPainter(this).drawImage(0, 0, image);
    return;
  }
  if (!windowHandle()->isExposed() || !begin()) return;
  paintGL();
  send();
  emit frameSwapped();
}

void GlWidget::showAgain() {
  if (framebuffer_ != nullptr && windowHandle()->isExposed() && makeCurrent()) send();
}

/// Copies the framebuffer to the window. The context is current.
void GlWidget::send() {
  context_->functions()->glDisable(GL_SCISSOR_TEST);
  QOpenGLFramebufferObject::blitFramebuffer(nullptr, framebuffer_.get());
  context_->swapBuffers(windowHandle());
}

void GlWidget::resizeEvent(QResizeEvent*) {
  update();
}

}  // namespace trimtab::workbench
