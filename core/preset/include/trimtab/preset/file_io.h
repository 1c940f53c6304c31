#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "trimtab/units/result.h"

namespace trimtab {

/// Returns every byte of a file, or of a pipe or device that ends: at most `mostBytes`, and at most 64 MiB of
/// what is no file. Fails for a folder, and for a pipe that is open after a second without a byte or after
/// five seconds.
Result<std::string> readWhole(const std::filesystem::path& file,
                              std::size_t mostBytes = std::size_t{16} << 20);
/// What a flight, a trace, a head log or a capture may have: they are read whole.
inline constexpr std::size_t kLargestRecording = std::size_t{4} << 30;

/// Sees that a file may take this name: nothing has it, or a file that may be written.
Result<Done> canReplace(const std::filesystem::path& file);
/// Sees that files can be made in a folder, before long work whose result goes there.
Result<Done> canWriteIn(const std::filesystem::path& folder);
/// The same for the folder that a file is to be made in.
Result<Done> canMake(const std::filesystem::path& file);
/// The same for a folder that is made where there is none.
Result<Done> makeWritable(const std::filesystem::path& folder);

/// Writes a file in a folder that only this program writes to. If it fails, half of the file may be left.
Result<Done> writeOwn(const std::filesystem::path& file, std::string_view bytes);

/// Writes the bytes of a file, or the names in a folder, to the disk before it returns.
Result<Done> reachDisk(const std::filesystem::path& fileOrFolder);
/// Renames a finished file on the same file system. Its bytes reach the disk before the name does, so after a
/// power cut there is the old file or the new one, never an empty one. If it fails, `unfinished` stays.
Result<Done> putInPlace(const std::filesystem::path& unfinished, const std::filesystem::path& file);

/// Has a write beyond the size that files may have (`ulimit -f`) fail like one on a full disk, instead of
/// ending the program. For the first line of main().
void failLargeWrites();

}  // namespace trimtab
