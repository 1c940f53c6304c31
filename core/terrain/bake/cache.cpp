#include <unistd.h>

#include <algorithm>

#include "source.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/elevation/files.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

Result<std::shared_ptr<const Database>> openOrBake(const fs::path& source, const fs::path& cacheFolder,
                                                   const Progress& progress, std::uint32_t trianglesPerNode) {
  if (isDatabase(source)) return Database::open(source);
  const std::vector<fs::path> sources{source};
  const bool scenery = isScenery(source);
  const auto files = scenery ? sceneryFiles(source) : elevationFiles(sources);
  if (!files) return files.findings();
  std::string key = "v" + std::to_string(kFormatVersion) + " b" + std::to_string(kBuilderVersion);
  if (scenery) key += " n" + std::to_string(trianglesPerNode);
  for (const std::string& stamp : stampsOf(*files)) key += '\n' + stamp;
  const std::string name = nameOf(source);
  const fs::path cached = cacheFolder / (name + "-" + hexadecimal(checksum(key)));
  if (isDatabase(cached)) {
    // A damaged copy is made again.
    if (auto database = Database::open(cached)) return database;
  }
  BakeOptions options;
  options.sources = sources;
  options.output = cached;
  options.trianglesPerNode = trianglesPerNode;
  options.progress = progress;
  // Nobody named a bound: scenery, whose trees are made in memory, may have half of the machine.
  if (scenery)
    options.memory =
        Megabytes{std::max(options.memory.value(), 0.5e-6 * static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                                                       static_cast<double>(::sysconf(_SC_PAGESIZE)))};
  return bake(options);
}

}  // namespace trimtab::terrain
