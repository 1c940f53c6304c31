#include "trimtab/terrain/import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "trimtab/terrain/georeference.h"
#include "trimtab/terrain/voids.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();
constexpr double kMostPosts = 4e8;

bool looksLikeImage(GDALDataset& data) {
  GDALRasterBand* band = data.GetRasterCount() > 0 ? data.GetRasterBand(1) : nullptr;
  return band == nullptr || (data.GetRasterCount() >= 3 && band->GetRasterDataType() == GDT_Byte) ||
         band->GetColorTable() != nullptr;
}

/// Metres a unit of the band.
double verticalUnit(const std::string& name) {
  static const std::map<std::string, double> kUnits = {{"ft", 0.3048},
                                                       {"foot", 0.3048},
                                                       {"feet", 0.3048},
                                                       {"international foot", 0.3048},
                                                       {"us survey foot", 1200.0 / 3937},
                                                       {"ftus", 1200.0 / 3937},
                                                       {"us-ft", 1200.0 / 3937},
                                                       {"sfoot", 1200.0 / 3937},
                                                       {"foot_us", 1200.0 / 3937},
                                                       {"cm", 0.01},
                                                       {"centimetre", 0.01},
                                                       {"centimeter", 0.01},
                                                       {"dm", 0.1},
                                                       {"km", 1000},
                                                       {"yd", 0.9144},
                                                       {"fathom", 1.8288}};
  std::string lower;
  for (const char c : name) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto unit = kUnits.find(lower);
  return unit == kUnits.end() ? 1.0 : unit->second;
}

/// What a file's numbers mean.
struct Values {
  std::optional<double> noData;
  double scale = 1, offset = 0;  ///< metres = value * scale + offset
};

Values valuesOf(GDALRasterBand& band) {
  Values values;
  int has = 0;
  const double noData = band.GetNoDataValue(&has);
  if (has) values.noData = noData;
  const double unit = verticalUnit(band.GetUnitType());
  const double scale = band.GetScale(&has);
  values.scale = unit * (has ? scale : 1.0);
  const double offset = band.GetOffset(&has);
  values.offset = unit * (has ? offset : 0.0);
  return values;
}

/// Numbers to metres and voids. A file without a no-data tag may still have voids: the values that mean one
/// everywhere. Where it has some, whatever lies under 500 m below the sea is taken for one too (the lowest
/// shore is at -430 m, and resampling makes mixtures); where it has none, such depths are a sea floor.
std::uint64_t toMetres(std::span<float> raw, const Values& values) {
  const auto noData = values.noData ? static_cast<float>(*values.noData) : kVoid;
  const auto impossible = [](float v) {
    return v == -32767 || v == -32768 || v == -9999 || v == 32767 || !(v > -15000 && v < 40000);
  };
  std::uint64_t untagged = 0;
  for (float& v : raw) {
    if (v == noData || std::isnan(v)) {
      v = kVoid;
    } else if (impossible(v)) {
      v = kVoid;
      ++untagged;
    }
  }
  for (float& v : raw) {
    if (untagged > 0 && v < -500) v = kVoid, ++untagged;
    v = static_cast<float>(v * values.scale + values.offset);
  }
  for (float& v : raw)
    if (v < -11500 || v > 9500) v = kVoid, ++untagged;
  return untagged;
}

Result<Done> readRows(const fs::path& file, GDALRasterBand& band, bool backwards, std::vector<float>& heights,
                      GdalErrors& errors, const Progress& progress) {
  constexpr int kStrip = 128;
  const int columns = band.GetXSize(), rows = band.GetYSize();
  const GSpacing line = static_cast<GSpacing>(sizeof(float)) * columns * (backwards ? -1 : 1);
  for (int from = 0; from < rows; from += kStrip) {
    if (progress && !progress(static_cast<double>(from) / rows, "reading " + file.filename().string()))
      return cancelled(file.string());
    const int count = std::min(kStrip, rows - from);
    float* first = heights.data() + static_cast<std::ptrdiff_t>(backwards ? rows - 1 - from : from) * columns;
    if (band.RasterIO(GF_Read, 0, from, columns, count, first, columns, count, GDT_Float32, sizeof(float),
                      line, nullptr) != CE_None)
      return about(Severity::error, file, "row " + std::to_string(from),
                   "heights of " + std::to_string(count) + " rows", errors.last("GDAL gives no reason"));
  }
  return Done{};
}

