#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trimtab/terrain/format/page_file.h"
#include "trimtab/terrain/format/patch_terrain.h"
#include "trimtab/terrain/grid/post_geometry.h"

/// Patches on disk: a page file with a blob a page, one for what the index measured and one for the facts.
namespace trimtab::terrain {

/// Returns a page as bytes: a vertex is its post, its height in 1/256 m, its normal; places follow from the
/// geometry, exactly (what does not is listed). Vertices and triangles go through meshoptimizer's codecs:
/// vertices are put in the order of their first use, triangles in one that is near to strips. Of a coarser
/// variant, which has four in five of its triangles from the finer one, only the others are; bits tell where
/// they stand.
std::vector<std::byte> encodePage(const PatchPage& page, const PatchIndex& index,
                                  const PostGeometry& geometry);
/// Returns the page again: the same triangles, places and normals. `where` names the bytes in findings.
/// Whatever the bytes are, all indices of the result are good for it, and its posts are of the grid.
Result<PatchPage> decodePage(std::span<const std::byte> bytes, const PatchIndex& index, std::uint32_t page,
                             const PostGeometry& geometry, const std::string& where);

/// Adds what was measured (`index` is finished) to a file that has every page under its number, and ends it.
Result<Done> finishPatchFile(PageFileWriter& writer, const PostGrid& posts, const PatchIndex& index,
                             const std::vector<PatchFacts>& facts);
/// Reads the index and the facts; pages when they are asked for.
Result<std::shared_ptr<const PatchTerrain>> openPatches(std::shared_ptr<const PageFile> pages,
                                                        const std::filesystem::path& file,
                                                        const PostGrid& posts);

}  // namespace trimtab::terrain
