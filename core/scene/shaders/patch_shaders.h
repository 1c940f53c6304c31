#pragma once

#include "shaders.h"

namespace trimtab::scene {

/// Colour and light come from the ground by the post's place and not from vertices, so that a level of detail
/// changes the outline of land and nothing else.
TerrainShaders patchShaders();

}  // namespace trimtab::scene
