#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/progress.h"
#include "work.h"

namespace trimtab::terrain {

/// File of the work folder: one bit per post, set where a void was filled.
inline constexpr const char* kVoidsName = "voids.bits";

/// File of the work folder: the source of each post, u16 row by row; none if the sources have no names.
inline constexpr const char* kPostSourcesName = "sources.u16";

/// Holds what a bake knows about its heights once they are in their file.
struct BakedHeights {
  PostGrid posts;
  float lowest = 0, highest = 0;
  std::uint64_t voids = 0, outside = 0;  ///< posts filled; `outside`: those of them that no source reaches
  std::uint64_t sum = 0;                 ///< checksum of heights.sums
  std::vector<std::uint64_t> given;      ///< ElevationSource::given over all rows, also those of earlier runs
};

/// Writes the source's heights, with voids filled, to heights.f32 and heights.sums in the work folder's
/// database. Works in bands that fit `memory` bytes, and continues where an earlier bake was interrupted.
Result<BakedHeights> bakeHeights(const WorkFolder& work, ElevationSource& source, std::size_t memory,
                                 const Progress& progress);

/// Writes the sources of all posts as runs to the work folder's database, once the heights are baked. Returns
/// none, and writes nothing, if the sources have no names.
Result<std::optional<FileEntry>> bakeSources(const WorkFolder& work, const PostGrid& posts,
                                             const std::vector<std::string>& names);

/// Describes finished work that was made for a different grid: which grid, and which parts. It is empty if
/// none is.
std::string workForOtherPosts(const WorkFolder& work, const PostGrid& posts);
/// Describes a grid's size, place and post spacing in words.
std::string inWords(const PostGrid& posts);

/// Makes an elevation source of a grid in memory, which must outlive it.
std::unique_ptr<ElevationSource> sourceOf(const HeightGrid& grid);

/// Reads windows of the baked heights with pread. The file is not mapped, so that its pages do not count as
/// memory of this process.
class FileHeights final : public HeightSource {
 public:
  static Result<std::unique_ptr<FileHeights>> open(const WorkFolder& work, const BakedHeights& heights);
  ~FileHeights() override;
  FileHeights(const FileHeights&) = delete;
  FileHeights& operator=(const FileHeights&) = delete;

  const PostGrid& posts() const override { return posts_; }
  void read(const PostWindow& window, std::uint32_t stride, std::span<float> heights) const override;
  void readVoids(const PostWindow& window, std::uint32_t stride,
                 std::span<std::uint8_t> voids) const override;
  bool failed() const override { return failed_; }

 private:
  FileHeights(const PostGrid& posts, int heights, int voids) : posts_(posts), file_(heights), voids_(voids) {}
  PostGrid posts_;
  int file_, voids_;  ///< descriptors; `voids_` is negative if there were no voids
  mutable std::atomic<bool> failed_{false};
};

}  // namespace trimtab::terrain
