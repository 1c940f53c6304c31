#pragma once

#include <string>

namespace trimtab::scene {

/// Links a program for a pass outside the scene graph from the texts of its shaders. Returns 0 if the driver
/// refuses them, and prints its log.
unsigned makeGlProgram(const std::string& vertex, const std::string& fragment);

}  // namespace trimtab::scene
