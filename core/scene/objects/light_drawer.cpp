#include "light_drawer.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_buffer.h"
#include "core/scene/gl/mesh_pool.h"

namespace trimtab::scene {
namespace {

constexpr std::array kLightAttributes{
    VertexAttribute{0, 3, GL_FLOAT, false, offsetof(LightPoint, x)},
    VertexAttribute{1, 4, GL_UNSIGNED_BYTE, true, offsetof(LightPoint, colour)}};
constexpr GLuint kCellOrigin = 2;
/// A disc of more than the square root of two covers the centre of a pixel wherever it lies. A smaller one
/// would come and go as the eye moves.
constexpr double kLeastLightPx = 1.5;

/// Returns the size of a light in pixels of the scene, which may be drawn smaller than the image.
double sceneSizePx(const FrameRequest& r) {
  if (!(r.lightPx > 0)) return 0;
  return std::max(r.lightPx * pixelsPerRadian(r.view) / errorPxPerRadian(r), kLeastLightPx);
}

}  // namespace

class LightDrawer::Points {
 public:
  explicit Points(const std::vector<LightPoint>& points) {
    glGenVertexArrays(1, &vertexArray_);
    glGenBuffers(1, &buffer_);
    uploadBuffer(buffer_, points.data(), points.size() * sizeof(LightPoint));
    glBindVertexArray(vertexArray_);
    glBindBuffer(GL_ARRAY_BUFFER, buffer_);
    defineAttributes(kLightAttributes, sizeof(LightPoint));
    for (const VertexAttribute& attribute : kLightAttributes) glVertexAttribDivisor(attribute.index, 1);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
  }
  ~Points() {
    glDeleteBuffers(1, &buffer_);
    glDeleteVertexArrays(1, &vertexArray_);
  }
  Points(const Points&) = delete;
  Points& operator=(const Points&) = delete;
  void bind() const { glBindVertexArray(vertexArray_); }

 private:
  GLuint vertexArray_ = 0, buffer_ = 0;
};

LightDrawer::LightDrawer() = default;
LightDrawer::~LightDrawer() = default;

void LightDrawer::setTerrain(std::shared_ptr<const terrain::ObjectTerrain> objects) {
  objects_ = std::move(objects);
  release();
}

void LightDrawer::release() {
  points_.reset();
  cells_.clear();
  query_ = {};
}

bool LightDrawer::prepare(const FrameInProgress& frame) {
  const FrameRequest& r = frame.request;
  const double size = sceneSizePx(r);
  if (!(size > 0) || !objects_ || objects_->lights.points.empty()) {
    cells_.clear();
    query_ = {};
    return false;
  }
  if (!points_) points_ = std::make_unique<Points>(objects_->lights.points);
  seenFrom_ = frame.eye.position;
  const LightQuery query{.eye = r.frozenEye.value_or(frame.eye),
                         .view = r.view,
                         .sizePx = size,
                         .cull = r.cullingCase != CullingCase::none,
                         .airM = farCutM(r)};
  if (r.skips.sameVisible && query == query_) return false;
  query_ = query;
  selectLights(objects_->lights, query_, cells_);
  frame.clock.lap(&FrameCost::select);
  return true;
}

void LightDrawer::draw(ScenePrograms& programs) {
  if (cells_.empty()) return;
  const unsigned program = programs.use(SceneShaders::lights);
  glUniform2f(glGetUniformLocation(program, "reach"), static_cast<float>(query_.sizePx / query_.view.widthPx),
              static_cast<float>(query_.sizePx / query_.view.heightPx));
  points_->bind();
  for (const std::uint32_t number : cells_) {
    const LightIndex::Cell& cell = objects_->lights.cells[number];
    const Vec3 origin = Vec3{16.0 * cell.origin[0], 16.0 * cell.origin[1], 16.0 * cell.origin[2]} - seenFrom_;
    glVertexAttrib3f(kCellOrigin, static_cast<float>(origin.x), static_cast<float>(origin.y),
                     static_cast<float>(origin.z));
    glDrawArraysInstancedBaseInstance(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(cell.count), cell.first);
  }
  glBindVertexArray(0);
}

}  // namespace trimtab::scene
