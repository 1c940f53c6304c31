#pragma once

#include <filesystem>

namespace trimtab::session {

/// Where terrain that a program was given as elevation is baked to: $XDG_CACHE_HOME/trimtab/terrain,
/// else ~/.cache/trimtab/terrain, else the same in the folder for temporary files.
std::filesystem::path cacheFolder();

}  // namespace trimtab::session
