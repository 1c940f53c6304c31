#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/frame/patch_index.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/post_sources.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/quantity.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// What a database knows about the ground at a place.
struct GroundAt {
  Metres height;  ///< above mean sea level, bilinear between the four nearest posts
  /// How far the surface that is drawn at its finest may be from `height`, at most; none if the database
  /// states no errors.
  std::optional<Metres> error;
  /// The files that the nearest posts with a say have their heights from, the nearest post's first. Empty if
  /// that post was a void that was filled.
  std::vector<std::string> sources;
  bool filled = false;  ///< one of these posts was a void that was filled
};

/// Answers what the ground is at places of a database. Thread-safe.
class HeightQuery {
 public:
  /// Opens the database and its list of sources.
  static Result<HeightQuery> open(const std::filesystem::path& folder);

  const Database& database() const { return *database_; }
  /// Returns none outside the terrain, and where its file is damaged (Database::damage).
  std::optional<GroundAt> at(Degrees latitude, Degrees longitude) const;

 private:
  HeightQuery(std::shared_ptr<const Database> database, std::optional<PostSources> sources);

  std::shared_ptr<const Database> database_;
  std::shared_ptr<const PatchTerrain> patches_;
  std::optional<PostSources> sources_;
  PostGrid posts_;
};

/// Returns the smallest patch under a point of the grid of posts, column and row from 0 to the last post.
std::uint32_t leafPatchAt(const PatchIndex& index, double column, double row);

}  // namespace trimtab::terrain
