#include "trimtab/preset/unfinished.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <system_error>

namespace trimtab {

UnfinishedLock::UnfinishedLock(const std::filesystem::path& unfinished)
    : handle_(::open(unfinished.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)) {
  if (handle_ >= 0) static_cast<void>(::flock(handle_, LOCK_EX | LOCK_NB));
}

UnfinishedLock::~UnfinishedLock() {
  if (handle_ >= 0) ::close(handle_);
}

std::filesystem::path partPrefix(const std::filesystem::path& target) {
  const std::filesystem::path named = target.has_filename() ? target : target.parent_path();
  return named.parent_path() / ("." + named.filename().string() + ".part-");
}

void clearUnfinished(const std::filesystem::path& target) {
  const std::filesystem::path beginning = partPrefix(target);
  const std::filesystem::path folder = beginning.has_parent_path() ? beginning.parent_path() : ".";
  std::error_code failed, ignored;
  for (std::filesystem::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    const std::string name = entry->path().filename().string();
    const std::string prefix = beginning.filename().string();
    // Behind it is the process's number, and maybe one of the file.
    if (!name.starts_with(prefix) || name.size() == prefix.size() ||
        name.find_first_not_of("0123456789-", prefix.size()) != std::string::npos)
      continue;
    const int there = ::open(entry->path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (there < 0) continue;
    if (::flock(there, LOCK_EX | LOCK_NB) == 0) std::filesystem::remove_all(entry->path(), ignored);
    ::close(there);
  }
}

}  // namespace trimtab
