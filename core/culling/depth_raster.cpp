#include "trimtab/culling/depth_raster.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "trimtab/units/simd.h"

namespace trimtab::depth {
namespace {

/// Texels that a sample may lie outside an edge and still be taken for inside it, and the relative error of a
/// plane through three vertices: see depth_map.h.
constexpr float kOutsideEdge = 1.0f / 64, kRounding = 1.0f / (1 << 20);

/// Texels a side of triangles that are filled several at a time.
constexpr int kSmall = 2;

/// Rows of texels that are filled without a look at how many it takes.
constexpr int kBlockRows = 4;

using F [[gnu::vector_size(32)]] = float;
using I [[gnu::vector_size(32)]] = std::int32_t;

/// Texels to the side of the first, as many as the widest registers hold.
constexpr float kSteps[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

}  // namespace

#define TRIMTAB_KERNELS "core/culling/depth_raster_kernels.inl"
#include "trimtab/units/simd_levels.inl"

Triangles::Triangles(std::span<const std::uint16_t> indices) : count_(indices.size() / 3) {
  const std::size_t groups = (count_ + kLanes - 1) / kLanes;
  corners_.resize(groups * 3 * kLanes);
  for (std::size_t i = 0; i < count_; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      corners_[(i / kLanes * 3 + k) * kLanes + i % kLanes] = indices[3 * i + k];
}

void Seen::resize(std::size_t count) {
  const std::size_t padded = (count + kLanes - 1) / kLanes * kLanes;
  for (auto* v : {&x, &y, &w, &right, &up, &depth}) v->resize(padded);
  kept.resize(padded);
}

void project(const Projection& projection, const Vertices& vertices, Seen& seen, SimdLevel level) {
  seen.resize(vertices.count);
  TRIMTAB_PICK(level, projectLanes)(projection, vertices, seen);
}

void draw(const Texels& to, const Seen& seen, const Triangles& triangles, Touched& touched, SimdLevel level) {
  TRIMTAB_PICK(level, drawLanes)(to, seen, triangles, touched);
}

void rectangles(const Projection& projection, const BoxView& view, const Boxes& boxes, Rectangles& out,
                SimdLevel level) {
  TRIMTAB_PICK(level, rectangleLanes)(projection, view, boxes, out);
}

}  // namespace trimtab::depth
