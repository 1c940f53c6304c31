#include "trimtab/terrain/bake/cache.h"

#include <cstdlib>

namespace trimtab::terrain {

std::filesystem::path cacheFolder() {
  // The XDG base directory specification has relative paths ignored.
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && *cache == '/') return std::filesystem::path(cache) / "trimtab" / "terrain";
  const char* home = std::getenv("HOME");
  if (home && *home) return std::filesystem::path(home) / ".cache" / "trimtab" / "terrain";
  return std::filesystem::temp_directory_path() / "trimtab" / "terrain";
}

}  // namespace trimtab::terrain
