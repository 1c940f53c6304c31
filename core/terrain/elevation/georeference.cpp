#include "trimtab/terrain/elevation/georeference.h"

#include <cpl_vsi.h>
#include <gdal_utils.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "containers.h"
#include "evidence.h"
#include "file_kind.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/cdb/tile.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

constexpr double kMostPosts = 4e9;

}  // namespace

Dataset owned(GDALDataset* dataset) {
  return {dataset, [](GDALDataset* d) { GDALClose(d); }};
}

OGRSpatialReference degreesOfWgs84() {
  OGRSpatialReference crs;
  crs.importFromEPSG(4326);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

double turnOf(const PlacedRaster& raster) {
  if (raster.crs.IsGeographic()) return 360;
  const OGRSpatialReference degrees = degreesOfWgs84();
  const std::unique_ptr<OGRCoordinateTransformation> there(
      OGRCreateCoordinateTransformation(&raster.crs, &degrees)),
      back(OGRCreateCoordinateTransformation(&degrees, &raster.crs));
  if (!there || !back) return 0;
  const GdalErrors quiet;
  const auto& g = raster.transform;
  const double pixel = std::abs(g[1]), row = raster.data->GetRasterYSize() / 2.0;
  for (const double column : {0.5, raster.columns - 0.5}) {
    const double x = g[0] + g[1] * column + g[2] * row, y = g[3] + g[4] * column + g[5] * row;
    double longitude = x, latitude = y;
    if (!there->Transform(1, &longitude, &latitude)) continue;
    std::array<double, 3> east{}, north{};
    std::array<int, 3> good{};
    for (const std::size_t k : {0u, 1u, 2u})
      east[k] = std::remainder(longitude + static_cast<double>(k) - 1, 360.0), north[k] = latitude;
    back->Transform(3, east.data(), north.data(), nullptr, good.data());
    if (!good[0] || !good[1] || !good[2] || std::abs(north[1] - y) > 0.01 * pixel) continue;
    // One of the two may lie beyond the edge.
    const double turn = 360 * std::min(std::abs(east[1] - east[0]), std::abs(east[2] - east[1])),
                 gone = std::abs(east[1] - x), turns = std::round(gone / turn);
    if (turns >= 1 && std::abs(gone / turns - turn) < 0.01 * pixel) return gone / turns;
  }
  return 0;
}

Finding about(Severity severity, const fs::path& file, std::string key, std::string expected,
              std::string found) {
  return {severity, file.string(), std::move(key), std::move(expected), std::move(found)};
}

std::optional<PostGrid> geographicPosts(const PlacedRaster& raster) {
  const auto& g = raster.transform;
  const OGRSpatialReference& crs = raster.crs;
  GDALDataset& data = *raster.data;
  if (!crs.IsGeographic() || g[2] != 0 || g[4] != 0 || g[1] <= 0 || g[5] == 0) return {};
  PostGrid posts;
  posts.columns = static_cast<std::uint32_t>(raster.columns);
  posts.rows = static_cast<std::uint32_t>(data.GetRasterYSize());
  posts.stepLongitude = g[1];
  posts.stepLatitude = std::abs(g[5]);
  // GDAL's origin is the corner of the first pixel, whether the file says area or point; posts are pixel
  // centres.
  posts.west = g[0] + g[1] / 2;
  posts.south = g[5] < 0 ? g[3] + g[5] * (posts.rows - 0.5) : g[3] + g[5] / 2;
  OGRSpatialReference to = degreesOfWgs84();
  std::unique_ptr<OGRCoordinateTransformation> shift(OGRCreateCoordinateTransformation(&crs, &to));
  if (!shift) return {};
  for (const double across : {0.0, 0.5, 1.0})
    for (const double up : {0.0, 0.5, 1.0}) {
      const double x = posts.longitude(across * (posts.columns - 1)),
                   y = posts.latitude(up * (posts.rows - 1));
      double lon = x, lat = y;
      if (!shift->Transform(1, &lon, &lat)) return {};
      // Datums within some 2 m are the same for elevation: NAD83, ETRS89 and their kind are read post by
      // post.
      if (std::abs(std::remainder(lon - x, 360)) > 2e-5 || std::abs(lat - y) > 2e-5) return {};
    }
  return posts;
}

namespace {

/// Returns the angle on the sphere, in a way that is good near the poles too.
double degreesApart(const std::array<double, 2>& a, const std::array<double, 2>& b) {
  constexpr double kDegree = std::numbers::pi / 180;
  const double north = std::sin((b[1] - a[1]) * kDegree / 2), east = std::sin((b[0] - a[0]) * kDegree / 2);
  const double chord = north * north + std::cos(a[1] * kDegree) * std::cos(b[1] * kDegree) * east * east;
  return 2 * std::asin(std::sqrt(std::min(1.0, chord))) / kDegree;
}

/// 1: the north pole lies in the raster, -1: the south pole.
int poleIn(const PlacedRaster& raster) {
  std::array<double, 6> forward = raster.transform, inverse{};
  const OGRSpatialReference from = degreesOfWgs84();
  const std::unique_ptr<OGRCoordinateTransformation> transform(
      OGRCreateCoordinateTransformation(&from, &raster.crs));
  if (!transform || raster.crs.IsGeographic() || !GDALInvGeoTransform(forward.data(), inverse.data()))
    return 0;
  // Most projections do not reach a pole, which is no fault of the raster.
  const GdalErrors quiet;
  for (const int pole : {1, -1}) {
    // A pole counts only where it is a point, and not the edge of a cylinder.
    std::array<double, 2> x{0, 90}, y{90.0 * pole, 90.0 * pole};
    if (!transform->Transform(2, x.data(), y.data()) || std::hypot(x[1] - x[0], y[1] - y[0]) > 1) continue;
    const double column = inverse[0] + inverse[1] * x[0] + inverse[2] * y[0],
                 row = inverse[3] + inverse[4] * x[0] + inverse[5] * y[0];
    if (column > 0 && row > 0 && column < raster.columns && row < raster.data->GetRasterYSize()) return pole;
  }
  return 0;
}

}  // namespace

std::optional<PostGrid> fittingPosts(const PlacedRaster& raster) {
  const auto& g = raster.transform;
  const OGRSpatialReference& crs = raster.crs;
  GDALDataset& data = *raster.data;
  OGRSpatialReference to = degreesOfWgs84();
  std::unique_ptr<OGRCoordinateTransformation> transform(OGRCreateCoordinateTransformation(&crs, &to));
  if (!transform) return {};
  const double columns = raster.columns, rows = data.GetRasterYSize();
  std::optional<double> reference;
  const auto place = [&](double column, double row) -> std::optional<std::array<double, 2>> {
    double x = g[0] + g[1] * (column + 0.5) + g[2] * (row + 0.5),
           y = g[3] + g[4] * (column + 0.5) + g[5] * (row + 0.5);
    if (!transform->Transform(1, &x, &y) || !std::isfinite(x) || !std::isfinite(y)) return {};
    if (!reference) reference = x;
    return std::array<double, 2>{*reference + std::remainder(x - *reference, 360.0), y};
  };
  const int pole = poleIn(raster);
  const auto middle = place(columns / 2, rows / 2), right = place(columns / 2 + 1, rows / 2),
             below = place(columns / 2, rows / 2 + 1);
  if (!middle || !right || !below) return {};
  const double step = std::sqrt(degreesApart(*middle, *right) * degreesApart(*middle, *below));
  if (!(step > 0)) return {};

  constexpr double kFar = 1e9;
  double west = kFar, east = -kFar, south = kFar, north = -kFar;
  constexpr int kSteps = 200;
  for (int k = 0; k <= kSteps; ++k) {
    const double c = (columns - 1) * k / kSteps, r = (rows - 1) * k / kSteps;
    for (const auto& edge : {place(0, r), place(columns - 1, r), place(c, 0), place(c, rows - 1)}) {
      if (!edge) return {};
      west = std::min(west, (*edge)[0]), east = std::max(east, (*edge)[0]);
      south = std::min(south, (*edge)[1]), north = std::max(north, (*edge)[1]);
    }
  }
  PostGrid posts;
  posts.stepLatitude = step;
  if (pole != 0) {
    // Goes all the way round, at the spacing of its farthest corner; a row is on the pole itself.
    const double reach = pole > 0 ? 90 - south : 90 + north;
    const double around = std::max(8.0, std::ceil(360 * std::sin(reach * std::numbers::pi / 180) / step));
    posts.stepLongitude = 360 / around;
    west = -180, east = 180;
    const double up = std::floor(reach / step + 1e-6);
    (pole > 0 ? south : north) = pole * (90 - up * step);
    (pole > 0 ? north : south) = pole * 90.0;
  } else {
    posts.stepLongitude = step / std::max(std::cos((*middle)[1] * std::numbers::pi / 180), 1e-3);
  }
  posts.west = west;
  posts.south = south;
  const double across = std::ceil((east - west) / posts.stepLongitude - 1e-6) + 1,
               up = std::ceil((north - south) / posts.stepLatitude - 1e-6) + 1;
  if (!(across >= 2 && up >= 2 && across * up < kMostPosts)) return {};
  posts.columns = static_cast<std::uint32_t>(across);
  posts.rows = static_cast<std::uint32_t>(up);
  return posts;
}

Dataset warped(GDALDataset& data, const OGRSpatialReference& crs, const PostGrid& posts,
               std::vector<std::string> more) {
  char* text = nullptr;
  crs.exportToWkt(&text);
  const std::string source = text ? text : "";
  CPLFree(text);
  const auto number = [](double v) {
    std::array<char, 40> buffer;
    CPLsnprintf(buffer.data(), buffer.size(), "%.17g", v);
    return std::string(buffer.data());
  };
  std::vector<std::string> words = {"-of",
                                    "MEM",
                                    "-s_srs",
                                    source,
                                    "-t_srs",
                                    "EPSG:4326",
                                    "-et",
                                    "0",
                                    "-wo",
                                    "NUM_THREADS=ALL_CPUS",
                                    "-te",
                                    number(posts.west - posts.stepLongitude / 2),
                                    number(posts.south - posts.stepLatitude / 2),
                                    number(posts.longitude(posts.columns - 0.5)),
                                    number(posts.latitude(posts.rows - 0.5)),
                                    "-ts",
                                    std::to_string(posts.columns),
                                    std::to_string(posts.rows)};
  words.insert(words.end(), more.begin(), more.end());
  std::vector<char*> list;
  for (std::string& word : words) list.push_back(word.data());
  list.push_back(nullptr);
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(list.data(), nullptr);
  if (options == nullptr) return owned(nullptr);
  GDALDatasetH handle = GDALDataset::ToHandle(&data);
  GDALDatasetH result = GDALWarp("", nullptr, 1, &handle, options, nullptr);
  GDALWarpAppOptionsFree(options);
  return owned(GDALDataset::FromHandle(result));
}

namespace {

/// Tells a path where nothing is, and a folder, from a file. A name that only GDAL understands, as of a file
/// in an archive or of a part of a file, is left to it.
Result<Done> isOneFile(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error))
    // Some formats are folders, which GDAL knows by what is inside.
    return GDALIdentifyDriverEx(file.c_str(), GDAL_OF_RASTER, nullptr, nullptr) != nullptr
               ? Result<Done>(Done{})
               : about(Severity::error, file, "", "a raster that GDAL can read", "a folder that is none");
  VSIStatBufL there;
  if (!fs::exists(file, error) && file.string().find(':') == std::string::npos &&
      VSIStatL(file.c_str(), &there) != 0)
    return about(Severity::error, file, "", "a raster that GDAL can read", "nothing there");
  return Done{};
}

