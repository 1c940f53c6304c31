#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <new>
#include <string>
#include <string_view>

#include "trimtab/units/result.h"

namespace trimtab {

/// Refuses what no data comes from: devices but /dev/null and the terminal at standard input, and what the
/// kernel shows under /proc and /sys, by whatever name it is reached. Pipes pass, as does what is not there.
Result<Done> checkIsData(const std::filesystem::path& fileOrFolder);

/// Returns every byte of a file, or of a pipe or a terminal that ends: at most `mostBytes`, and at most 64
/// MiB of what is no file. Fails for a folder, for what checkIsData() refuses, if memory runs out, and for a
/// pipe that is open after a second without a byte, after five seconds, or when the program is asked to stop
/// (stop_request.h).
Result<std::string> readWhole(const std::filesystem::path& file,
                              std::size_t mostBytes = std::size_t{16} << 20);
/// A flight, a trace, a head log or a capture may have so many bytes: they are read whole.
inline constexpr std::size_t kLargestRecording = std::size_t{4} << 30;

/// Sees that a file may take this name: nothing has it, or a file that may be written.
Result<Done> canReplace(const std::filesystem::path& file);
/// Calls `visit` for each regular file in a folder and below it, in no order, until it returns false. Enters
/// each folder once, by whatever links it is reached. Warns of folders that may not be entered and of links to
/// nothing. Leaves out what checkIsData() refuses; fails if that is the folder itself, or if the program is
/// asked to stop.
Result<Done> visitFiles(const std::filesystem::path& folder,
                        const std::function<bool(const std::filesystem::path&)>& visit);

/// Says that memory ran out while a file was read.
Finding tooLargeForMemory(const std::filesystem::path& file);
/// Calls a function that reads a file. If memory runs out in it, returns a finding that names the file.
template <class Read>
auto withinMemory(const std::filesystem::path& file, const Read& read) -> decltype(read()) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    return tooLargeForMemory(file);
  }
}

/// Sees that files can be made in a folder, before long work whose result goes there.
Result<Done> canWriteIn(const std::filesystem::path& folder);
/// Does the same for the folder that a file is to be made in.
Result<Done> canMake(const std::filesystem::path& file);
/// Does the same for a folder that is made if there is none.
Result<Done> makeWritable(const std::filesystem::path& folder);

/// Writes a file in a folder that only this program writes to. If it fails, half of the file may be left.
Result<Done> writeOwn(const std::filesystem::path& file, std::string_view bytes);

/// Writes the bytes of a file, or the names in a folder, to the disk before it returns.
Result<Done> reachDisk(const std::filesystem::path& fileOrFolder);
/// Renames a finished file on the same file system. Its bytes reach the disk before the name does, so after a
/// power cut there is the old file or the new one, never an empty one. If it fails, `unfinished` stays.
Result<Done> putInPlace(const std::filesystem::path& unfinished, const std::filesystem::path& file);

/// Makes a write beyond the size that files may have (`ulimit -f`) fail like one on a full disk, instead of
/// ending the program. Call it in the first line of main(). For the first line of main().
void failLargeWrites();

}  // namespace trimtab
