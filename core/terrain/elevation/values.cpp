#include "values.h"

#include <algorithm>
#include <array>
#include <limits>

#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();

}  // namespace

Values valuesOf(GDALRasterBand& band, double unit) {
  Values values;
  int has = 0;
  const double noData = band.GetNoDataValue(&has);
  if (has) values.noData = noData;
  const double scale = band.GetScale(&has);
  values.scale = unit * (has ? scale : 1.0);
  const double offset = band.GetOffset(&has);
  values.offset = unit * (has ? offset : 0.0);
  return values;
}

void toMetres(std::span<float> raw, const Values& values) {
  for (float& v : raw) {
    const float metres = metresOf(v, values);
    const bool isVoid = isTagged(v, values) || !isPossible(metres) || metres < values.deepest ||
                        std::find(values.voids.begin(), values.voids.end(), v) != values.voids.end();
    v = isVoid ? kVoid : metres;
  }
}

Vertical verticalOf(const PlacedRaster& raster) {
  Vertical vertical;
  const OGRSpatialReference* named = raster.data->GetSpatialRef();
  if (named == nullptr || named->IsLocal() || !(named->IsCompound() || named->GetAxesCount() == 3))
    return vertical;
  OGRSpatialReference file = *named, geoid;
  file.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const char* name = file.IsCompound() ? file.GetAttrValue("COMPD_CS|VERT_CS") : nullptr;
  const std::string datum = name ? name : "the ellipsoid";
  double unit = 1;
  if (file.IsCompound()) unit = file.GetTargetLinearUnits("COMPD_CS|VERT_CS", nullptr);
  if (!(unit > 0)) unit = 1;
  vertical.unit = unit;
  if (geoid.SetFromUserInput("EPSG:4326+5773") != OGRERR_NONE) return vertical;
  geoid.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::string expected = "heights above the EGM96 geoid, or a datum that PROJ has a grid for";
  vertical.note = {expected, datum + ": PROJ cannot take it there, heights kept as they are"};
  // Ballpark steps would leave heights as they are and call that a conversion.
  OGRCoordinateTransformationOptions options;
  options.SetBallparkAllowed(false);
  std::shared_ptr<OGRCoordinateTransformation> toFile(
      OGRCreateCoordinateTransformation(&geoid, &file, options));
  if (!toFile) return vertical;
  // Places all over the raster, its borders among them, by way of its horizontal CRS.
  const OGRSpatialReference degrees = degreesOfWgs84();
  std::unique_ptr<OGRCoordinateTransformation> place(
      OGRCreateCoordinateTransformation(&raster.crs, &degrees));
  if (!place) return vertical;
  const GdalErrors quiet;
  constexpr std::size_t kTries = 33;
  std::array<double, kTries> x{}, y{}, z{};
  std::array<int, kTries> placed{}, good{};
  const auto& g = raster.transform;
  const double right = raster.data->GetRasterXSize() - 1, bottom = raster.data->GetRasterYSize() - 1;
  double low = std::numeric_limits<double>::max(), high = -low;
  std::size_t tried = 0, lost = 0;
  for (std::size_t j = 0; j < kTries; ++j) {
    for (std::size_t i = 0; i < kTries; ++i) {
      const double across = 0.5 + right * static_cast<double>(i) / (kTries - 1),
                   down = 0.5 + bottom * static_cast<double>(j) / (kTries - 1);
      x[i] = g[0] + g[1] * across + g[2] * down, y[i] = g[3] + g[4] * across + g[5] * down, z[i] = 0;
    }
    place->Transform(kTries, x.data(), y.data(), nullptr, placed.data());
    for (double& longitude : x) longitude = std::remainder(longitude, 360.0);
    toFile->Transform(kTries, x.data(), y.data(), z.data(), good.data());
    for (std::size_t i = 0; i < kTries; ++i) {
      if (!placed[i]) continue;
      ++tried;
      if (!good[i] || !std::isfinite(z[i])) {
        ++lost;
        continue;
      }
      low = std::min(low, -z[i] * unit), high = std::max(high, -z[i] * unit);
    }
  }
  if (lost == tried) return vertical;
  vertical.note.reset();
  if (lost > 0)
    vertical.lost = {expected, datum + ": PROJ has nothing for " + std::to_string(lost) + " of " +
                                   std::to_string(tried) + " places, where heights are taken as voids"};
  if (lost == 0 && high < 1e-3 && low > -1e-3) return vertical;
  vertical.note = {
      "heights above the EGM96 geoid",
      datum + ": taken there by PROJ, by " + numberText(low, 5) + " to " + numberText(high, 5) + " m"};
  vertical.toFile = std::move(toFile);
  return vertical;
}

}  // namespace trimtab::terrain
