#pragma once

#include <array>
#include <functional>
#include <vector>

#include "texels.h"
#include "trimtab/terrain/format/ground_pyramid.h"

/// The tiles of the ground pyramid as a tree: each tile is made of the up to four finer tiles below it.
namespace trimtab::terrain {

struct GroundPlace {
  std::uint32_t level = 0, column = 0, row = 0;
};

/// Returns the tiles one level finer below `place`, from the south-west on, without those beyond the border.
std::vector<GroundPlace> tilesBelow(const std::vector<GroundShape::Level>& levels, const GroundPlace& place);

using ReadGroundTile = std::function<Result<GroundTile>(const GroundPlace&)>;
/// Makes the tile at `place` from those below it.
Result<GroundTile> halvedFrom(const std::vector<GroundShape::Level>& levels, const GroundPlace& place,
                              const ReadGroundTile& read);

}  // namespace trimtab::terrain
