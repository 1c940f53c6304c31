#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/grid/measure_levels.h"
#include "trimtab/terrain/grid/post_geometry.h"
#include "trimtab/terrain/grid/progress.h"
#include "work.h"

namespace trimtab::terrain {

/// Makes the files of tiles of a bake whose heights are in their file.
class TileBake {
 public:
  /// `work` and `geometry` must outlive this object.
  TileBake(const WorkFolder& work, const PostGrid& posts, const PostGeometry& geometry)
      : work_(work), posts_(posts), geometry_(geometry) {}

  /// Measures all levels, unless that is done or the grid has no tiles.
  Result<Done> measure(const Progress& progress);
  /// Writes nodes, slopes and cones, and forgets what was measured.
  Result<std::vector<FileEntry>> write();
  /// Writes a colour per post, RGBA, and the sums of its rows.
  Result<std::vector<FileEntry>> writeImage(std::span<const std::uint8_t> image) const;

 private:
  const WorkFolder& work_;
  PostGrid posts_;
  const PostGeometry& geometry_;
  std::optional<std::pair<TerrainIndex, CellSlopes>> levels_;  ///< once they are measured
};

}  // namespace trimtab::terrain
