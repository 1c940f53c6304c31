#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trimtab/terrain/format/object_terrain.h"
#include "trimtab/terrain/objects/source_model.h"

namespace trimtab::terrain {

/// Scales an image to ObjectTexture's size: every texel is the mean of what it covers, colours weighted by
/// opacity, so that what is clear does not colour what is not. An image whose size is not that of its pixels
/// becomes white.
ObjectTexture scaledTexture(const SourceTexture& source);

/// Returns the mean colour of a texture, weighted by opacity, and its mean opacity.
std::array<std::uint8_t, 4> meanColour(const ObjectTexture& texture);

/// Returns the product of two colours, of which 255 is 1.
std::array<std::uint8_t, 4> product(const std::array<std::uint8_t, 4>& a,
                                    const std::array<std::uint8_t, 4>& b);

/// Returns the mean colour of a mesh by area, opaque. `textures`: the mean colours of its textures.
std::array<std::uint8_t, 4> meanColour(const SourceMesh& mesh,
                                       const std::vector<std::array<std::uint8_t, 4>>& textures);

}  // namespace trimtab::terrain
