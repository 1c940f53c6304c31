#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trimtab/culling/select_objects.h"
#include "trimtab/terrain/format/object_terrain.h"

namespace trimtab::scene {

/// Keeps the models of a terrain on the GPU, and draws instances of them: one call for each level of a model,
/// however many instances it has. All calls need the context current.
class ObjectLayer {
 public:
  ObjectLayer();
  ~ObjectLayer();
  ObjectLayer(const ObjectLayer&) = delete;
  ObjectLayer& operator=(const ObjectLayer&) = delete;

  /// Uploads all meshes and textures. `objects` must outlive their use; null for none.
  void setObjects(const terrain::ObjectTerrain* objects);
  /// Uploads the instances that draw() draws. `tints` has one colour (RGBA8) for each, or none.
  void setInstances(const VisibleObjects& visible, std::span<const std::uint32_t> tints);
  /// Draws the instances of all levels with textures, or of those without. Programs read the attributes of
  /// object.vert.glsl.
  void draw(bool textured);
  /// Returns whether any instance that draw() would draw has textures, or has none.
  bool draws(bool textured) const;
  /// Binds the textures of the models to the active unit, as a 2D array.
  void bindTextures() const;

 private:
  /// The instances of one level.
  struct Run {
    terrain::ObjectMesh mesh;
    std::uint32_t first = 0, instances = 0;
    bool textured = false;
  };
  void uploadTextures(const std::vector<terrain::ObjectTexture>& textures);

  const terrain::ObjectTerrain* objects_ = nullptr;
  std::vector<std::uint8_t> textured_;  ///< one per level
  std::vector<Run> runs_;
  std::vector<DrawnObject> tinted_;
  unsigned vertexArray_ = 0, vertices_ = 0, indices_ = 0, instances_ = 0, textures_ = 0;
};

}  // namespace trimtab::scene
