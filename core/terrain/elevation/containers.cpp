#include "containers.h"

#include <algorithm>
#include <optional>

#include "evidence.h"
#include "trimtab/terrain/elevation/georeference.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostListed = 24;
/// The one that is taken has so many points more than the next.
constexpr int kClear = 2;

/// What follows the file in GDAL's name for a raster in it, or, if nothing follows, what stands before.
std::string nameIn(const std::string& gdalName, const fs::path& file) {
  const std::size_t at = gdalName.find(file.string());
  if (at == std::string::npos) return gdalName;
  const auto bare = [](std::string text) {
    text.erase(0, std::min(text.find_first_not_of("\":/"), text.size()));
    text.erase(text.find_last_not_of("\":") + 1);
    return text;
  };
  const std::string after = bare(gdalName.substr(at + file.string().size()));
  return after.empty() ? bare(gdalName.substr(0, at)) : after;
}

/// Parts of a `FILE:NAME`; none where the path is something else.
std::optional<std::pair<fs::path, std::string>> parts(const fs::path& path) {
  std::error_code error;
  const std::string& text = path.native();
  if (text.find(':') == std::string::npos || fs::exists(path, error)) return {};
  for (std::size_t at = text.find(':'); at != std::string::npos; at = text.find(':', at + 1))
    if (fs::is_regular_file(text.substr(0, at), error))
      return std::pair{fs::path(text.substr(0, at)), text.substr(at + 1)};
  return {};
}

std::string listed(const fs::path& file, const std::vector<ContainedRaster>& rasters) {
  std::string text;
  for (std::size_t k = 0; k < std::min(rasters.size(), kMostListed); ++k)
    text += (k == 0 ? "" : "; ") + file.string() + ':' + rasters[k].name + " (" + rasters[k].about + ')';
  if (rasters.size() > kMostListed) text += "; " + std::to_string(rasters.size() - kMostListed) + " more";
  return text;
}

}  // namespace

std::vector<ContainedRaster> rastersIn(GDALDataset& data, const fs::path& file) {
  std::vector<ContainedRaster> rasters;
  char** const items = data.GetMetadata("SUBDATASETS");
  if (data.GetRasterCount() > 0 || items == nullptr) return rasters;
  for (int k = 1;; ++k) {
    const std::string key = "SUBDATASET_" + std::to_string(k);
    const char* const name = CSLFetchNameValue(items, (key + "_NAME").c_str());
    const char* const about = CSLFetchNameValue(items, (key + "_DESC").c_str());
    if (name == nullptr) return rasters;
    rasters.push_back({nameIn(name, file), name, about ? about : ""});
  }
}

fs::path containerOf(const fs::path& path) {
  const auto both = parts(path);
  return both ? both->first : path;
}

Result<std::string> gdalNameOf(const fs::path& path) {
  const auto both = parts(path);
  if (!both) return path.string();
  useGdal();
  const GdalErrors errors;
  const Dataset data = owned(GDALDataset::Open(both->first.c_str(), GDAL_OF_RASTER));
  if (!data)
    return about(Severity::error, both->first, "", "a file with several rasters",
                 errors.last("one that GDAL cannot open"));
  const auto rasters = rastersIn(*data, both->first);
  for (const ContainedRaster& raster : rasters)
    if (raster.name == both->second) return raster.gdalName;
  return about(Severity::error, path, "", "one of " + listed(both->first, rasters),
               rasters.empty() ? "a file that is one raster: name it without \":" + both->second + '"'
                               : "no \"" + both->second + "\" in it");
}

Result<fs::path> elevationIn(const fs::path& file, const std::vector<ContainedRaster>& rasters) {
  std::optional<std::size_t> best;
  int most = 0, next = Evidence::kOther;
  for (std::size_t k = 0; k < rasters.size(); ++k) {
    const GdalErrors quiet;
    const Dataset data = owned(GDALDataset::Open(rasters[k].gdalName.c_str(), GDAL_OF_RASTER));
    if (!data || imageIn(*data)) continue;
    const int points = declaredBy(*data, rasters[k].name).score();
    if (!best || points > most) {
      if (best) next = most;
      best = k, most = points;
    } else {
      next = std::max(next, points);
    }
  }
  const std::string list = listed(file, rasters);
  if (!best)
    return about(Severity::error, file, "", "a raster of heights among those in the file",
                 "images and maps alone: " + list);
  if (rasters.size() > 1 && (most <= 0 || most < next + kClear))
    return about(Severity::error, file, "", "the name of the raster that is elevation, as FILE:NAME",
                 std::to_string(rasters.size()) + " rasters, none of which stands out: " + list);
  const fs::path chosen = file.string() + ':' + rasters[*best].name;
  return {chosen,
          {about(Severity::note, file, "", "one raster",
                 "several, of which " + rasters[*best].name + " is taken for elevation: " + list)}};
}

}  // namespace trimtab::terrain
