#pragma once

#include <string>

namespace trimtab::scene {

/// The current context's GL strings, and whether it has what the renderer needs.
struct GlReport {
  std::string vendor, renderer, version;
  bool software = false;
  bool usable = false;
  std::string missing;  ///< what the renderer needs and the context lacks
  std::string drawing;  ///< how draws reach GL, and the reason (DrawChoice in multi_draw.h)
};

/// Reports on the current context.
GlReport reportContext();
/// Returns whether the current context is a software rasteriser.
bool contextIsSoftware();
/// Returns how many bits of a pixel the rasteriser keeps of a vertex's position, at least GL's minimum of 4.
int subpixelBitsOfContext();

}  // namespace trimtab::scene
