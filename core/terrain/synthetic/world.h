#pragma once

#include <filesystem>

#include "landscape.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// A sample's ground, of which `land.heights` are final and `posts` are its posts.
struct WorldGround {
  const Landscape& land;
  const PostGrid& posts;
  double flatM = 0;  ///< radius of the flat in the middle, where the airfield is
  std::uint32_t seed = 1;
};

/// Writes a list of woods, a town, an airfield and a line of pylons (trimtab/host/placement_list.h), and the
/// models it names into a folder beside it of the list's name without ending.
Result<Done> writeWorld(const std::filesystem::path& list, const WorldGround& ground);

}  // namespace trimtab::terrain