/// Places a CDB's tile by its name, which counts more than what the raster says of its place: programs that
/// copy tiles leave that as it was. Posts of elevation stand at the south-west corners of their cells, pixels
/// of others fill theirs. Returns none if the name is none of a tile, or the raster has another size than its
/// level. The finding says whether the raster contradicts its name.
std::optional<std::pair<std::array<double, 6>, std::optional<Finding>>> placedByName(const fs::path& file,
                                                                                     GDALDataset& data) {
  const auto name = cdbNameOf(file.stem().string());
  if (!name || !name->rest.empty() || data.GetRasterXSize() != name->tile.side() ||
      data.GetRasterYSize() != name->tile.side())
    return {};
  const CdbExtent extent = name->tile.extent();
  const double side = name->tile.side(), width = extent.width / side, height = extent.height / side,
               half = name->tile.set == CdbSet::kElevation ? 0.5 : 0;
  const std::array<double, 6> placed{
      extent.west - half * width, width, 0, extent.south + extent.height - half * height, 0, -height};
  constexpr double kSamePlace = 0.01;  // of a pixel
  std::array<double, 6> told{};
  if (data.GetGeoTransform(told.data()) == CE_None)
    for (const double end : {0.0, side}) {
      const double x = told[0] + told[1] * end + told[2] * end, y = told[3] + told[4] * end + told[5] * end,
                   east = placed[0] + width * end, north = placed[3] - height * end;
      if (std::abs(x - east) > kSamePlace * width || std::abs(y - north) > kSamePlace * height)
        return std::pair{placed, std::optional(about(Severity::warning, file, "georeference",
                                                     "the place that its name says, " + numberText(east, 9) +
                                                         ", " + numberText(north, 9) + ": used",
                                                     numberText(x, 9) + ", " + numberText(y, 9)))};
    }
  return std::pair{placed, std::optional<Finding>()};
}

}  // namespace

