#include "blur_pass.h"

#include <algorithm>
#include <cmath>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_program.h"
#include "core/scene/shaders/shaders.h"

namespace trimtab::scene {
namespace {

constexpr double kReferenceHz = 60, kStrongest = 0.995, kLongestS = 1;

}  // namespace

BlurPass::BlurPass() : program_(makeGlProgram(shaderText("screen.vert.glsl"), shaderText("blur.frag.glsl"))) {
  if (program_ != 0) keepUniform_ = glGetUniformLocation(program_, "keep");
  glGenVertexArrays(1, &emptyArray_);
}

BlurPass::~BlurPass() {
  resize(0, 0);
  glDeleteVertexArrays(1, &emptyArray_);
  if (program_ != 0) glDeleteProgram(program_);
}

void BlurPass::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  if (width_ > 0) {
    glDeleteFramebuffers(2, frame_.data());
    glDeleteTextures(2, texture_.data());
    glDeleteTextures(1, &shown_);
  }
  width_ = width;
  height_ = height;
  fresh_ = true;
  if (width == 0) return;
  glGenTextures(2, texture_.data());
  glGenFramebuffers(2, frame_.data());
  // Written along with the sum: converting one image into the other afterwards took longer than the mix.
  glGenTextures(1, &shown_);
  glBindTexture(GL_TEXTURE_2D, shown_);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, width, height);
  for (std::size_t i = 0; i < 2; ++i) {
    glBindTexture(GL_TEXTURE_2D, texture_[i]);
    // 32 bits: at 450 images a second a long trail moves by less than half floats can tell apart, and would
    // stand still several grey levels before its end.
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, width, height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_[i]);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_[i], 0);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, shown_, 0);
    constexpr GLenum kBoth[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, kBoth);
    glReadBuffer(GL_COLOR_ATTACHMENT1);
  }
  glBindTexture(GL_TEXTURE_2D, 0);
}

double BlurPass::keptAfter(double strength, double step) {
  if (!(step > 0 && step <= kLongestS)) return 0;
  return std::pow(std::clamp(strength, 0.0, kStrongest), step * kReferenceHz);
}

void BlurPass::apply(unsigned fbo, unsigned texture, int width, int height, double strength, double time) {
  if (program_ == 0) return;
  resize(width, height);
  const double step = time - time_;
  const bool again = step == 0 && !fresh_;
  if (!again) {
    keep_ = fresh_ ? 0 : keptAfter(strength, step);
    newest_ = 1 - newest_;
  }
  time_ = time;
  fresh_ = false;

  for (const GLenum off : {GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST, GL_BLEND}) glDisable(off);
  glViewport(0, 0, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_[newest_]);
  glUseProgram(program_);
  glUniform1f(keepUniform_, static_cast<float>(keep_));
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, texture_[1 - newest_]);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture);
  glBindVertexArray(emptyArray_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  glUseProgram(0);
  glBindTexture(GL_TEXTURE_2D, 0);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, 0);
  glActiveTexture(GL_TEXTURE0);

  // A first image is the result: nothing to bring back.
  if (keep_ > 0) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_[newest_]);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, fbo);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, fbo);
}

}  // namespace trimtab::scene
