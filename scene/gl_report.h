#pragma once

#include "trimtab/scene/renderer.h"

namespace trimtab::scene {

/// Of the context that is current.
GlReport reportContext();
/// Whether GL is this processor.
bool contextIsSoftware();
/// Bits of a pixel that its rasteriser keeps of a vertex's place; GL's least where it does not say.
int subpixelBitsOfContext();

}  // namespace trimtab::scene