Result<PlacedRaster> openRaster(const fs::path& file, GdalErrors& errors, RasterKind kind) {
  if (auto there = isOneFile(file); !there) return there.findings();
  if (const auto data = checkIsData(file); !data) return data.findings();
  if (neverEnds(file))
    return about(Severity::error, file, "", "a raster that GDAL can read", "a pipe or a device");
  Findings notes;
  auto name = gdalNameOf(file);
  if (!name) return name.findings();
  PlacedRaster opened{owned(GDALDataset::FromHandle(
                          GDALOpenEx(name->c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                     nullptr, nullptr, nullptr))),
                      {},
                      degreesOfWgs84(),
                      0,
                      std::move(name).value()};
  if (!opened.data)
    return about(Severity::error, file, "", "a raster that GDAL can read", whatItIs(file, errors));
  if (opened.data->GetRasterCount() < 1)
    return about(Severity::error, file, "", "a raster with a band", "none");
  if (const auto image = imageIn(*opened.data); image && kind == RasterKind::heights)
    return about(Severity::error, file, "band 1", "heights", *image + ", which can be draped over elevation");
  errors.moveTo(notes, file.string(), Severity::warning);
  opened.columns = opened.data->GetRasterXSize();
  if (auto named = placedByName(file, *opened.data)) {
    opened.transform = named->first;
    if (named->second) notes.push_back(*std::move(named->second));
    return Result<PlacedRaster>(std::move(opened), std::move(notes));
  }
  const OGRSpatialReference* crs = opened.data->GetSpatialRef();
  if (opened.data->GetGeoTransform(opened.transform.data()) != CE_None) {
    const int points = opened.data->GetGCPCount();
    if (points == 0)
      return about(Severity::error, file, "georeference", "where the raster is on earth", "none");
    if (!GDALGCPsToGeoTransform(points, opened.data->GetGCPs(), opened.transform.data(), FALSE))
      return about(Severity::error, file, "georeference",
                   "where the raster is on earth: warp it by its points first, with \"gdalwarp -tps -t_srs "
                   "EPSG:4326 IN OUT.tif\"",
                   std::to_string(points) + " ground control points, which do not lie on a plane map");
    crs = opened.data->GetGCPSpatialRef();
    notes.push_back(about(Severity::note, file, "georeference", "where the raster is on earth",
                          std::to_string(points) + " ground control points: placed by them"));
  }
  for (const double g : opened.transform)
    if (!std::isfinite(g))
      return about(Severity::error, file, "georeference", "finite numbers", "not a number");
  if (crs != nullptr && !crs->IsLocal()) {
    opened.crs = *crs;
    // What heights are measured from is another matter than where they are.
    if (opened.crs.IsCompound()) opened.crs.StripVertical();
    if (opened.crs.GetAxesCount() == 3) opened.crs.DemoteTo2D(nullptr);
    opened.crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  } else {
    const auto& g = opened.transform;
    const double east = g[0] + g[1] * opened.data->GetRasterXSize(),
                 south = g[3] + g[5] * opened.data->GetRasterYSize();
    const auto onEarth = [](double lon, double lat) { return std::abs(lon) <= 360 && std::abs(lat) <= 90.5; };
    if (!onEarth(g[0], g[3]) || !onEarth(east, south))
      return about(Severity::error, file, "coordinate reference system",
                   "one, or degrees of longitude and latitude",
                   "none, and an origin of " + numberText(g[0], 9) + ", " + numberText(g[3], 9));
    notes.push_back(
        about(Severity::note, file, "coordinate reference system", "one", "none: taken as WGS84 degrees"));
  }
  return Result<PlacedRaster>(std::move(opened), std::move(notes));
}

}  // namespace trimtab::terrain
