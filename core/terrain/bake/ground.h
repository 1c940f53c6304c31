#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/ground/build.h"
#include "work.h"

namespace trimtab::terrain {

/// The colours of a bake's ground, made in shares: each a file of its own, whole or not there.
class GroundBake {
 public:
  /// What these point to must outlive it.
  GroundBake(const WorkFolder& work, GroundSources sources) : work_(work), sources_(std::move(sources)) {}

  /// Makes a share (counted from 0), unless it is there. The journal is told what images cover of it.
  Result<Done> make(std::uint32_t part, std::uint32_t parts, const Progress& progress) const;
  /// Of how many shares all are there, the least such number; 0: none.
  std::uint32_t parts() const;
  /// Puts so many shares into one file. Findings tell of the images, whoever made the shares.
  Result<Done> join(std::uint32_t parts, const std::filesystem::path& file, const Progress& progress) const;

 private:
  std::filesystem::path shareFile(std::uint32_t part, std::uint32_t parts) const;
  /// By the names of the shares' files, as the journal has them.
  std::map<std::string, GroundCover> covers() const;

  const WorkFolder& work_;
  GroundSources sources_;
};

}  // namespace trimtab::terrain
