#pragma once

#include <optional>
#include <vector>

#include "trimtab/scene/symbology_geometry.h"

namespace trimtab::scene {

/// Symbols over the picture: one draw call a frame, its triangles made again only when something in them has
/// changed. The context is current for all of its life.
class SymbologyPass {
 public:
  SymbologyPass();
  ~SymbologyPass();
  SymbologyPass(const SymbologyPass&) = delete;
  SymbologyPass& operator=(const SymbologyPass&) = delete;

  /// Into the framebuffer that is bound. True when the triangles were made anew, which `anew` demands.
  bool draw(const SymbologyRequest& request, const ViewShape& view, bool anew = false);

 private:
  struct Vertex {
    float x, y;               ///< pixels
    float along, across;      ///< pixels from the stroke's start, and from its line
    float length, halfWidth;  ///< of the stroke
    std::uint8_t colour[4];
  };
  void rebuild();
  void add(const SymbolStroke& stroke, float halfWidth, std::array<std::uint8_t, 3> colour);

  std::optional<SymbologyRequest> shown_;
  ViewShape view_;
  SymbologyDrawing drawing_;
  std::vector<Vertex> vertices_;
  unsigned program_ = 0, vertexArray_ = 0, buffer_ = 0;
  int sizeUniform_ = -1;
};

}  // namespace trimtab::scene
