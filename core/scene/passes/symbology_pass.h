#pragma once

#include <optional>
#include <vector>

#include "trimtab/scene/symbology_geometry.h"

namespace trimtab::scene {

/// Draws symbols over the image with one draw call per frame. Makes their triangles only if something in
/// them has changed. The context must be current for all of its life.
class SymbologyPass {
 public:
  SymbologyPass();
  ~SymbologyPass();
  SymbologyPass(const SymbologyPass&) = delete;
  SymbologyPass& operator=(const SymbologyPass&) = delete;

  /// Draws into the framebuffer that is bound. Returns true if the triangles were made, which `anew`
  /// demands.
  bool draw(const SymbologyRequest& request, const ViewShape& view, bool anew = false);
  /// Returns how many of the host's symbols the triangles miss; see FrameCounters.
  std::size_t hostSymbolsLeftOut() const { return drawing_.hostSymbolsLeftOut; }

 private:
  struct Vertex {
    float x, y;               ///< pixels
    float along, across;      ///< pixels from the stroke's start, and from its line
    float length, halfWidth;  ///< of the stroke
    std::uint8_t rgba[4];
  };
  void rebuild();
  void add(const SymbolStroke& stroke, float halfWidth, std::array<std::uint8_t, 4> rgba);
  void add(const HostMark& mark);

  std::optional<SymbologyRequest> shown_;
  ViewShape view_;
  SymbologyDrawing drawing_;
  std::vector<Vertex> vertices_;
  unsigned program_ = 0, vertexArray_ = 0, buffer_ = 0;
  int sizeUniform_ = -1;
};

}  // namespace trimtab::scene
