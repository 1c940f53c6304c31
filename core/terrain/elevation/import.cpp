#include "trimtab/terrain/elevation/import.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/grid/voids.h"
#include "values.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr double kMostPosts = 4e8;

/// All rows, with voids as NaN.
Result<HeightGrid> readAll(ElevationSource& source, const Progress& progress) {
  const PostGrid& posts = source.posts();
  if (static_cast<double>(posts.columns) * posts.rows > kMostPosts)
    return Finding{Severity::error, "all files together", "size",
                   "at most 400 million posts at the finest spacing, to be in memory at once",
                   std::to_string(posts.columns) + " x " + std::to_string(posts.rows)};
  constexpr std::uint32_t kBand = 128;
  HeightGrid grid{posts, std::vector<float>(posts.size()), 0, {}};
  std::vector<std::uint8_t> beyond;
  for (std::uint32_t row = 0; row < posts.rows; row += kBand) {
    if (progress && !progress(static_cast<double>(row) / posts.rows, "joining files"))
      return cancelled("joining files");
    const std::uint32_t rows = std::min(kBand, posts.rows - row);
    const std::size_t count = std::size_t{rows} * posts.columns;
    beyond.resize(count);
    const std::span<float> heights(grid.heights.data() + std::size_t{row} * posts.columns, count);
    if (auto read = source.readRows(row, rows, heights, beyond); !read) return read.findings();
    for (std::size_t i = 0; i < count; ++i)
      if (beyond[i] != 0 && std::isnan(heights[i])) ++grid.outside;
  }
  return grid;
}

/// The first half of the work is opening, the second reading.
Progress half(const Progress& progress, double from) {
  if (!progress) return {};
  return [&progress, from](double fraction, const std::string& what) {
    return progress(from + fraction / 2, what);
  };
}

}  // namespace

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
      for (fs::recursive_directory_iterator it(source, fs::directory_options::skip_permission_denied, error),
           end;
           !error && it != end; it.increment(error))
        if (it->is_regular_file(error)) inside.insert(it->path());
      const std::size_t before = files.size();
      for (const fs::path& file : inside) {
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

Result<HeightGrid> readElevation(const fs::path& file, const Progress& progress) {
  ElevationOptions options;
  options.progress = half(progress, 0);
  auto source = openElevation(std::span(&file, 1), options);
  if (!source) return source.findings();
  auto grid = readAll(**source, half(progress, 0.5));
  if (!grid) return grid.findings();
  return Result<HeightGrid>(std::move(grid).value(), source.findings());
}

Result<Imported> importElevation(std::span<const fs::path> sources, const Progress& progress) {
  ElevationOptions options;
  options.progress = half(progress, 0);
  auto source = openElevation(sources, options);
  if (!source) return source.findings();
  Findings findings = source.findings();
  auto grid = readAll(**source, half(progress, 0.5));
  if (!grid) return grid.findings();
  const Findings shares = sharesOf((*source)->names(), (*source)->given());
  findings.insert(findings.end(), shares.begin(), shares.end());
  Imported imported{std::move(grid).value(), 0};
  const std::uint64_t filled = fillVoids(imported.grid), outside = std::min(filled, imported.grid.outside);
  imported.voidsFilled = filled - outside;
  if (outside > 0)
    findings.push_back({Severity::note, (*source)->names().front(), "outline",
                        "elevation over the whole rectangle of the terrain",
                        std::to_string(outside) + " posts beyond it, continued from its edge"});
  return Result<Imported>(std::move(imported), std::move(findings));
}

}  // namespace trimtab::terrain
