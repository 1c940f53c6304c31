#include "object_layer.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/scene/gl/gl_api.h"
#include "core/scene/gl/gl_buffer.h"
#include "core/scene/gl/mesh_pool.h"

namespace trimtab::scene {
namespace {

using terrain::ObjectTexture;
using terrain::ObjectVertex;

constexpr std::array kModelAttributes{
    VertexAttribute{0, 3, GL_FLOAT, false, offsetof(ObjectVertex, x)},
    VertexAttribute{1, 3, GL_BYTE, true, offsetof(ObjectVertex, normal)},
    VertexAttribute{2, 2, GL_HALF_FLOAT, false, offsetof(ObjectVertex, place)},
    VertexAttribute{3, 4, GL_UNSIGNED_BYTE, true, offsetof(ObjectVertex, colour)},
    VertexAttribute{4, 1, GL_UNSIGNED_BYTE, false, offsetof(ObjectVertex, texture)}};
constexpr std::array kInstanceAttributes{
    VertexAttribute{5, 4, GL_FLOAT, false, offsetof(DrawnObject, x)},
    VertexAttribute{6, 4, GL_SHORT, true, offsetof(DrawnObject, turn)},
    VertexAttribute{7, 4, GL_UNSIGNED_BYTE, true, offsetof(DrawnObject, cell)}};

}  // namespace

ObjectLayer::ObjectLayer() {
  glGenVertexArrays(1, &vertexArray_);
  glGenTextures(1, &textures_);
  for (unsigned* buffer : {&vertices_, &indices_, &instances_}) glGenBuffers(1, buffer);
  glBindVertexArray(vertexArray_);
  glBindBuffer(GL_ARRAY_BUFFER, vertices_);
  defineAttributes(kModelAttributes, sizeof(ObjectVertex));
  glBindBuffer(GL_ARRAY_BUFFER, instances_);
  defineAttributes(kInstanceAttributes, sizeof(DrawnObject));
  for (const VertexAttribute& attribute : kInstanceAttributes) glVertexAttribDivisor(attribute.index, 1);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_);
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

ObjectLayer::~ObjectLayer() {
  for (const unsigned buffer : {vertices_, indices_, instances_}) glDeleteBuffers(1, &buffer);
  glDeleteTextures(1, &textures_);
  glDeleteVertexArrays(1, &vertexArray_);
}

void ObjectLayer::setObjects(const terrain::ObjectTerrain* objects) {
  objects_ = objects;
  runs_.clear();
  textured_.clear();
  if (!objects) return;
  uploadBuffer(vertices_, objects->vertices.data(), objects->vertices.size() * sizeof(ObjectVertex));
  uploadBuffer(indices_, objects->indices.data(), objects->indices.size() * sizeof(std::uint32_t));
  for (const terrain::ObjectMesh& mesh : objects->meshes) {
    const auto first = objects->indices.begin() + mesh.firstIndex;
    textured_.push_back(std::any_of(first, first + mesh.indices, [&](std::uint32_t i) {
      return objects->vertices[mesh.firstVertex + i].texture != ObjectVertex::kNoTexture;
    }));
  }
  uploadTextures(objects->textures);
}

void ObjectLayer::uploadTextures(const std::vector<ObjectTexture>& textures) {
  if (textures.empty()) return;
  constexpr auto kSide = static_cast<GLsizei>(ObjectTexture::kSidePx);
  constexpr GLsizei kLevels = 9;  // down to one texel
  static_assert(1 << (kLevels - 1) == kSide);
  // A texture that was allocated keeps its size for ever.
  glDeleteTextures(1, &textures_);
  glGenTextures(1, &textures_);
  glBindTexture(GL_TEXTURE_2D_ARRAY, textures_);
  glTexStorage3D(GL_TEXTURE_2D_ARRAY, kLevels, GL_RGBA8, kSide, kSide, static_cast<GLsizei>(textures.size()));
  for (std::size_t i = 0; i < textures.size(); ++i)
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, static_cast<GLint>(i), kSide, kSide, 1, GL_RGBA,
                    GL_UNSIGNED_BYTE, textures[i].pixels.data());
  glGenerateMipmap(GL_TEXTURE_2D_ARRAY);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D_ARRAY, wrap, GL_REPEAT);
  glBindTexture(GL_TEXTURE_2D_ARRAY, 0);
}

void ObjectLayer::setInstances(const VisibleObjects& visible, std::span<const std::uint32_t> tints) {
  runs_.clear();
  if (!objects_) return;
  for (std::size_t level = 0; level < objects_->meshes.size(); ++level) {
    const std::uint32_t first = visible.firstOfLevel[level], end = visible.firstOfLevel[level + 1];
    if (first < end) runs_.push_back({objects_->meshes[level], first, end - first, textured_[level] != 0});
  }
  const std::vector<DrawnObject>* upload = &visible.drawn;
  if (tints.size() == visible.drawn.size()) {
    // The GPU reads the colour where the processor keeps the cell.
    tinted_ = visible.drawn;
    for (std::size_t i = 0; i < tints.size(); ++i) tinted_[i].cell = tints[i];
    upload = &tinted_;
  }
  if (!upload->empty()) uploadBuffer(instances_, upload->data(), upload->size() * sizeof(DrawnObject));
}

bool ObjectLayer::draws(bool textured) const {
  return std::any_of(runs_.begin(), runs_.end(), [&](const Run& run) { return run.textured == textured; });
}

void ObjectLayer::draw(bool textured) {
  glBindVertexArray(vertexArray_);
  for (const Run& run : runs_) {
    if (run.textured != textured) continue;
    if (run.mesh.bothSides != 0)
      glDisable(GL_CULL_FACE);
    else
      glEnable(GL_CULL_FACE);
    glDrawElementsInstancedBaseVertexBaseInstance(
        GL_TRIANGLES, static_cast<GLsizei>(run.mesh.indices), GL_UNSIGNED_INT,
        reinterpret_cast<const void*>(run.mesh.firstIndex * sizeof(std::uint32_t)),
        static_cast<GLsizei>(run.instances), static_cast<GLint>(run.mesh.firstVertex), run.first);
  }
  glDisable(GL_CULL_FACE);
  glBindVertexArray(0);
}

void ObjectLayer::bindTextures() const {
  glBindTexture(GL_TEXTURE_2D_ARRAY, textures_);
}

}  // namespace trimtab::scene
