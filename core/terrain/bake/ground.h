#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/ground/build.h"
#include "work.h"

namespace trimtab::terrain {

/// Makes the ground pyramid of a bake in shares. Each share is a file that is either complete or absent.
class GroundBake {
 public:
  /// `work`, and what `sources` points to, must outlive this object.
  GroundBake(const WorkFolder& work, GroundSources sources) : work_(work), sources_(std::move(sources)) {}

  /// Makes a share (`part` counts from 0) unless it exists, and notes in the journal how many of its texels
  /// each image covers.
  Result<Done> make(std::uint32_t part, std::uint32_t parts, const Progress& progress) const;
  /// Returns the smallest number of shares for which every share exists; 0 if there is none.
  std::uint32_t parts() const;
  /// Joins `parts` shares to one file. Findings report images that leave ground uncovered.
  Result<Done> join(std::uint32_t parts, const std::filesystem::path& file, const Progress& progress) const;

 private:
  std::filesystem::path shareFile(std::uint32_t part, std::uint32_t parts) const;
  /// Reads the covers of all shares from the journal; the key is the name of the share's file.
  std::map<std::string, GroundCover> covers() const;

  const WorkFolder& work_;
  GroundSources sources_;
};

}  // namespace trimtab::terrain
