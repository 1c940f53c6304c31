#pragma once

#include <string>

namespace trimtab::scene {

/// The current context's GL strings, and whether it has what the renderer needs.
struct GlReport {
  std::string vendor, renderer, version;
  bool software = false;  ///< as contextIsSoftware() says
  bool usable = false;    ///< the renderer can draw in it
  std::string missing;    ///< what the renderer needs and the context misses; empty if it is usable
  /// The way in which draws reach GL, and the reason (DrawChoice in core/scene/gl/multi_draw.h); empty unless
  /// it is usable.
  std::string drawing;
};

/// Reports on the current context and clears its GL errors. Without a context, only `missing` is set.
GlReport reportContext();
/// Returns whether the renderer string of the current context names a software rasteriser that is known here.
/// Returns false without a context.
bool contextIsSoftware();
/// Returns GL_SUBPIXEL_BITS of the current context: how many binary places of a pixel the rasteriser keeps of
/// a vertex's position. It is never below GL's minimum of 4, which is also the answer without a context.
int subpixelBitsOfContext();

}  // namespace trimtab::scene
