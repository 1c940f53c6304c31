#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/grid/post_grid.h"

namespace trimtab::terrain {

/// Returns the sources that are CDBs, in their order.
std::vector<std::filesystem::path> cdbsAmong(const std::vector<std::filesystem::path>& sources);

/// Lists every file of the images of a bake: those that the options name, else those of each CDB.
std::vector<std::filesystem::path> imageFiles(const BakeOptions& options);
/// Lists those of imageFiles() that lie over the posts, as imageryOver(). It is no error if a CDB has none.
Result<std::vector<std::filesystem::path>> imagesOver(const BakeOptions& options, const PostGrid& posts);

/// Returns name, size and time of every file of a CDB and of its versions.
std::vector<std::string> cdbStamps(const std::filesystem::path& folder);

}  // namespace trimtab::terrain