/// Takes heights in the raster's own rows, with NaN as voids, to the grid's posts.
bool warpHeights(const PlacedRaster& raster, HeightGrid& grid) {
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const int columns = raster.data->GetRasterXSize(), rows = raster.data->GetRasterYSize();
  const Dataset source = owned(memory->Create("", columns, rows, 1, GDT_Float32, nullptr));
  if (!source) return false;
  std::array<double, 6> transform = raster.transform;
  source->SetGeoTransform(transform.data());
  source->SetSpatialRef(&raster.crs);
  GDALRasterBand* band = source->GetRasterBand(1);
  band->SetNoDataValue(std::nan(""));
  if (band->RasterIO(GF_Write, 0, 0, columns, rows, grid.heights.data(), columns, rows, GDT_Float32, 0, 0,
                     nullptr) != CE_None)
    return false;
  const Dataset result =
      warped(*source, raster.crs, grid.posts, {"-r", "cubic", "-srcnodata", "nan", "-dstnodata", "nan"});
  if (!result) return false;
  grid.heights.assign(grid.posts.size(), kVoid);
  const int across = static_cast<int>(grid.posts.columns), up = static_cast<int>(grid.posts.rows);
  float* last = grid.heights.data() + static_cast<std::ptrdiff_t>(up - 1) * across;
  return result->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, across, up, last, across, up, GDT_Float32,
                                            sizeof(float), -static_cast<GSpacing>(sizeof(float)) * across,
                                            nullptr) == CE_None;
}

}  // namespace

Finding cancelled(const std::string& what) {
  return {Severity::note, what, "", "to be completed", "cancelled"};
}

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
  useGdal();
  GdalErrors errors;
  auto opened = openRaster(file, errors);
  if (!opened) return opened.findings();
  Findings notes = opened.findings();
  GDALDataset& data = *opened->data;
  GDALRasterBand& band = *data.GetRasterBand(1);
  const int columns = data.GetRasterXSize(), rows = data.GetRasterYSize();
  if (looksLikeImage(data))
    return about(Severity::error, file, "band 1", "heights",
                 "an image of " + std::to_string(data.GetRasterCount()) + " bands of bytes");
  if (static_cast<double>(columns) * rows > kMostPosts || columns < 2 || rows < 2)
    return about(Severity::error, file, "size", "2 x 2 to 400 million posts",
                 std::to_string(columns) + " x " + std::to_string(rows));

  const auto direct = geographicPosts(*opened);
  const auto posts = direct ? direct : fittingPosts(*opened);
  if (!posts)
    return about(Severity::error, file, "coordinate reference system", "one that PROJ can turn to WGS84",
                 errors.last("a raster that does not fit on the earth"));
  if (posts->south < -90.001 || posts->latitude(posts->rows - 1) > 90.001)
    return about(Severity::error, file, "latitude", "-90 to 90",
                 std::to_string(posts->south) + " to " + std::to_string(posts->latitude(posts->rows - 1)));

  // Posts go from the south: rows that come from the north are put by a line spacing that runs backwards.
  HeightGrid grid{
      *posts, std::vector<float>(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)), 0, {}};
  const bool backwards = direct && opened->transform[5] < 0;
  if (auto read = readRows(file, band, backwards, grid.heights, errors, progress); !read)
    return read.findings();
  const Values values = valuesOf(band);
  if (const std::uint64_t untagged = toMetres(grid.heights, values); untagged > 0)
    notes.push_back(about(Severity::note, file, "no-data", "a tag for the value that means none",
                          std::to_string(untagged) + " posts with impossible heights, taken as voids"));
  if (values.scale != 1)
    notes.push_back(about(Severity::note, file, "unit", "metres",
                          "a scale of " + std::to_string(values.scale) + " m, applied"));
  if (!direct && !warpHeights(*opened, grid))
    return about(Severity::error, file, "", "a raster that GDAL can warp to WGS84",
                 errors.last("GDAL gives no reason"));
  if (!direct) grid.outside = countOutside(*opened, grid);
  errors.moveTo(notes, file.string(), Severity::warning);
  return Result<HeightGrid>(std::move(grid), std::move(notes));
}

Result<Imported> importElevation(std::span<const fs::path> sources, const Progress& progress) {
  const auto files = elevationFiles(sources);
  if (!files) return files.findings();
  Findings findings;
  std::vector<HeightGrid> parts;
  bool failed = false;
  for (std::size_t i = 0; i < files->size(); ++i) {
    const auto share = [&](double fraction, const std::string& what) {
      return !progress ||
             progress((static_cast<double>(i) + fraction) / static_cast<double>(files->size()), what);
    };
    auto part = readElevation((*files)[i], share);
    findings.insert(findings.end(), part.findings().begin(), part.findings().end());
    if (!part) {
      failed = true;
      if (!share(1, "reading")) return findings;
      continue;
    }
    if (std::all_of(part->heights.begin(), part->heights.end(), [](float h) { return std::isnan(h); }))
      findings.push_back(about(Severity::warning, (*files)[i], "", "heights", "voids alone"));
    parts.push_back(std::move(part).value());
  }
  if (failed) return findings;
  auto joined = mosaic(std::move(parts), progress);
  if (!joined) return joined.findings();
  Imported imported{std::move(joined).value(), 0};
  const std::uint64_t filled = fillVoids(imported.grid), outside = std::min(filled, imported.grid.outside);
  imported.voidsFilled = filled - outside;
  if (outside > 0)
    findings.push_back({Severity::note, (*files)[0].string(), "outline",
                        "elevation over the whole rectangle of the terrain",
                        std::to_string(outside) + " posts beyond it, continued from its edge"});
  return Result<Imported>(std::move(imported), std::move(findings));
}

}  // namespace trimtab::terrain
