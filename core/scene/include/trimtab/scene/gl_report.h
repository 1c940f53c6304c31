#pragma once

#include <string>

namespace trimtab::scene {

/// GL text of the current context, and whether what the renderer needs is there.
struct GlReport {
  std::string vendor, renderer, version;
  bool software = false;
  bool usable = false;
  std::string missing;  ///< what is not there
  std::string drawing;  ///< how the terrain's draws reach GL, and why so (DrawChoice in multi_draw.h)
};

/// Of the context that is current.
GlReport reportContext();
/// Whether GL is this processor.
bool contextIsSoftware();
/// Bits of a pixel that its rasteriser keeps of a vertex's place; GL's least where it does not say.
int subpixelBitsOfContext();

}  // namespace trimtab::scene
