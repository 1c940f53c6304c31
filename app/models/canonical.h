#pragma once

#include "trimtab/terrain/objects/source_model.h"

namespace trimtab::models {

/// Puts textures and triangles into an order that depends on what they hold alone. OpenSceneGraph's readers
/// sort by addresses, so that the same file gives another order in another run; a bake would then begin anew.
/// Afterwards no two triangles share a vertex.
void makeCanonical(terrain::SourceModel& model);

}  // namespace trimtab::models
