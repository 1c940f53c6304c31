#include "cdb.h"

#include <algorithm>
#include <iterator>

#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/cdb/features.h"
#include "trimtab/terrain/ground/imagery.h"
#include "trimtab/terrain/scenery/objects.h"
#include "trimtab/terrain/scenery/scenery.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

bool hasImages(const CdbCatalogue& cdb) {
  return std::any_of(cdb.files.begin(), cdb.files.end(),
                     [](const CdbFile& file) { return file.tile.set == CdbSet::kImagery; });
}

}  // namespace

std::vector<fs::path> cdbsAmong(const std::vector<fs::path>& sources) {
  std::vector<fs::path> cdbs;
  std::copy_if(sources.begin(), sources.end(), std::back_inserter(cdbs), isCdb);
  return cdbs;
}

std::vector<fs::path> imageFiles(const BakeOptions& options) {
  std::vector<fs::path> all;
  const std::vector<fs::path> folders =
      options.imagery ? std::vector{*options.imagery} : cdbsAmong(options.sources);
  for (const fs::path& folder : folders)
    if (const auto images = imageryFiles(folder)) all.insert(all.end(), images->begin(), images->end());
  return all;
}

Result<std::vector<fs::path>> imagesOver(const BakeOptions& options, const PostGrid& posts) {
  if (options.imagery) return imageryOver(*options.imagery, posts);
  std::vector<fs::path> all;
  Findings findings;
  for (const fs::path& folder : cdbsAmong(options.sources)) {
    const auto cdb = openCdb(folder);
    if (!cdb || !hasImages(*cdb)) continue;
    const auto images = imageryOver(folder, posts);
    for (Finding finding : images.findings()) {
      finding.severity = std::min(finding.severity, Severity::warning);
      findings.push_back(std::move(finding));
    }
    if (images) all.insert(all.end(), images->begin(), images->end());
  }
  return Result<std::vector<fs::path>>(std::move(all), std::move(findings));
}

std::vector<std::string> cdbStamps(const fs::path& folder) {
  std::vector<std::string> stamps;
  const auto cdb = openCdb(folder);
  if (!cdb) return stamps;
  for (const fs::path& version : cdb->versions)
    for (const char* const part : {"Tiles", "GTModel", "Metadata"}) {
      std::error_code error;
      if (!fs::is_directory(version / part, error)) continue;
      const auto visited = visitFiles(version / part, [&](const fs::path& file) {
        std::error_code unknown;
        stamps.push_back(file.string() + ' ' + std::to_string(fs::file_size(file, unknown)) + ' ' +
                         std::to_string(fs::last_write_time(file, unknown).time_since_epoch().count()));
        return true;
      });
      if (!visited) return stamps;
    }
  std::sort(stamps.begin(), stamps.end());
  return stamps;
}

Findings aboutSources(const BakeOptions& options) {
  Findings notes;
  for (const fs::path& folder : options.sources) {
    Findings warnings;  // the bake reports them
    if (options.ownObjects && isScenery(folder)) {
      const auto objects = readSceneryObjects(folder, baseFolders(options.sceneryModels), warnings);
      for (Finding& note : aboutSceneryObjects(folder, objects)) notes.push_back(std::move(note));
    }
    if (!isCdb(folder)) continue;
    const auto cdb = openCdb(folder);
    if (!cdb) continue;
    const CdbFeatures features = readCdbFeatures(*cdb, warnings);
    for (Finding& note : aboutCdb(*cdb, features)) notes.push_back(std::move(note));
  }
  return notes;
}

}  // namespace trimtab::terrain
