#include "blur_pass.h"

#include <algorithm>
#include <cmath>

#include "core/scene/gl/frame_buffer.h"
#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_program.h"
#include "core/scene/shaders/shaders.h"

namespace trimtab::scene {
namespace {

constexpr double kReferenceHz = 60, kStrongest = 0.995, kLongestS = 1;

/// Mixes `pixels` with `before` into `sum` and into themselves.
void mix(const float* before, float keep, float* sum, std::uint8_t* pixels, std::size_t count) {
  const float take = 1 - keep;
  for (std::size_t i = 0; i < count; ++i) {
    sum[i] = before[i] * keep + static_cast<float>(pixels[i]) * take;
    pixels[i] = static_cast<std::uint8_t>(static_cast<int>(sum[i] + 0.5f));
  }
}

}  // namespace

BlurPass::BlurPass(bool softwareRasteriser) : software_(softwareRasteriser) {
  if (software_) return;
  program_ = makeGlProgram(shaderText("screen.vert.glsl"), shaderText("blur.frag.glsl"));
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
  if (width_ > 0 && !software_) {
    glDeleteFramebuffers(2, frame_.data());
    glDeleteTextures(2, texture_.data());
    glDeleteTextures(1, &shown_);
  }
  width_ = width;
  height_ = height;
  fresh_ = true;
  const std::size_t values =
      std::size_t{4} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (software_) {
    for (std::vector<float>& sum : sum_) sum.resize(values);
    pixels_.resize(values);
  } else if (width > 0) {
    makeTargets();
  }
}

void BlurPass::makeTargets() {
  glGenTextures(2, texture_.data());
  glGenFramebuffers(2, frame_.data());
  // The image shown is written along with the sum: converting one image into the other afterwards took longer
  // than the mix.
  glGenTextures(1, &shown_);
  glBindTexture(GL_TEXTURE_2D, shown_);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA8, width_, height_);
  for (std::size_t i = 0; i < 2; ++i) {
    glBindTexture(GL_TEXTURE_2D, texture_[i]);
    // 32 bits: at 450 images a second a long trail moves by less than half floats can distinguish, and would
    // stand still several grey levels before its end.
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, width_, height_);
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

void BlurPass::apply(const FrameBuffer& image, double strength, double time) {
  if (!software_ && program_ == 0) return;
  resize(image.width(), image.height());
  const double step = time - time_;
  const bool again = step == 0 && !fresh_;
  if (!again) {
    keep_ = fresh_ ? 0 : keptAfter(strength, step);
    newest_ = 1 - newest_;
  }
  time_ = time;
  fresh_ = false;
  if (software_)
    mixOnCpu(image);
  else
    mixOnGpu(image);
  glBindFramebuffer(GL_FRAMEBUFFER, image.id());
}

void BlurPass::mixOnCpu(const FrameBuffer& image) {
  image.readPixels(pixels_.data());
  std::vector<float>& sum = sum_[newest_];
  // A first image is the result.
  if (!(keep_ > 0)) {
    std::copy(pixels_.begin(), pixels_.end(), sum.begin());
    return;
  }
  mix(sum_[1 - newest_].data(), static_cast<float>(keep_), sum.data(), pixels_.data(), pixels_.size());
  image.writePixels(pixels_.data());
}

void BlurPass::mixOnGpu(const FrameBuffer& image) {
  for (const GLenum off : {GL_DEPTH_TEST, GL_CULL_FACE, GL_SCISSOR_TEST, GL_BLEND}) glDisable(off);
  glViewport(0, 0, width_, height_);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_[newest_]);
  glUseProgram(program_);
  glUniform1f(keepUniform_, static_cast<float>(keep_));
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, texture_[1 - newest_]);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, image.colourTexture());
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
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, image.id());
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
}

}  // namespace trimtab::scene
