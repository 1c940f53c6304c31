#pragma once

#include <string>
#include <vector>

namespace trimtab::scene {

/// Texture units that the shaders and the passes agree on; the ground's is kGroundUnit in ground_texture.h.
constexpr int kSlotUnit = 4, kTintUnit = 5, kPartUnit = 6, kTestedUnit = 7, kDepthUnit = 2, kPyramidUnit = 3;

/// Returns the text of the file core/scene/shaders/NAME as GL accepts it: see completeShader. The build
/// embeds the files. A name that is not among them is a broken contract and ends the program.
std::string shaderText(const char* name, const std::vector<const char*>& defines = {});

/// Replaces every `#include "NAME"` line by that shader file, and inserts after the first line, which has to
/// be `#version`, a `#define` for each constant that C++ and the shaders share and for each of `defines`.
std::string completeShader(std::string text, const std::vector<const char*>& defines = {});

}  // namespace trimtab::scene
