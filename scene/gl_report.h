#pragma once

#include "trimtab/scene/renderer.h"

namespace trimtab::scene {

/// Of the context that is current.
GlReport reportContext();

}  // namespace trimtab::scene
