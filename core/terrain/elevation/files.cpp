#include "trimtab/terrain/elevation/files.h"

#include <set>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/stop_request.h"
#include "values.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> elevationFiles(std::span<const fs::path> sources) {
  useGdal();
  Findings findings;
  std::vector<fs::path> files;
  for (const fs::path& source : sources) {
    std::error_code error;
    const fs::file_status status = fs::status(source, error);
    if (!fs::exists(status)) {
      findings.push_back(about(Severity::error, source, "", "a file or folder", "nothing there"));
    } else if (fs::is_directory(status)) {
      std::set<fs::path> inside;
      const auto visited =
          visitFiles(source, [&](const fs::path& file) { return inside.insert(file).second; });
      if (!visited) {
        findings.insert(findings.end(), visited.findings().begin(), visited.findings().end());
        continue;
      }
      const std::size_t before = files.size();
      for (const fs::path& file : inside) {
        if (stopRequested()) break;
        // Overviews and masks are rasters too, but belong to the file beside them.
        if (file.extension() == ".ovr" || file.extension() == ".msk") continue;
        const GdalErrors quiet;
        if (GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER, nullptr, nullptr) == nullptr) continue;
        const Dataset data = owned(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
        if (data && looksLikeImage(*data)) continue;
        files.push_back(file);
      }
      if (files.size() == before)
        findings.push_back(about(Severity::error, source, "", "elevation files that GDAL knows",
                                 "none of " + std::to_string(inside.size()) + " files"));
    } else {
      files.push_back(source);
    }
  }
  if (!findings.empty()) return findings;
  return files;
}

}  // namespace trimtab::terrain
