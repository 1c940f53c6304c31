#pragma once

#include <filesystem>
#include <string>

#include "trimtab/units/result.h"

namespace trimtab {

/// Every byte of a file of at most 16 MiB. Reads pipes too, folders not.
Result<std::string> readWhole(const std::filesystem::path& file);

/// The bytes of a file, or the names in a folder, are on the disk when this returns.
Result<Done> reachDisk(const std::filesystem::path& fileOrFolder);
/// Gives a finished file its name, on the same file system. Its bytes reach the disk before the name does:
/// after a power cut there is the old file or the new one, never an empty one. Where that fails `unfinished`
/// stays.
Result<Done> putInPlace(const std::filesystem::path& unfinished, const std::filesystem::path& file);

}  // namespace trimtab
