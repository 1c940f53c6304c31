#pragma once

#include <filesystem>
#include <string>

/// Tells files and folders in the making, which have names of their own until they are complete, from those
/// that a killed program left.
namespace trimtab {

/// Locks an unfinished file or folder for as long as this object lives. Where a file system has no locks, it
/// does nothing, and clearUnfinished() removes nothing there.
class UnfinishedLock {
 public:
  explicit UnfinishedLock(const std::filesystem::path& unfinished);
  ~UnfinishedLock();
  UnfinishedLock(const UnfinishedLock&) = delete;
  UnfinishedLock& operator=(const UnfinishedLock&) = delete;

 private:
  int handle_;
};

/// Returns `.NAME.part-` beside the target: the beginning of the names of its unfinished files.
std::filesystem::path partPrefix(const std::filesystem::path& target);
/// Removes what killed programs left of a target: files and folders whose names begin with partPrefix()
/// and that nobody has locked. Call it before a new one is made.
void clearUnfinished(const std::filesystem::path& target);

}  // namespace trimtab
