#include "core/scene/passes/precipitation_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_program.h"
#include "core/scene/gl/mesh_pool.h"
#include "core/scene/passes/scene_view.h"
#include "core/scene/passes/weather_precipitation.h"
#include "core/scene/shaders/shaders.h"

namespace trimtab::scene {
namespace {

constexpr std::size_t kCorners = 4, kIndices = 6;
static_assert(kMostParticles * kCorners <= 65536, "indices have 16 bits");

/// A streak of one pixel would come and go between the middles of two pixels.
constexpr double kLeastHalfWidthPx = 1;

std::vector<std::uint16_t> quadIndices() {
  std::vector<std::uint16_t> indices;
  indices.reserve(kMostParticles * kIndices);
  for (std::size_t i = 0; i < kMostParticles; ++i)
    for (const std::size_t corner : {0, 1, 2, 2, 1, 3})
      indices.push_back(static_cast<std::uint16_t>(i * kCorners + corner));
  return indices;
}

}  // namespace

void makeParticleCorners(const std::vector<NearParticle>& particles, const ParticleMotion& motion,
                         const SceneView& view, std::vector<ParticleCorner>& corners) {
  corners.clear();
  const ViewShape& v = view.shape;
  const double perPixelX = (v.right - v.left) / v.widthPx, perPixelY = (v.top - v.bottom) / v.heightPx;
  const double middleX = (v.left + v.right) / 2, middleY = (v.bottom + v.top) / 2;
  const double pixelsPerMetre = pixelsPerRadian(v);
  const double streakM = length(motion.streak);
  const Vec3 direction = streakM > 0 ? motion.streak * (1 / streakM) : Vec3{};
  for (const NearParticle& particle : particles) {
    const Vec3 from = particle.place, to = particle.place + direction * particle.lengthM;
    if (!(to.z < -0.3)) continue;
    struct End {
      double x, y, w;
    };
    // Pixels from the image's middle.
    const auto project = [&](Vec3 p) -> End {
      return {(p.x / -p.z - middleX) / perPixelX, (p.y / -p.z - middleY) / perPixelY, -p.z};
    };
    const End ends[] = {project(from), project(to)};
    double alongX = ends[1].x - ends[0].x, alongY = ends[1].y - ends[0].y;
    const double lengthPx = std::hypot(alongX, alongY);
    alongX = lengthPx > 0.5 ? alongX / lengthPx : 0;
    alongY = lengthPx > 0.5 ? alongY / lengthPx : 1;
    const double wanted = particle.radiusM * pixelsPerMetre / std::max(ends[0].w, ends[1].w);
    const double half = std::max(wanted, kLeastHalfWidthPx);
    const double strength = particle.strength * wanted / half;
    const auto byte = static_cast<std::uint8_t>(std::lround(std::clamp(strength, 0.0, 1.0) * 255));
    for (const int along : {0, 1})
      for (const int across : {-1, 1}) {
        const End& end = ends[along];
        const double out = along == 0 ? -half : half;
        const double x = end.x + alongX * out - alongY * half * across;
        const double y = end.y + alongY * out + alongX * half * across;
        corners.push_back({static_cast<float>(2 * x / v.widthPx * end.w),
                           static_cast<float>(2 * y / v.heightPx * end.w),
                           static_cast<float>(end.w),
                           {static_cast<std::uint8_t>(across < 0 ? 0 : 255),
                            static_cast<std::uint8_t>(along * 255), byte, 0}});
      }
  }
}

PrecipitationPass::PrecipitationPass()
    : program_(makeGlProgram(shaderText("particle.vert.glsl"), shaderText("particle.frag.glsl"))) {
  if (program_ == 0) return;
  nearUniform_ = glGetUniformLocation(program_, "nearM");
  colourUniform_ = glGetUniformLocation(program_, "colour");
}

PrecipitationPass::~PrecipitationPass() {
  if (array_ != 0) glDeleteVertexArrays(1, &array_);
  for (const unsigned buffer : {corners_, indices_})
    if (buffer != 0) glDeleteBuffers(1, &buffer);
  if (program_ != 0) glDeleteProgram(program_);
}

std::size_t PrecipitationPass::draw(const PrecipitationView& falling, const SceneView& view) {
  findNearParticles(falling, view, particles_);
  makeParticleCorners(particles_, particleMotion(falling, view), view, cornersToDraw_);
  if (program_ == 0 || cornersToDraw_.empty()) return 0;
  if (array_ == 0) makeBuffers();
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, corners_);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(cornersToDraw_.size() * sizeof(ParticleCorner)),
               cornersToDraw_.data(), GL_STREAM_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, 0);

  // Reversed depth as in the scene. A particle before the near plane is drawn: that plane belongs to the
  // terrain. The image's alpha stays 1.
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  for (const GLenum off : {GL_CULL_FACE, GL_SCISSOR_TEST}) glDisable(off);
  for (const GLenum on : {GL_DEPTH_TEST, GL_DEPTH_CLAMP, GL_BLEND}) glEnable(on);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glViewport(0, 0, view.shape.widthPx, view.shape.heightPx);
  glUseProgram(program_);
  glUniform1f(nearUniform_, static_cast<float>(view.shape.nearM));
  const PrecipitationLook& look = falling.look;
  glUniform3f(colourUniform_, static_cast<float>(look.red.value()), static_cast<float>(look.green.value()),
              static_cast<float>(look.blue.value()));
  const std::size_t quads = cornersToDraw_.size() / kCorners;
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(quads * kIndices), GL_UNSIGNED_SHORT, nullptr);
  glUseProgram(0);
  glBindVertexArray(0);
  glDepthMask(GL_TRUE);
  for (const GLenum on : {GL_DEPTH_TEST, GL_DEPTH_CLAMP, GL_BLEND}) glDisable(on);
  glBlendFunc(GL_ONE, GL_ZERO);
  return quads;
}

void PrecipitationPass::makeBuffers() {
  glGenVertexArrays(1, &array_);
  glGenBuffers(1, &corners_);
  glGenBuffers(1, &indices_);
  glBindVertexArray(array_);
  glBindBuffer(GL_ARRAY_BUFFER, corners_);
  const VertexAttribute attributes[] = {{0, 3, GL_FLOAT, false, offsetof(ParticleCorner, x)},
                                        {1, 4, GL_UNSIGNED_BYTE, true, offsetof(ParticleCorner, shape)}};
  defineAttributes(attributes, sizeof(ParticleCorner));
  const auto indices = quadIndices();
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof indices[0]),
               indices.data(), GL_STATIC_DRAW);
}

}  // namespace trimtab::scene
