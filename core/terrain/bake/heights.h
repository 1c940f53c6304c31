#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/grid/height_window.h"
#include "trimtab/terrain/grid/progress.h"
#include "work.h"

namespace trimtab::terrain {

/// Of the work folder, a bit a post.
inline constexpr const char* kVoidsName = "voids.bits";

/// What is known of the heights of a bake once they are in their file.
struct BakedHeights {
  PostGrid posts;
  float lowest = 0, highest = 0;
  std::uint64_t voids = 0, outside = 0;  ///< filled; the second where no file reaches
  std::uint64_t sum = 0;                 ///< of heights.sums
  std::vector<std::uint64_t> given;      ///< ElevationSource::given of all rows, whoever read them
};

/// Heights of the source, voids filled, to heights.f32 and heights.sums in the work folder's database, in
/// bands that `memory` bytes allow; goes on where an earlier bake was interrupted.
Result<BakedHeights> bakeHeights(const WorkFolder& work, ElevationSource& source, std::size_t memory,
                                 const Progress& progress);

/// Of finished work that was made for other posts: for which, and by which parts. Empty: there is none.
std::string workForOtherPosts(const WorkFolder& work, const PostGrid& posts);
/// A grid's size, place and step, for people.
std::string inWords(const PostGrid& posts);

/// A grid in memory as a source.
std::unique_ptr<ElevationSource> sourceOf(const HeightGrid& grid);

/// Reads windows of the file, and mapping none of it: what was read does not count as this process's memory.
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
  int file_, voids_;  ///< the second negative without voids
  mutable std::atomic<bool> failed_{false};
};

}  // namespace trimtab::terrain
