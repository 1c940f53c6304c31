#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace trimtab::terrain {

/// Keys of `steps` + 1 posts in a line, `stride` floats from one to the next: at any tolerance not below
/// `least`, those whose key is greater keep all others within it. A line is split at the post that is
/// furthest off, and so are its parts. Ends, and posts that no such tolerance needs, have the key 0.
void sideKeys(const float* z, std::ptrdiff_t stride, std::uint32_t steps, double least,
              std::vector<double>& keys);

}  // namespace trimtab::terrain
