#pragma once

#include <cstddef>

namespace trimtab::scene {

/// Counts the objects of each kind that a GL context holds, whoever made them.
struct GlObjects {
  std::size_t buffers = 0, textures = 0, framebuffers = 0, renderbuffers = 0, vertexArrays = 0, queries = 0,
              programs = 0, shaders = 0;
  std::size_t total() const {
    return buffers + textures + framebuffers + renderbuffers + vertexArrays + queries + programs + shaders;
  }
};

/// Counts the objects of the current context by asking GL for each name from 1 to kNamesAsked. It takes about
/// a millisecond, changes nothing, and sees what no wrapper class counts, as an object that was leaked. A
/// name that was reserved and never bound is no object. Larger names are not seen: drivers give the lowest
/// free one, and a renderer has some hundreds of objects.
GlObjects glObjectsOfContext();
inline constexpr unsigned kNamesAsked = 4096;

}  // namespace trimtab::scene
