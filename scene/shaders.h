#pragma once

namespace trimtab::scene {

/// GLSL of every pass. Texture units: see kSlotUnit and its neighbours.
constexpr int kSlotUnit = 4, kTintUnit = 5;

extern const char* const kTerrainVertex;
extern const char* const kTerrainFragment;
extern const char* const kSkyVertex;
extern const char* const kSkyFragment;
extern const char* const kLineVertex;
extern const char* const kLineFragment;

}  // namespace trimtab::scene
