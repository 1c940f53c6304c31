#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "trimtab/units/result.h"

namespace trimtab::terrain {

/// A lock on a file. The system releases it when the process ends.
class FileLock {
 public:
  /// Returns null if the lock is unavailable; errno has the reason: EWOULDBLOCK if another process holds it,
  /// or held it and removed the file meanwhile. The file names its holders, one line per process.
  static std::unique_ptr<FileLock> tryLock(const std::filesystem::path& file, bool shared);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  explicit FileLock(int handle) : handle_(handle) {}
  int handle_;
};

/// The folder of an unfinished bake: ".NAME.work" beside the output. Files of other names in it are not its
/// own, and stay when it is emptied or removed.
///
///   trimtab.mark      says that the folder is a bake's
///   recipe.json       the stamped recipe; another recipe empties the folder
///   journal           one line with a checksum per finished step
///   voids.bits        one bit per post, set where a void was filled
///   sources.u16       the number of the source of each post
///   pieces/N.pages    finished pages of patches
///   database/         what becomes the output; heights.f32 is made in place
class WorkFolder {
 public:
  /// `alone`: no other process may use the folder. `join`: the same, to join finished parts. `part`: other
  /// processes may bake parts at the same time.
  enum class Use { alone, join, part };
  /// Opens or makes the folder. Returns null, with a note, if `join` finds no parts or finds them at work.
  /// Removes work of another recipe, except for `join`, which is then refused.
  /// Refuses a folder of this name that no bake has marked, unless it is empty, and an output that is a mount
  /// point, because a folder cannot be renamed onto it. The findings of success name what is not its own.
  static Result<std::unique_ptr<WorkFolder>> open(const std::filesystem::path& output,
                                                  const std::string& recipe, Use use);
  /// Removes the folder if no step has finished.
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path database() const { return path_ / "database"; }
  std::filesystem::path pieces() const { return path_ / "pieces"; }
  bool resumed() const { return resumed_; }

  /// Returns a note of how much finished work there is, and how to go on.
  Finding kept() const;
  /// Removes all work. The caller must have opened the folder for `alone` or `join`.
  Result<Done> beginAnew();

  /// Removes from database/ what an interrupted end left there: all but the heights. The findings of success
  /// name what is not a database's.
  Result<Done> clearDatabase() const;

  /// Returns the journal's lines whose checksums are right.
  std::vector<std::string> journal() const;
  Result<Done> note(const std::string& line) const;

  /// Renames database/ to `output`, replacing a database or an empty folder there, and removes the work
  /// folder. If that fails, both stay as they were and the next bake continues from here. The findings of
  /// success name what is not its own and stays in the work folder.
  Result<Done> finish(const std::filesystem::path& output);

 private:
  WorkFolder(std::filesystem::path path, std::unique_ptr<FileLock> lock, bool resumed)
      : path_(std::move(path)), lock_(std::move(lock)), resumed_(resumed) {}
  std::filesystem::path path_;
  std::unique_ptr<FileLock> lock_;
  bool resumed_ = false;
};

}  // namespace trimtab::terrain
