#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// A georeferenced image, read a window at a time. It is thread-safe.
class GroundImage {
 public:
  /// Opens an image. Findings include notes about what was assumed.
  static Result<std::unique_ptr<GroundImage>> open(const std::filesystem::path& file);
  virtual ~GroundImage() = default;

  /// Returns the distance of pixels in the middle of the image, degrees of latitude.
  virtual double stepDegrees() const = 0;
  /// Tells whether the image may cover any of these posts.
  virtual bool touches(const PostGrid& posts) const = 0;
  /// Returns RGBA per post, rows from south; alpha is 0 where the image has no colour. Longitudes of posts
  /// may exceed 180 degrees.
  virtual Result<std::vector<std::uint8_t>> read(const PostGrid& posts) const = 0;
};

}  // namespace trimtab::terrain
