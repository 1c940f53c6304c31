#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace trimtab::terrain {

/// Orders triangles by the places of their corners, whichever comes first, and by their material. Vertices
/// have no say: one place may have several, one for each material or because a collapse put a new one there.
template <class Place>
class FaceCount {
 public:
  void add(std::array<Place, 3> corners, std::uint16_t material) {
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    faces_.push_back({corners, material});
  }
  /// Returns how many different ones were added.
  std::uint64_t distinct() {
    std::sort(faces_.begin(), faces_.end());
    return static_cast<std::uint64_t>(std::unique(faces_.begin(), faces_.end()) - faces_.begin());
  }

 private:
  struct Face {
    std::array<Place, 3> corners;
    std::uint16_t material;
    auto operator<=>(const Face&) const = default;
  };
  std::vector<Face> faces_;
};

}  // namespace trimtab::terrain
