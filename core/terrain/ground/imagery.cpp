#include "trimtab/terrain/ground/imagery.h"

#include <gdal_priv.h>

#include <algorithm>
#include <mutex>
#include <set>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/stop_request.h"
#include "trimtab/terrain/cdb/catalogue.h"
#include "trimtab/terrain/elevation/gdal_errors.h"
#include "trimtab/terrain/grid/parallel.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/ground/image.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

Finding aboutImagery(Severity severity, const fs::path& where, std::string expected, std::string found) {
  return {severity, where.string(), "imagery", std::move(expected), std::move(found)};
}

/// Puts the colours of one image where there are none yet. Returns findings if it cannot be read.
Findings addImage(const GroundImage& image, const PostGrid& posts, std::span<std::uint8_t> rgba) {
  if (!image.touches(posts)) return {};
  const auto read = image.read(posts);
  if (!read) return read.findings();
  for (std::size_t i = 0; i < rgba.size(); i += 4)
    if (rgba[i + 3] == 0) std::copy_n(&(*read)[i], 4, &rgba[i]);
  return {};
}

}  // namespace

Result<std::vector<fs::path>> imageryFiles(const fs::path& imagery) {
  useGdal();
  std::error_code error;
  if (!fs::is_directory(imagery, error)) return std::vector<fs::path>{imagery};
  if (isCdb(imagery)) {
    const auto cdb = openCdb(imagery);
    if (!cdb) return cdb.findings();
    auto tiles = cdbRasters(*cdb, CdbSet::kImagery);
    if (tiles && tiles->empty())
      return aboutImagery(Severity::error, imagery, "a CDB with imagery (Tiles/.../004_Imagery)", "none");
    return tiles;
  }
  std::set<fs::path> inside;
  const auto visited = visitFiles(imagery, [&](const fs::path& file) { return inside.insert(file).second; });
  if (!visited) return visited.findings();
  std::vector<fs::path> files;
  for (const fs::path& file : inside) {
    if (stopRequested()) break;
    // Overviews and masks are rasters too, but belong to the file beside them.
    if (file.extension() == ".ovr" || file.extension() == ".msk" || neverEnds(file)) continue;
    const GdalErrors quiet;
    if (GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER, nullptr, nullptr) != nullptr)
      files.push_back(file);
  }
  if (files.empty())
    return aboutImagery(Severity::error, imagery, "a folder with georeferenced images",
                        "no raster among " + std::to_string(inside.size()) + " files");
  return files;
}

Result<std::vector<fs::path>> imageryOver(const fs::path& imagery, const PostGrid& posts) {
  auto files = imageryFiles(imagery);
  std::error_code error;
  if (!files || !fs::is_directory(imagery, error)) return files;
  std::vector<fs::path> over;
  Findings findings = files.findings();
  std::size_t elsewhere = 0;
  for (const fs::path& file : *files) {
    const auto image = GroundImage::open(file);
    if (image && (*image)->touches(posts)) {
      over.push_back(file);
    } else if (image) {
      ++elsewhere;
    } else {
      for (Finding finding : image.findings()) {
        if (finding.severity == Severity::error) finding.found += ": left out";
        finding.severity = std::min(finding.severity, Severity::warning);
        findings.push_back(std::move(finding));
      }
    }
  }
  if (over.empty()) {
    findings.push_back(aboutImagery(Severity::error, imagery, "images over the terrain",
                                    "none; " + std::to_string(elsewhere) + " lie elsewhere, " +
                                        std::to_string(files->size() - elsewhere) + " cannot be drawn"));
    return findings;
  }
  if (elsewhere > 0)
    findings.push_back(aboutImagery(
        Severity::note, imagery, "images over the terrain",
        std::to_string(elsewhere) + " of " + std::to_string(files->size()) + " lie elsewhere: left out"));
  return Result<std::vector<fs::path>>(std::move(over), std::move(findings));
}

Result<std::vector<std::uint8_t>> readImagery(std::span<const fs::path> files, const PostGrid& posts,
                                              const Progress& progress) {
  Findings notes;
  std::vector<std::unique_ptr<GroundImage>> pictures;
  for (const fs::path& file : files) {
    auto picture = GroundImage::open(file);
    notes.insert(notes.end(), picture.findings().begin(), picture.findings().end());
    if (!picture) return notes;
    pictures.push_back(std::move(picture).value());
  }
  std::vector<std::uint8_t> image(posts.size() * 4);
  constexpr std::uint32_t kRows = 256;
  std::mutex mutex;
  Findings findings;
  const auto band = [&](std::uint32_t i) {
    PostGrid rows = posts;
    rows.south = posts.latitude(i * kRows);
    rows.rows = std::min(kRows, posts.rows - i * kRows);
    const auto rgba = std::span(image).subspan(std::size_t{i} * kRows * posts.columns * 4, rows.size() * 4);
    for (const auto& picture : pictures)
      if (const Findings failed = addImage(*picture, rows, rgba); !failed.empty()) {
        const std::lock_guard lock(mutex);
        findings.insert(findings.end(), failed.begin(), failed.end());
      }
  };
  const std::string what = files.size() == 1 ? "reading " + files[0].filename().string() : "reading imagery";
  if (!forEachParallel((posts.rows + kRows - 1) / kRows, band,
                       [&](double f) { return !progress || progress(f, what); }))
    return cancelled(what);
  if (!findings.empty()) return findings;
  std::size_t covered = 0;
  for (std::size_t i = 3; i < image.size(); i += 4) covered += image[i] != 0;
  const std::string where =
      files.size() == 1 ? files[0].string() : std::to_string(files.size()) + " images together";
  if (covered == 0)
    return Finding{Severity::error, where, "georeference", "an image over the terrain",
                   "none of its posts covered"};
  if (covered < posts.size())
    notes.push_back({Severity::note, where, "georeference", "an image over the whole terrain",
                     std::to_string(posts.size() - covered) + " posts without"});
  return Result<std::vector<std::uint8_t>>(std::move(image), std::move(notes));
}

void drape(std::vector<std::uint8_t> image, std::vector<std::uint8_t>& under) {
  if (under.empty()) {
    under = std::move(image);
    return;
  }
  for (std::size_t i = 0; i + 3 < image.size(); i += 4)
    if (image[i + 3] != 0) std::copy_n(&image[i], 4, &under[i]);
}

}  // namespace trimtab::terrain
