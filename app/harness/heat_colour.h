#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace trimtab::harness {

/// The colour of an error of 0..1, sRGB: black by blue and orange to pale yellow, its lightness rising all
/// the way, so that the colour-blind and a grey print order it too. By the square root, because errors that
/// matter are small.
std::array<std::uint8_t, 3> heatColour(double error);
/// RGBA of a map of errors, rows as they are.
std::vector<std::uint8_t> heatPixels(std::span<const float> errors);

}  // namespace trimtab::harness
