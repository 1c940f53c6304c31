#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/units/quantity.h"

/// Elevation or scenery in, database out.
namespace trimtab::terrain {

struct BakeOptions {
  std::vector<std::filesystem::path> sources;  ///< elevation files or folders of them; or scenery
  std::optional<std::filesystem::path> imagery;
  std::uint32_t trianglesPerNode = 2000;  ///< of the static levels of detail, where the source is scenery
  bool keepLines = false;      ///< roads, streams and shorelines stay in them while a pixel shows them
  std::optional<Metres> post;  ///< distance of posts; else by the scenery's size, or the finest file's
  /// Vertical error of the finest patches at the posts; else defaultLeafToleranceM
  /// (trimtab/terrain/patches/build.h). 0: exact.
  std::optional<Metres> maxError;
  /// Most that baking may use. A database whose tiles, or whose scenery's trees, would take more is made
  /// without them, and drawn from patches.
  Megabytes memory{1024};
  std::filesystem::path output;
  Progress progress;
};
/// Elevation, or scenery with its trees of static levels of detail, to a database: written to a folder beside
/// `output` (".NAME.work") that takes its name when complete. Interrupted, that folder stays, and the same
/// options go on from it to the same bytes; other sources or options begin anew. One at a time: findings say
/// so.
Result<std::shared_ptr<const Database>> bake(const BakeOptions& options);
inline constexpr std::uint32_t kMostBakeParts = 4096;
/// One of `parts` shares of the same work (part from 1; at most kMostBakeParts), for several processes, or
/// machines that share the output's folder: they may work at once. Memory, progress and number of parts may
/// differ.
Result<Done> bakePart(const BakeOptions& options, std::uint32_t part, std::uint32_t parts);
/// Makes the database of what the parts made, if it is all there.
Result<std::shared_ptr<const Database>> bakeJoin(const BakeOptions& options);

}  // namespace trimtab::terrain
