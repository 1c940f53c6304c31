#pragma once

#include <filesystem>

/// Makes chosen calls of the C library fail, for a program that links faults.cpp: its functions take the
/// place of the library's. Only calls on files below the watched folder count, or on sockets, each once, in
/// the order in which they come.
namespace trimtab::test::faults {

enum class Way {
  no_space,       ///< ENOSPC
  io_error,       ///< EIO
  no_permission,  ///< EACCES
  interrupted,    ///< EINTR
  short_count,    ///< half of the bytes
  killed          ///< the call is done, and the process ends by SIGKILL
};
inline constexpr Way kWays[] = {Way::no_space,    Way::io_error,    Way::no_permission,
                                Way::interrupted, Way::short_count, Way::killed};
const char* nameOf(Way way);

/// Whether the file system has files without a name (O_TMPFILE); some have none.
void haveUnnamedFiles(bool have);
/// From now on calls on this folder and what is in it are counted.
void watch(const std::filesystem::path& folder);
/// In place of a folder: from now on calls on sockets are counted, and waits for them.
inline constexpr const char* kSockets = "socket:";
/// Calls are no longer counted.
void stop();
/// Disturbs the call of this number, counted from 0 at watch(). A way that the call cannot fail in changes
/// nothing.
void disturb(long call, Way way);
/// Returns how many calls there were.
long calls();
/// Reports whether the call was disturbed.
bool happened();

}  // namespace trimtab::test::faults
