#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/objects/source_model.h"
#include "trimtab/units/quantity.h"

/// Bakes elevation or FlightGear scenery to a terrain database (resources/docs/terrain-format.md).
namespace trimtab::terrain {

struct BakeOptions {
  /// Elevation files, folders of them, scenery, or CDBs, whose imagery and features are baked too.
  std::vector<std::filesystem::path> sources;
  std::optional<std::filesystem::path> imagery;  ///< a georeferenced image, or a folder of them
  /// A list of where objects stand (trimtab/host/placement_list.h), which names the files of their models
  /// relative to its own folder. Rows and models that cannot be used are left out, with warnings.
  std::optional<std::filesystem::path> objects;
  /// Reads the file of a model; `objects` needs it, and so does what sources bring. app/models has one.
  std::function<Result<SourceModel>(const std::filesystem::path&)> readModel;
  bool ownObjects = true;  ///< what sources bring stands on the ground: features of a CDB, objects of scenery
  /// FlightGear's base package, whose models scenery shares (trimtab/terrain/scenery/objects.h).
  std::optional<std::filesystem::path> sceneryModels;
  Reading reading;                        ///< how elevation files are read
  std::uint32_t trianglesPerNode = 2000;  ///< of the static LOD, if a source is scenery
  bool keepLines = false;    ///< the static LOD keeps roads, streams and shorelines while they cover a pixel
  bool keepTexture = false;  ///< the static LOD keeps the scenery's texture coordinates
  std::optional<Metres>
      post;  ///< post spacing; if unset, the finest file's, or one that suits the scenery's size
  /// Largest vertical error of the finest patches at the posts; 0 keeps every post exact. If unset,
  /// defaultLeafToleranceM applies (trimtab/terrain/patches/build.h).
  std::optional<Metres> maxError;
  /// Most memory that baking may use. Tiles or static LOD that would need more are left out, with a finding;
  /// such a database is drawn from patches.
  Megabytes memory{1024};
  std::filesystem::path output;
  Progress progress;
};
/// Returns notes of what each CDB among the sources holds, of what stands on each scenery if that is wanted,
/// and of what is not drawn of it. Reads tables and lists.
Findings aboutSources(const BakeOptions& options);

/// Bakes the sources and opens the database. The bake works in a folder beside `output` (".NAME.work") and
/// renames its result to `output` when it is complete. If a bake is interrupted, the folder stays: the same
/// sources and options continue from it and yield the same bytes, others begin anew. Only one bake of an
/// output may run at a time; a second one is refused and names the process that runs.
Result<std::shared_ptr<const Database>> bake(const BakeOptions& options);

inline constexpr std::uint32_t kMostBakeParts = 4096;
/// Bakes one of `parts` shares (`part` counts from 1, `parts` is at most kMostBakeParts). Several processes,
/// or machines that share the output's folder, may each bake a share at the same time; their memory, progress
/// and `parts` may differ. Call bakeJoin when all shares are done.
Result<Done> bakePart(const BakeOptions& options, std::uint32_t part, std::uint32_t parts);
/// Joins the shares to a database, the same bytes as bake(). Returns null, with a note of what is missing,
/// while shares are missing or processes are at work on them.
Result<std::shared_ptr<const Database>> bakeJoin(const BakeOptions& options);

}  // namespace trimtab::terrain
