#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <string>

#include "trimtab/scene/renderer.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::ig {

/// Reports each damaged place of the terrain once, when its bytes are first read for an image. The image
/// shows the lowest ground or a coarser form there, which nobody would notice otherwise.
class Damage {
 public:
  Damage(std::shared_ptr<const terrain::Database> database, const scene::Renderer& renderer)
      : database_(std::move(database)), renderer_(renderer) {}
  /// Looks at another terrain from now on.
  void setDatabase(std::shared_ptr<const terrain::Database> database);
  /// Call it after each image with the number of pages that could not be read so far.
  void look(std::uint64_t failedPages);
  /// Returns how many places were reported.
  std::size_t places() const { return before_ + told_.size(); }

 private:
  void tell(const Findings& findings);

  std::shared_ptr<const terrain::Database> database_;
  const scene::Renderer& renderer_;
  std::uint64_t failedPages_ = 0;
  std::size_t before_ = 0;  ///< places of the terrains before this one
  std::set<std::string> told_;
};

}  // namespace trimtab::ig
