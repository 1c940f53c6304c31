#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/terrain/static_lod/lattice.h"

namespace trimtab::terrain {

/// Measures how far above or below a surface a place lies. Upright triangles are left out.
class VerticalDistance {
 public:
  /// The arrays must outlive it.
  VerticalDistance(std::span<const Lattice> vertices,
                   std::span<const std::array<std::uint32_t, 3>> triangles);

  /// Returns the smallest vertical distance in metres to those of the triangles [first, last) that lie above
  /// or below `p`, their borders included exactly; null if there is none.
  std::optional<double> metres(const Lattice& p, std::uint32_t first, std::uint32_t last) const;
  /// Returns the first triangle above or below `p`; null if there is none.
  std::optional<std::uint32_t> at(const Lattice& p) const;

 private:
  template <class Visit>
  void forEachCell(std::uint32_t triangle, const Visit& visit) const;
  template <class Visit>
  void forEachOver(const Lattice& p, std::uint32_t first, std::uint32_t last, const Visit& visit) const;

  std::span<const Lattice> vertices_;
  std::span<const std::array<std::uint32_t, 3>> triangles_;
  std::int32_t minX_ = 0, minY_ = 0;
  std::int64_t cell_ = 1, columns_ = 1, rows_ = 1;
  std::vector<std::uint32_t> firstOfCell_, inCell_;
};

}  // namespace trimtab::terrain
