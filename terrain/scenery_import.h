#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/terrain/database.h"
#include "trimtab/terrain/post_grid.h"
#include "trimtab/terrain/scenery.h"

namespace trimtab::terrain {

/// Posts from the south-west to the north-east corner of what the triangles cover, both included. Without a
/// distance: 30 m, and up to 60 m where that keeps the grid at about six million posts.
Result<PostGrid> sceneryPosts(std::span<const SceneryMesh> meshes, std::optional<Metres> distance);
/// Posts over a rectangle of degrees, its corners included; without a distance as above.
Result<PostGrid> postsOver(double west, double south, double east, double north,
                           std::optional<Metres> distance);

/// The surface at each post, the highest where there are several, NaN where there is none; the material's
/// colour as the post's image, alpha 0 where there is no surface. Heights to a centimetre: tiles hold theirs
/// to some millimetres. What lies in no
/// mesh's rectangle is open sea where its borders are, with a note; the rest of it counts as `outside`.
/// `elevation`, where there is one: heights, with NaN for none, for the posts that no triangle covers.
Result<HeightGrid> rasterised(std::span<const SceneryMesh> meshes, const PostGrid& posts,
                              const Progress& progress, const HeightGrid* elevation = nullptr);

struct ImportedScenery {
  HeightGrid grid;  ///< no voids left
  std::uint64_t voidsFilled = 0;
  std::vector<SceneryMesh> meshes;
  SceneryCounts counts;
};
/// Reads all sources and puts them on one grid. A tile that two sources hold counts once.
Result<ImportedScenery> importScenery(std::span<const std::filesystem::path> sources,
                                      std::optional<Metres> distance, const Progress& progress);

/// All tiles of some sources, each once.
Result<Scenery> readSceneries(std::span<const std::filesystem::path> sources, const Progress& progress);

/// What the meshes of some scenery hold.
SceneryCounts countsOf(const Scenery& scenery);

}  // namespace trimtab::terrain
