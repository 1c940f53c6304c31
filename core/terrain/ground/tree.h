#pragma once

#include <array>
#include <functional>
#include <vector>

#include "texels.h"
#include "trimtab/terrain/format/ground_pyramid.h"

/// The tiles of the ground's pyramid as a tree: each is made of those under it.
namespace trimtab::terrain {

struct GroundPlace {
  std::uint32_t level = 0, column = 0, row = 0;
};

/// The tiles under one, from the south-west; those past the border are left out.
std::vector<GroundPlace> tilesBelow(const std::vector<GroundShape::Level>& levels, const GroundPlace& place);

using ReadGroundTile = std::function<Result<GroundTile>(const GroundPlace&)>;
Result<GroundTile> halvedFrom(const std::vector<GroundShape::Level>& levels, const GroundPlace& place,
                              const ReadGroundTile& read);

}  // namespace trimtab::terrain
