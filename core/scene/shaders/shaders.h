#pragma once

#include <string>

#include "trimtab/preset/parameters.h"

// A vertex's place relative to the eye. The vertex is a multiple of 1/256 m and the tile's offset from eyeHi
// one of 16 m, so their sum is the same number in every tile that shares the post: borders close to the bit
// and nothing jitters, however far the origin is. `precise` forbids to sum in another order.
#define TRIMTAB_RELATIVE_POSITION                                \
  "uniform isamplerBuffer slots;\n"                              \
  "uniform ivec3 eyeHi;\n"                                       \
  "uniform vec3 eyeLo;\n"                                        \
  "vec3 relativePosition(vec3 inTile, ivec4 slot) {\n"           \
  "  precise vec3 p = inTile + vec3(slot.xyz - eyeHi) * 16.0;\n" \
  "  p -= eyeLo;\n"                                              \
  "  return p;\n"                                                \
  "}\n"

namespace trimtab::scene {

/// GLSL of every pass. Texture units: see kSlotUnit and its neighbours.
constexpr int kSlotUnit = 4, kTintUnit = 5, kPartUnit = 6, kTestedUnit = 7, kDepthUnit = 2, kPyramidUnit = 3;

/// A terrain's surface, by the form that is drawn.
struct TerrainShaders {
  std::string vertex, fragment;
};
TerrainShaders terrainShaders(TerrainForm form);

extern const char* const kScreenVertex;
extern const char* const kSkyFragment;
extern const char* const kLineVertex;
extern const char* const kLineFragment;
extern const char* const kTreeFlatVertex;

/// A terrain vertex shader that also tells kNodeFragment which node it draws.
std::string forNodes(std::string vertexShader);
extern const char* const kNodeFragment;

extern const char* const kOccluderVertex;
extern const char* const kOccluderFragment;
extern const char* const kReduceFragment;
extern const char* const kTestFragment;

}  // namespace trimtab::scene
