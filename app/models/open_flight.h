#pragma once

#include <string>

namespace trimtab::models {

/// Gives levels of detail of an OpenFlight file ranges by their significant sizes, where they have no other:
/// OpenSceneGraph knows only ranges, and shows nothing of a level whose switch-in and switch-out distances
/// are both 0, as in models of a CDB. Of levels side by side the one of the least significant size is the
/// finest, and takes the place of the others (exchange); a level inside another is added where it is fine
/// enough. Distances are in proportion to sizes: their order alone is meant. Bytes that are no records stay.
///
/// Source: OpenFlight Scene Description 16, level of detail record (opcode 73): switch-in at byte 16,
/// switch-out at 24, significant size at 72, big endian; push 10, pop 11. What the sizes mean: CDB volume 6.
std::string withRangesBySize(std::string bytes);

}  // namespace trimtab::models
