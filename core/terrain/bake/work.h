#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// A lock on a file that ends with the process.
class FileLock {
 public:
  /// Null where it is not to be had, with the reason in errno: EWOULDBLOCK where another process has it (or
  /// had, and removed it meanwhile). The file says who does, for people: a line a process.
  static std::unique_ptr<FileLock> tryLock(const std::filesystem::path& file, bool shared);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  explicit FileLock(int handle) : handle_(handle) {}
  int handle_;
};

/// Where an unfinished bake keeps what it has: ".NAME.work" beside the output.
///
///   recipe.json       what is baked; another recipe empties the folder
///   journal           a checked line a finished step
///   voids.bits        posts that were filled, a bit each
///   pieces/N.pages    finished pages of patches
///   database/         what becomes the output; heights.f32 is made in place
class WorkFolder {
 public:
  /// Alone, alone to put together what is there, or beside others that work on parts of the same.
  enum class Use { alone, join, part };
  /// Work of another recipe goes, but not when it is to be joined. Refuses an output that is a mount point.
  static Result<std::unique_ptr<WorkFolder>> open(const std::filesystem::path& output,
                                                  const std::string& recipe, Use use);
  /// Goes where nothing is done yet.
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path database() const { return path_ / "database"; }
  std::filesystem::path pieces() const { return path_ / "pieces"; }
  bool resumed() const { return resumed_; }

  /// All work goes; for who has it alone.
  Result<Done> beginAnew();

  /// The journal's lines, as far as they are whole.
  std::vector<std::string> journal() const;
  Result<Done> note(const std::string& line) const;

  /// database/ takes the output's place, and the rest goes. What was there before, a database or an empty
  /// folder, goes too. Where that fails both are as they were, and the next bake goes on from here.
  Result<Done> finish(const std::filesystem::path& output);

 private:
  WorkFolder(std::filesystem::path path, std::unique_ptr<FileLock> lock, bool resumed)
      : path_(std::move(path)), lock_(std::move(lock)), resumed_(resumed) {}
  std::filesystem::path path_;
  std::unique_ptr<FileLock> lock_;
  bool resumed_ = false;
};

}  // namespace trimtab::terrain
