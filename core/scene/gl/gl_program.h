#pragma once

namespace trimtab::scene {

/// A linked program of a vertex and a fragment shader, for passes outside the graph; 0 when the driver
/// refuses it.
unsigned makeGlProgram(const char* vertex, const char* fragment);

}  // namespace trimtab::scene
