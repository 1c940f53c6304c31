#include <unistd.h>

#include <algorithm>
#include <set>

#include "cdb.h"
#include "objects.h"
#include "source.h"
#include "trimtab/host/placement_list.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/cdb/catalogue.h"
#include "trimtab/terrain/elevation/files.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

std::string stampOf(const fs::path& file) {
  std::error_code unknown;
  return file.string() + ' ' + std::to_string(fs::file_size(file, unknown)) + ' ' +
         std::to_string(fs::last_write_time(file, unknown).time_since_epoch().count());
}

/// Returns the stamps of all files in some folders but `list`, a line each.
std::string stampsIn(const std::set<fs::path>& folders, const fs::path& list) {
  std::set<std::string> stamps;
  std::error_code error;
  for (const fs::path& folder : folders)
    for (fs::directory_iterator file(folder, error), end; !error && file != end; file.increment(error)) {
      std::error_code unknown;
      if (!file->is_regular_file(unknown) || file->path() == list) continue;
      stamps.insert(stampOf(file->path()));
    }
  std::string key;
  for (const std::string& stamp : stamps) key += '\n' + stamp;
  return key;
}

/// Returns the checksum of a list of objects, and the stamps of the files in the folders of its models, which
/// hold their textures too.
Result<std::string> keyOf(const fs::path& list) {
  const auto text = readWhole(list, kLargestRecording);
  if (!text) return text.findings();
  const auto read = readPlacementList(*text, list.string());
  if (!read) return read.findings();
  std::set<fs::path> folders;
  for (const std::string& model : read->models) folders.insert((list.parent_path() / model).parent_path());
  return "\nobjects " + hexadecimal(checksum(*text)) + stampsIn(folders, list);
}

/// Returns the folder with everything that a model list (`.xml`) may name: the outermost Models above it.
fs::path modelsAbove(const fs::path& list) {
  fs::path outermost = list.parent_path();
  for (fs::path folder = outermost; folder.has_relative_path(); folder = folder.parent_path())
    if (folder.filename() == "Models") outermost = folder;
  return outermost;
}

/// Returns the stamps of the folders that hold what scenery's lists place, and what model lists name.
std::string keyOfPlaced(const fs::path& scenery) {
  Findings ignored;  // the bake reports them
  std::set<fs::path> folders, lists;
  for (const ModelFile& model : placedOn(scenery, {}, ignored).models) {
    const fs::path file = model.file;
    folders.insert(file.parent_path());
    if (file.extension() == ".xml") lists.insert(modelsAbove(file));
  }
  for (const fs::path& models : lists) {
    folders.insert(models);
    std::error_code error, unknown;
    for (fs::recursive_directory_iterator below(models, error), end; !error && below != end;
         below.increment(error))
      if (below->is_directory(unknown)) folders.insert(below->path());
  }
  return stampsIn(folders, {});
}

}  // namespace

Result<std::shared_ptr<const Database>> openOrBake(const fs::path& source, const fs::path& cacheFolder,
                                                   const Progress& progress, std::uint32_t trianglesPerNode,
                                                   const std::optional<ObjectsToBake>& objects) {
  if (isDatabase(source)) return Database::open(source);
  const std::vector<fs::path> sources{source};
  const bool scenery = isScenery(source);
  const auto files = scenery ? sceneryFiles(source) : elevationFiles(sources);
  if (!files) return files.findings();
  std::string key = "v" + std::to_string(kFormatVersion) + " b" + std::to_string(kBuilderVersion);
  if (scenery) key += " n" + std::to_string(trianglesPerNode);
  for (const std::string& stamp : stampsOf(*files)) key += '\n' + stamp;
  if (isCdb(source))
    for (const std::string& stamp : cdbStamps(source)) key += '\n' + stamp;
  if (scenery && objects) key += keyOfPlaced(source);
  if (objects && !objects->list.empty()) {
    const auto more = keyOf(objects->list);
    if (!more) return more.findings();
    key += *more;
  }
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
  if (objects) {
    if (!objects->list.empty()) options.objects = objects->list;
    options.readModel = objects->readModel;
  }
  // Nobody named a bound: scenery, whose trees are made in memory, may have half of the machine.
  if (scenery)
    options.memory =
        Megabytes{std::max(options.memory.value(), 0.5e-6 * static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                                                       static_cast<double>(::sysconf(_SC_PAGESIZE)))};
  return bake(options);
}

}  // namespace trimtab::terrain
