#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// A georeferenced picture, read a window at a time. Safe to use by many threads.
class GroundImage {
 public:
  /// Findings carry notes about what was assumed.
  static Result<std::unique_ptr<GroundImage>> open(const std::filesystem::path& file);
  virtual ~GroundImage() = default;

  /// Degrees of latitude from a pixel to the next, in its middle.
  virtual double stepDegrees() const = 0;
  /// Whether any of it can lie on these posts.
  virtual bool touches(const PostGrid& posts) const = 0;
  /// RGBA a post, rows from south; alpha 0 where the picture has nothing. Posts may lie past 180 degrees.
  virtual Result<std::vector<std::uint8_t>> read(const PostGrid& posts) const = 0;
};

}  // namespace trimtab::terrain
