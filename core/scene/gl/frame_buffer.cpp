#include "frame_buffer.h"

#include <cmath>

#include "gl_api.h"

namespace trimtab::scene {

FrameBuffer::~FrameBuffer() {
  release();
}

void FrameBuffer::release() {
  if (id_ == 0) return;
  glDeleteFramebuffers(1, &id_);
  for (const GLuint texture : {colour_, depth_}) glDeleteTextures(1, &texture);
  id_ = 0;
}

namespace {

/// Binds a framebuffer for reading and puts back what was bound.
class Reading {
 public:
  explicit Reading(GLuint frame) {
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &before_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
  }
  ~Reading() {
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before_));
  }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;

 private:
  GLint before_ = 0;
};

}  // namespace

std::vector<float> FrameBuffer::readDistances(const ViewShape& view, const ViewShape& v) const {
  std::vector<float> depths(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  {
    const Reading reading(id_);
    glReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
  }
  const auto covering = [](int i, int pixels, int of) {
    return static_cast<std::size_t>((2 * std::int64_t{i} + 1) * of / (2 * std::int64_t{pixels}));
  };
  std::vector<float> distances(static_cast<std::size_t>(v.widthPx) * static_cast<std::size_t>(v.heightPx));
  std::size_t i = 0;
  for (int y = 0; y < v.heightPx; ++y) {
    const float* row =
        depths.data() + covering(y, v.heightPx, view.heightPx) * static_cast<std::size_t>(width_);
    for (int x = 0; x < v.widthPx; ++x, ++i) {
      const double across = v.left + (v.right - v.left) * (x + 0.5) / v.widthPx;
      const double up = v.bottom + (v.top - v.bottom) * (y + 0.5) / v.heightPx;
      distances[i] = static_cast<float>(v.nearM / double{row[covering(x, v.widthPx, view.widthPx)]} *
                                        std::sqrt(1 + across * across + up * up));
    }
  }
  return distances;
}

std::vector<std::uint8_t> FrameBuffer::readPixels(int width, int height) const {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
  const Reading reading(id_);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  return pixels;
}

void FrameBuffer::readPixels(std::uint8_t* rgba) const {
  const Reading reading(id_);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
}

void FrameBuffer::writePixels(const std::uint8_t* rgba) const {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, colour_);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
  glBindTexture(GL_TEXTURE_2D, 0);
}

void FrameBuffer::resize(int width, int height) {
  if (id_ != 0 && width == width_ && height == height_) return;
  release();
  width_ = width;
  height_ = height;
  glGenFramebuffers(1, &id_);
  const auto makeTexture = [width, height](GLenum format) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
  };
  colour_ = makeTexture(format_ == Colour::rgba8 ? GL_RGBA8 : GL_R32UI);
  depth_ = makeTexture(GL_DEPTH_COMPONENT32F);
  glBindTexture(GL_TEXTURE_2D, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, id_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
}

}  // namespace trimtab::scene
