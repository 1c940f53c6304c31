#include "trimtab/terrain/elevation/files.h"

#include <algorithm>
#include <set>
#include <string>

#include "containers.h"
#include "evidence.h"
#include "file_kind.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/stop_request.h"
#include "trimtab/terrain/cdb/catalogue.h"
#include "trimtab/terrain/elevation/georeference.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

/// So many files of a folder that are no rasters are named.
constexpr std::size_t kMostOthers = 12;

/// What was found in a folder.
struct Contents {
  std::vector<fs::path> rasters;
  std::vector<Finding> left;
  std::vector<fs::path> others;  ///< that are no rasters, and have no name of one
  std::set<fs::path> parts;      ///< of rasters: headers, world files, statistics
};

Finding leftOut(Severity severity, const fs::path& file, const std::string& what) {
  return about(severity, file, "", "elevation", what + "; left out");
}

/// GDAL's own side files belong to the raster beside them.
bool isSideFile(const fs::path& file) {
  const std::string name = file.filename().string();
  return file.extension() == ".ovr" || file.extension() == ".msk" || name.ends_with(".aux.xml");
}

void sortIn(const fs::path& file, Contents& contents) {
  GdalErrors errors;
  const bool known = GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER, nullptr, nullptr) != nullptr;
  if (!known && !isRasterName(file)) {
    contents.others.push_back(file);
    return;
  }
  const Dataset data = owned(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_VERBOSE_ERROR));
  if (!data) {
    contents.left.push_back(leftOut(Severity::warning, file, whatItIs(file, errors)));
    return;
  }
  char** const names = data->GetFileList();
  for (char** name = names; name != nullptr && *name != nullptr; ++name)
    if (file != *name) contents.parts.insert(*name);
  CSLDestroy(names);
  if (const auto rasters = rastersIn(*data, file); !rasters.empty()) {
    auto chosen = elevationIn(file, rasters);
    if (chosen) {
      contents.rasters.push_back(*chosen);
      contents.left.insert(contents.left.end(), chosen.findings().begin(), chosen.findings().end());
    } else {
      for (Finding finding : chosen.findings()) {
        finding.severity = Severity::warning, finding.found += "; left out";
        contents.left.push_back(std::move(finding));
      }
    }
    return;
  }
  if (const auto image = imageIn(*data))
    contents.left.push_back(leftOut(Severity::note, file, *image));
  else
    contents.rasters.push_back(file);
}

/// Names files that nobody takes for rasters, all in one note.
void nameOthers(const fs::path& folder, const Contents& contents, Findings& findings) {
  std::string names;
  std::size_t count = 0;
  for (const fs::path& file : contents.others) {
    if (contents.parts.contains(file)) continue;
    if (++count <= kMostOthers)
      names += (count == 1 ? "" : "; ") + fs::relative(file, folder).string() + " (" + kindOf(file) + ')';
  }
  if (count > kMostOthers) names += "; " + std::to_string(count - kMostOthers) + " more";
  if (count > 0)
    findings.push_back(about(Severity::note, folder, "", "elevation",
                             std::to_string(count) + " files that are no rasters, left out: " + names));
}

/// A virtual raster's parts are rasters themselves; everything else that belongs to one is left unsaid.
void findIn(const fs::path& folder, std::vector<ElevationPath>& files, Findings& findings) {
  std::set<fs::path> inside;
  const auto visited = visitFiles(folder, [&](const fs::path& file) { return inside.insert(file).second; });
  findings.insert(findings.end(), visited.findings().begin(), visited.findings().end());
  if (!visited) return;
  Contents contents;
  for (const fs::path& file : inside) {
    if (stopRequested()) return;
    if (!isSideFile(file)) sortIn(file, contents);
  }
  for (const Finding& finding : contents.left)
    if (!contents.parts.contains(finding.where)) findings.push_back(finding);
  nameOthers(folder, contents, findings);
  for (fs::path& file : contents.rasters) files.push_back({std::move(file), false});
  if (contents.rasters.empty())
    findings.push_back(about(Severity::error, folder, "", "elevation files that GDAL knows",
                             "none of " + std::to_string(inside.size()) + " files"));
}

/// The tiles of a CDB: its folders say which are elevation.
void takeCdb(const fs::path& folder, std::vector<ElevationPath>& files, Findings& findings) {
  const auto cdb = openCdb(folder);
  findings.insert(findings.end(), cdb.findings().begin(), cdb.findings().end());
  if (!cdb) return;
  const auto tiles = cdbRasters(*cdb, CdbSet::kElevation);
  findings.insert(findings.end(), tiles.findings().begin(), tiles.findings().end());
  if (!tiles) return;
  for (const fs::path& tile : *tiles) files.push_back({tile, false, false});
}

/// A file that the user named. A container gives its elevation.
void take(const fs::path& file, std::vector<ElevationPath>& files, Findings& findings) {
  const GdalErrors quiet;
  if (!neverEnds(file))
    if (const Dataset data = owned(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER)))
      if (const auto rasters = rastersIn(*data, file); !rasters.empty()) {
        const auto chosen = elevationIn(file, rasters);
        findings.insert(findings.end(), chosen.findings().begin(), chosen.findings().end());
        if (chosen) files.push_back({*chosen, true});
        return;
      }
  files.push_back({file, true});
}

}  // namespace

Result<std::vector<ElevationPath>> elevationPaths(std::span<const fs::path> sources) {
  useGdal();
  Findings findings;
  std::vector<ElevationPath> files;
  for (const fs::path& source : sources) {
    std::error_code error;
    const fs::file_status status = fs::status(source, error);
    if (fs::is_directory(status) && isCdb(source))
      takeCdb(source, files, findings);
    else if (fs::is_directory(status))
      findIn(source, files, findings);
    else if (fs::exists(status))
      take(source, files, findings);
    else if (containerOf(source) != source)
      files.push_back({source, true});
    else
      findings.push_back(about(Severity::error, source, "", "a file or folder", "nothing there"));
  }
  if (hasError(findings)) return findings;
  return {std::move(files), std::move(findings)};
}

Result<std::vector<fs::path>> elevationFiles(std::span<const fs::path> sources) {
  const auto paths = elevationPaths(sources);
  if (!paths) return paths.findings();
  std::vector<fs::path> files;
  for (const ElevationPath& path : *paths) files.push_back(path.file);
  return {std::move(files), paths.findings()};
}

}  // namespace trimtab::terrain
