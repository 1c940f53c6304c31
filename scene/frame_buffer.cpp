#include "trimtab/scene/frame_buffer.h"

#include "trimtab/scene/gl_api.h"

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

std::vector<float> FrameBuffer::readDepths() const {
  std::vector<float> depths(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  GLint before = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &before);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, id_);
  glReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before));
  return depths;
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
  colour_ = makeTexture(GL_RGBA8);
  depth_ = makeTexture(GL_DEPTH_COMPONENT32F);
  glBindTexture(GL_TEXTURE_2D, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, id_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
}

}  // namespace trimtab::scene
