#include "trimtab/culling/depth_raster.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>
#define TRIMTAB_X86 1
#endif

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

namespace portable {
namespace {
inline unsigned bitsOf(I lanes) {
  unsigned bits = 0;
  for (std::size_t k = 0; k < kLanes; ++k) bits |= (static_cast<unsigned>(lanes[k]) & 1u) << k;
  return bits;
}
using W = F;
using WI = I;
#include "depth_raster_lanes.inl"
}  // namespace
}  // namespace portable

#if TRIMTAB_X86
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif
namespace avx2 {
namespace {
inline unsigned bitsOf(I lanes) {
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(lanes)));
}
using W = F;
using WI = I;
#include "depth_raster_lanes.inl"
}  // namespace
}  // namespace avx2
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

#if TRIMTAB_X86
#if defined(__clang__)
#pragma clang attribute push(__attribute__((target("avx512f,avx512vl,avx512dq,avx2"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq,avx2")
#endif
namespace avx512 {
namespace {
using avx2::bitsOf;
using W [[gnu::vector_size(64)]] = float;
using WI [[gnu::vector_size(64)]] = std::int32_t;
#include "depth_raster_lanes.inl"
}  // namespace
}  // namespace avx512
#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
#endif

#if TRIMTAB_X86
namespace {
template <class Run>
Run* pick(SimdLevel level, Run* avx2, Run* avx512) {
  static const bool all = __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq");
  level = std::min(level, simdLevel());
  return level == SimdLevel::portable ? nullptr : level == SimdLevel::avx512 && all ? avx512 : avx2;
}
}  // namespace
#endif

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
#if TRIMTAB_X86
  if (const auto run = pick(level, avx2::projectLanes, avx512::projectLanes))
    return run(projection, vertices, seen);
#endif
  (void)level;
  portable::projectLanes(projection, vertices, seen);
}

void draw(const Texels& to, const Seen& seen, const Triangles& triangles, Touched& touched, SimdLevel level) {
#if TRIMTAB_X86
  if (const auto run = pick(level, avx2::drawLanes, avx512::drawLanes))
    return run(to, seen, triangles, touched);
#endif
  (void)level;
  portable::drawLanes(to, seen, triangles, touched);
}

void rectangles(const Projection& projection, const BoxView& view, const Boxes& boxes, Rectangles& out,
                SimdLevel level) {
#if TRIMTAB_X86
  if (const auto run = pick(level, avx2::rectangleLanes, avx512::rectangleLanes))
    return run(projection, view, boxes, out);
#endif
  (void)level;
  portable::rectangleLanes(projection, view, boxes, out);
}

}  // namespace trimtab::depth
