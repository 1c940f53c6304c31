#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "trimtab/terrain/format/database.h"

namespace trimtab::scene {

/// A scene of OpenSceneGraph in its own files (paged .ive, .osgb, .osgt or .txp), opened as it is in the
/// place of a baked database. It has no nodes of ours: the renderer draws it with OSG's own cull, draw and
/// paging. Heights come from its finest triangles; the first question about a place reads their files.
class OsgDatabase : public terrain::Database {
 public:
  /// Opens a scene. If its root has an ellipsoid (osg::CoordinateSystemNode), coordinates are geocentric, WGS
  /// 84, metres. Else they are metres east, north and up of `origin`, on the plane that touches the earth
  /// there, and without an origin the file is refused. Page files that cannot be read are findings later,
  /// in damage().
  static Result<std::shared_ptr<const terrain::Database>> open(const std::filesystem::path& file,
                                                               const std::optional<GeodeticPosition>& origin);

  virtual const std::filesystem::path& file() const = 0;
  /// Tells whether scene coordinates are geocentric; else they are those of index().frame.
  virtual bool geocentric() const = 0;
};

/// Tells by its name, and of a .flt by its first bytes, whether a file is a scene of OpenSceneGraph.
bool isOsgScene(const std::filesystem::path& file);

/// Reads "LAT,LON", degrees, as the origin of a scene with flat coordinates.
Result<GeodeticPosition> originFrom(const std::string& text);

/// Opens a scene with what the option --origin says; empty: nothing.
Result<std::shared_ptr<const terrain::Database>> openOsgScene(const std::filesystem::path& file,
                                                              const std::string& origin);
/// Tells whether a scene was refused because its coordinates are flat and nobody said where they are 0.
bool lacksOrigin(const Findings& findings);
inline constexpr const char* kOriginHelp =
    "LAT,LON where coordinates of a flat OpenSceneGraph scene are 0; they are metres east, north and up";

}  // namespace trimtab::scene
