#pragma once

#include <string>

namespace trimtab::terrain {

/// A sum over what this machine's C library makes of some thousands of numbers, and which GDAL and PROJ it
/// has. Where it differs a bake may differ in the last bits: a library's sines, powers and logarithms are not
/// the same to the bit in every version, nor with every processor.
std::string arithmeticOfThisMachine();

}  // namespace trimtab::terrain
