#pragma once

#include <span>

#include "greedy.h"
#include "trimtab/terrain/mesh/lanes.h"

namespace trimtab::terrain {

/// Over the posts that forEachFour visits in a triangle; nothing is rounded.
PostSum sumOfPosts(const Triangulation::Vertex* const corner[3], const bool border[3], const PostRows& posts);

struct PostErrors {
  double max = 0, rms = 0;
};
/// At every post, of a mesh that covers a field of step 1, in places of the field. `sums`: one a triangle,
/// if known; `worst` may be more than it is.
PostErrors postErrors(const Triangulation& mesh, const HeightField& field, std::span<const PostSum> sums,
                      unsigned threads);

}  // namespace trimtab::terrain
