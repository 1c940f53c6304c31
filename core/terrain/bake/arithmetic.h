#pragma once

#include <string>

namespace trimtab::terrain {

/// Returns a checksum of this machine's arithmetic: some thousands of results of its C library, and the
/// versions of GDAL and PROJ. Machines with different checksums may bake databases that differ in the last
/// bits, because sines, powers and logarithms vary with library and processor.
std::string arithmeticOfThisMachine();

}  // namespace trimtab::terrain
