#pragma once

namespace trimtab::scene {

/// Drops and flakes: near ones as quads that stretch along their way, far drops as lines, far flakes as
/// points. Geometry, cells and `inversePeriod` are osgParticle::PrecipitationEffect's.
extern const char* const kDropQuadVertex;
extern const char* const kDropLineVertex;
extern const char* const kDropPointVertex;
extern const char* const kDropFragment;

}  // namespace trimtab::scene
