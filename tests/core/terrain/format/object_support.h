#pragma once

#include <cmath>

#include "trimtab/terrain/format/object_file.h"

/// A small set of objects: two models, three cells, five instances, three lights in two cells.
namespace trimtab::test {

inline terrain::ObjectTerrain smallObjects(bool textured) {
  terrain::ObjectTerrain objects;
  ObjectIndex& index = objects.index;
  index.frame = LocalFrame({Degrees{46.5}, Degrees{8.25}, Metres{0}});
  index.models = {{0, 2, 4}, {2, 1, 4}};
  index.levels = {{0, 2, 4}, {0.5f, 1, 3}, {0, 1, 3}};
  objects.names = {"shed", "mast"};
  const auto vertex = [&](float x, float y, float z) {
    terrain::ObjectVertex v;
    v.x = x;
    v.y = y;
    v.z = z;
    v.texture = textured ? std::uint8_t{0} : terrain::ObjectVertex::kNoTexture;
    v.place = {0x3c00, 0x3800};
    return v;
  };
  objects.vertices = {vertex(-2, 0, 0), vertex(2, 0, 0), vertex(2, 0, 3), vertex(-2, 0, 3), vertex(-2, 0, 0),
                      vertex(2, 0, 0),  vertex(0, 0, 3), vertex(0, 0, 0), vertex(1, 0, 0),  vertex(0, 0, 4)};
  objects.indices = {0, 1, 2, 0, 2, 3, 0, 1, 2, 0, 1, 2};
  objects.meshes = {{0, 0, 6, 1}, {4, 6, 3, 1}, {7, 9, 3, 0}};
  if (textured)
    objects.textures = {{std::vector<std::uint8_t>(
        std::size_t{4} * terrain::ObjectTexture::kSidePx * terrain::ObjectTexture::kSidePx, 200)}};
  for (int i = 0; i < 5; ++i) {
    ObjectInstance instance;
    instance.x = static_cast<float>(i * 10);
    instance.model = static_cast<std::uint32_t>(i % 2);
    if (i == 1) instance.turn = {0, 0, 23170, 23170};
    index.instances.push_back(instance);
  }
  const Box box{-5, -5, -5, 65, 5, 5};
  index.cells = {{box, {0, 0, 0}, 0, 5, 3, 4, 0.5f},
                 {box, {0, 0, 0}, 0, 2, 2, 4, 0.5f},
                 {box, {1, 0, 0}, 2, 3, 3, 4, 0.5f}};
  objects.lights.points = {{0, 0, 1, {255, 0, 0, 255}}, {4, 0, 1}, {-3, 2, 0.5f, {0, 255, 0, 255}}};
  objects.lights.cells = {{{16, 0, 1, 20, 0, 1}, {1, 0, 0}, 0, 2}, {{-4, 1, 0, 0, 2, 1}, {0, 0, 0}, 2, 1}};
  return objects;
}

}  // namespace trimtab::test
