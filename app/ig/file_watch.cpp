#include "file_watch.h"

namespace trimtab::ig {

std::optional<FileWatch::Stamp> FileWatch::stampOf(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return std::nullopt;
  return Stamp{status.st_ino, status.st_size, status.st_mtim};
}

bool FileWatch::changed() {
  const std::optional<Stamp> stamp = stampOf(file_);
  if (!stamp) return false;
  if (seen_ && stamp->inode == seen_->inode && stamp->size == seen_->size &&
      stamp->time.tv_sec == seen_->time.tv_sec && stamp->time.tv_nsec == seen_->time.tv_nsec)
    return false;
  seen_ = stamp;
  return true;
}

}  // namespace trimtab::ig
