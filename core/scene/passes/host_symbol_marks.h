#pragma once

#include "trimtab/scene/symbology_geometry.h"

namespace trimtab::scene {

/// Appends the marks of the host's symbols and their box. Surfaces are drawn by ascending id, the symbols of
/// one by layer and then by id (CIGI 3.3 ICD, 4.1.29 and 4.1.34), all clipped to their surface.
void drawHostSymbols(const SymbologyRequest& request, const ViewShape& view, SymbologyDrawing& drawing);

}  // namespace trimtab::scene
