#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "trimtab/terrain/format/patch_layout.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/patches/build.h"
#include "work.h"

namespace trimtab::terrain {

/// The pages of a grid's patches, made in pieces: runs of pages about equally much work, less towards the
/// end, the coarsest and longest first. A piece is a file of its own, whole or not there, and the same
/// whoever makes it.
class PatchBake {
 public:
  /// `mostFine` as leafCellsOf takes it.
  PatchBake(const WorkFolder& work, const PostGrid& posts, const PostGeometry& geometry, double leafM,
            std::uint64_t mostFine = kMostFineSquares);

  std::uint32_t pieces() const { return static_cast<std::uint32_t>(firstPage_.size() - 1); }
  /// Those that are there.
  std::vector<std::uint8_t> finished() const;
  /// Makes what is missing of every `parts`-th piece from `part` (counted from 0), on as many threads as
  /// `memory` bytes allow.
  Result<Done> make(const HeightSource& heights, std::uint32_t part, std::uint32_t parts, std::size_t memory,
                    const Progress& progress) const;
  /// Puts all of them into one file.
  Result<Done> join(const std::filesystem::path& file, const Progress& progress);

 private:
  std::filesystem::path pieceFile(std::uint32_t piece) const;
  Result<Done> makePiece(const HeightSource& heights, std::uint32_t piece,
                         const std::function<bool()>& carryOn) const;

  const WorkFolder& work_;
  const PostGrid& posts_;
  const PostGeometry& geometry_;
  PatchIndex index_;
  std::vector<double> tolerances_;
  std::vector<std::uint32_t> firstPage_;  ///< of each piece; the last is their number
};

}  // namespace trimtab::terrain
