#include "trimtab/scene/static_lod_occlusion.h"

#include <algorithm>

#include "trimtab/scene/gl_api.h"
#include "trimtab/scene/shaders.h"

namespace trimtab::scene {
namespace {

const char* const kVertex = R"(#version 430 compatibility
void main() {
  gl_Position = vec4(float((gl_VertexID & 1) * 4) - 1.0, float((gl_VertexID & 2) * 2) - 1.0, 0.5, 1.0);
}
)";

// The farthest of all pixels that a texel touches: the smallest number, as depth is reversed.
const char* const kFragment = R"(#version 430 compatibility
uniform sampler2D pictureDepth;
uniform ivec2 pictureSize, mapSize;
out vec4 farthest;
void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  ivec2 from = texel * pictureSize / mapSize;
  ivec2 to = min(((texel + 1) * pictureSize + mapSize - 1) / mapSize, pictureSize);
  float f = 1.0;
  for (int y = from.y; y < to.y; ++y)
    for (int x = from.x; x < to.x; ++x) f = min(f, texelFetch(pictureDepth, ivec2(x, y), 0).r);
  farthest = vec4(f);
}
)";

GLuint compiled(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  return shader;
}

}  // namespace

StaticLodOcclusion::~StaticLodOcclusion() {
  if (program_ == 0) return;
  glDeleteProgram(program_);
  glDeleteFramebuffers(1, &frame_);
  glDeleteTextures(1, &map_);
  glDeleteVertexArrays(1, &emptyArray_);
}

void StaticLodOcclusion::make() {
  program_ = glCreateProgram();
  for (const GLuint shader : {compiled(GL_VERTEX_SHADER, kVertex), compiled(GL_FRAGMENT_SHADER, kFragment)}) {
    glAttachShader(program_, shader);
    glDeleteShader(shader);  // with the program
  }
  glLinkProgram(program_);
  glGenFramebuffers(1, &frame_);
  glGenVertexArrays(1, &emptyArray_);
}

void StaticLodOcclusion::resize(int width, int height) {
  if (width <= storedWidth_ && height <= storedHeight_) return;
  storedWidth_ = std::max(width, storedWidth_);
  storedHeight_ = std::max(height, storedHeight_);
  glDeleteTextures(1, &map_);
  glGenTextures(1, &map_);
  glBindTexture(GL_TEXTURE_2D, map_);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_R32F, storedWidth_, storedHeight_);
  glBindTexture(GL_TEXTURE_2D, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, map_, 0);
}

void StaticLodOcclusion::read(unsigned depthTexture, int pictureWidth, int pictureHeight, int width,
                              int height) {
  if (program_ == 0) make();
  glActiveTexture(GL_TEXTURE0 + kDepthUnit);
  resize(width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glViewport(0, 0, width, height);
  glUseProgram(program_);
  glBindTexture(GL_TEXTURE_2D, depthTexture);
  glUniform1i(glGetUniformLocation(program_, "pictureDepth"), kDepthUnit);
  glUniform2i(glGetUniformLocation(program_, "pictureSize"), pictureWidth, pictureHeight);
  glUniform2i(glGetUniformLocation(program_, "mapSize"), width, height);
  glBindVertexArray(emptyArray_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  glBindTexture(GL_TEXTURE_2D, 0);
  glActiveTexture(GL_TEXTURE0);
  depths_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, depths_.data());
  pyramid_.build(depths_, width, height);
}

}  // namespace trimtab::scene
