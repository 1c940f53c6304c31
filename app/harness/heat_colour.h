#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace trimtab::harness {

/// Returns the sRGB colour of an error from 0 to 1: from black through blue and orange to pale yellow.
/// Lightness rises throughout, so that the order is visible in grey and to colour-blind people. The scale is
/// the square root of the error, because errors that matter are small.
std::array<std::uint8_t, 3> heatColour(double error);
/// Returns the RGBA pixels of a map of errors, in the same order.
std::vector<std::uint8_t> heatPixels(std::span<const float> errors);

}  // namespace trimtab::harness
