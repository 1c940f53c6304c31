#pragma once

#include <cstdint>

namespace trimtab::terrain {

/// A post by its column from the west and its row from the south.
struct PostPlace {
  std::uint32_t column, row;
  friend bool operator==(const PostPlace&, const PostPlace&) = default;
};

}  // namespace trimtab::terrain
