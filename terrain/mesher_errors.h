#pragma once

#include <span>

#include "trimtab/terrain/mesher_greedy.h"

namespace trimtab::terrain {

struct PostErrors {
  double max = 0, rms = 0;
};
/// At every post, of a mesh that covers a field of step 1, in places of the field. `sums`: one a triangle,
/// if known; `worst` may be more than it is.
PostErrors postErrors(const Triangulation& mesh, const HeightField& field, std::span<const PostSum> sums);

}  // namespace trimtab::terrain
