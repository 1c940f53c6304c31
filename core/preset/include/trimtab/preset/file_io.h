#pragma once

#include <filesystem>
#include <string>

#include "trimtab/units/result.h"

namespace trimtab {

/// Returns every byte of a file or a pipe, at most 16 MiB. Fails for a folder.
Result<std::string> readWhole(const std::filesystem::path& file);

/// Writes the bytes of a file, or the names in a folder, to the disk before it returns.
Result<Done> reachDisk(const std::filesystem::path& fileOrFolder);
/// Renames a finished file on the same file system. Its bytes reach the disk before the name does, so after a
/// power cut there is the old file or the new one, never an empty one. If it fails, `unfinished` stays.
Result<Done> putInPlace(const std::filesystem::path& unfinished, const std::filesystem::path& file);

}  // namespace trimtab
