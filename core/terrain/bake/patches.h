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

/// Makes the pages of a grid's patches in pieces. A piece is a run of pages; pieces need about the same work,
/// less towards the end, and the coarsest and longest come first so that threads finish together. Each piece
/// is a file that is either complete or absent, and its bytes do not depend on who makes it.
class PatchBake {
 public:
  /// `leafM`: largest vertical error of the finest patches, metres. `mostFine`: see leafCellsOf. `work`,
  /// `posts` and `geometry` must outlive this object.
  PatchBake(const WorkFolder& work, const PostGrid& posts, const PostGeometry& geometry, double leafM,
            std::uint64_t mostFine = kMostFineSquares);

  std::uint32_t pieces() const { return static_cast<std::uint32_t>(firstPage_.size() - 1); }
  /// Returns one flag per piece: 1 if its file exists.
  std::vector<std::uint8_t> finished() const;
  /// Makes the missing pieces among `part`, `part` + `parts`, ... (`part` counts from 0), on as many threads
  /// as `memory` bytes allow.
  Result<Done> make(const HeightSource& heights, std::uint32_t part, std::uint32_t parts, std::size_t memory,
                    const Progress& progress) const;
  /// Joins all pieces to one file.
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
  std::vector<std::uint32_t> firstPage_;  ///< one per piece, then the number of pages
};

}  // namespace trimtab::terrain
