#include "occlusion_pass.h"

#include <algorithm>

#include "core/scene/gl/gl_api.h"
#include "core/scene/shaders/shaders.h"
#include "core/scene/shaders/shared_constants.h"

namespace trimtab::scene {
namespace {

constexpr int kLevels = OcclusionPass::kLevels;
constexpr int kResultWidth = kTestedPerRow * kParts;

GLuint makeTexture() {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

int halved(int size, int times) {
  return (size + (1 << times) - 1) >> times;
}

/// Returns the least multiple of `block` that is at least `size` and has an odd number of blocks, three or
/// more.
int oddBlocks(int size, int block) {
  return block * std::max(3, (size + block - 1) / block | 1);
}

void bindTexture(int unit, GLenum target, GLuint texture) {
  glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
  glBindTexture(target, texture);
}

}  // namespace

OcclusionPass::OcclusionPass() {
  for (GLuint* frame : {&frame_, &reduceFrame_, &resultFrame_}) glGenFramebuffers(1, frame);
  glGenBuffers(1, &testedBuffer_);
  glGenTextures(1, &testedTexture_);
  glGenVertexArrays(1, &emptyArray_);
}

OcclusionPass::~OcclusionPass() {
  for (const GLuint frame : {frame_, reduceFrame_, resultFrame_}) glDeleteFramebuffers(1, &frame);
  for (const GLuint texture : {depth_, pyramid_, result_, testedTexture_}) glDeleteTextures(1, &texture);
  glDeleteBuffers(1, &testedBuffer_);
  glDeleteVertexArrays(1, &emptyArray_);
}

void OcclusionPass::resizeMap(int width, int height) {
  width_ = width;
  height_ = height;
  if (width <= storedWidth_ && height <= storedHeight_) return;
  // Storage only grows, and its sides are never powers of two. The decision changes the size in flight, and a
  // software rasteriser compiles its shaders again for a texture whose sides are powers of two (half a
  // second, measured).
  storedWidth_ = oddBlocks(std::max(width, storedWidth_), 1);
  storedHeight_ = oddBlocks(std::max(height, storedHeight_), 1);
  for (const GLuint texture : {depth_, pyramid_}) glDeleteTextures(1, &texture);
  depth_ = makeTexture();
  glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, storedWidth_, storedHeight_, 0, GL_DEPTH_COMPONENT,
               GL_FLOAT, nullptr);
  // Sizes of texture levels round down, but a pyramid that must cover every texel rounds up. So its base is a
  // multiple of what its levels divide it by.
  constexpr int kBlock = 1 << (kLevels - 1);
  pyramid_ = makeTexture();
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_NEAREST);
  glTexStorage2D(GL_TEXTURE_2D, kLevels, GL_R32F, oddBlocks(halved(storedWidth_, 1), kBlock),
                 oddBlocks(halved(storedHeight_, 1), kBlock));
  glBindTexture(GL_TEXTURE_2D, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
  glDrawBuffer(GL_NONE);
  glReadBuffer(GL_NONE);
}

void OcclusionPass::resizeResult(int rows) {
  if (result_ != 0 && rows <= resultRows_) return;
  glDeleteTextures(1, &result_);
  resultRows_ = std::max(rows, 2 * resultRows_);
  result_ = makeTexture();
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_R8, kResultWidth, resultRows_);
  glBindTexture(GL_TEXTURE_2D, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, resultFrame_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, result_, 0);
}

void OcclusionPass::prepare(int width, int height, std::span<const std::uint32_t> slots) {
  resizeMap(width, height);
  count_ = static_cast<int>(slots.size());
  resizeResult(std::max(1, (count_ + kTestedPerRow - 1) / kTestedPerRow));
  glBindBuffer(GL_TEXTURE_BUFFER, testedBuffer_);
  glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(std::max<std::size_t>(slots.size_bytes(), 4)),
               nullptr, GL_STREAM_DRAW);
  glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(slots.size_bytes()), slots.data());
  glBindTexture(GL_TEXTURE_BUFFER, testedTexture_);
  glTexBuffer(GL_TEXTURE_BUFFER, GL_R32I, testedBuffer_);
  glBindTexture(GL_TEXTURE_BUFFER, 0);
  glBindBuffer(GL_TEXTURE_BUFFER, 0);
}

void OcclusionPass::beginDepth() {
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, width_, height_);
  glClearDepth(0);
  glClear(GL_DEPTH_BUFFER_BIT);
}

void OcclusionPass::reduce(unsigned program) {
  const GLint size = glGetUniformLocation(program, "sourceSize");
  glBindFramebuffer(GL_FRAMEBUFFER, reduceFrame_);
  glBindVertexArray(emptyArray_);
  for (int level = 0; level < kLevels; ++level) {
    if (level == 0) {
      bindTexture(kDepthUnit, GL_TEXTURE_2D, depth_);
    } else {
      bindTexture(kDepthUnit, GL_TEXTURE_2D, pyramid_);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, level - 1);
      glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, level - 1);
    }
    glUniform2i(size, halved(width_, level), halved(height_, level));
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, pyramid_, level);
    glViewport(0, 0, halved(width_, level + 1), halved(height_, level + 1));
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  bindTexture(kDepthUnit, GL_TEXTURE_2D, pyramid_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_BASE_LEVEL, 0);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, kLevels - 1);
  bindTexture(kDepthUnit, GL_TEXTURE_2D, 0);
  glActiveTexture(GL_TEXTURE0);
  glBindVertexArray(0);
}

void OcclusionPass::test(const TileCache& tiles, std::vector<std::uint8_t>& flags) {
  const int rows = (count_ + kTestedPerRow - 1) / kTestedPerRow;
  glBindFramebuffer(GL_FRAMEBUFFER, resultFrame_);
  glViewport(0, 0, kResultWidth, rows);
  bindTexture(kDepthUnit, GL_TEXTURE_2D, depth_);
  bindTexture(kPyramidUnit, GL_TEXTURE_2D, pyramid_);
  bindTexture(kSlotUnit, GL_TEXTURE_BUFFER, tiles.slotTexture());
  bindTexture(kPartUnit, GL_TEXTURE_BUFFER, tiles.partTexture());
  bindTexture(kTestedUnit, GL_TEXTURE_BUFFER, testedTexture_);
  glBindVertexArray(emptyArray_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);

  const std::size_t parts = static_cast<std::size_t>(kResultWidth) * static_cast<std::size_t>(rows);
  pixels_.resize(parts);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, kResultWidth, rows, GL_RED, GL_UNSIGNED_BYTE, pixels_.data());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  for (const int unit : {kSlotUnit, kPartUnit, kTestedUnit}) bindTexture(unit, GL_TEXTURE_BUFFER, 0);
  for (const int unit : {kDepthUnit, kPyramidUnit}) bindTexture(unit, GL_TEXTURE_2D, 0);
  glActiveTexture(GL_TEXTURE0);

  flags.assign(static_cast<std::size_t>(count_), 0);
  for (std::size_t tile = 0; tile < flags.size(); ++tile) {
    const auto part = pixels_.begin() + static_cast<std::ptrdiff_t>(tile * kParts);
    const auto [least, most] = std::minmax_element(part, part + kParts);
    flags[tile] = *least < 64 ? 0 : *most < 192 ? 2 : 1;
  }
}

void OcclusionPass::read(std::vector<float>& depths) const {
  depths.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  if (depths.empty()) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_);
  glReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, depths.data());
}

}  // namespace trimtab::scene
