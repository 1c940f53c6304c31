#include "evidence.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string_view>
#include <vector>

#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace {

using Words = std::set<std::string_view>;

const Words kElevationWords{"dem",     "dtm",       "dsm",        "dted",  "elev",       "elevation",
                            "height",  "heights",   "hgt",        "srtm",  "altitude",   "topography",
                            "topo",    "terrain",   "bathymetry", "gebco", "etopo",      "ned",
                            "nasadem", "gdem",      "mnt",        "dgm",   "elevations", "relief",
                            "z",       "orography", "heightmap",  "dhm",   "mde",        "bathy"};
const Words kOtherWords{
    "slope",      "aspect",      "hillshade",   "shade",      "shaded",       "hillshading", "tri",
    "tpi",        "rough",       "roughness",   "curvature",  "accumulation", "ndvi",        "ndwi",
    "evi",        "reflectance", "albedo",      "radiance",   "landcover",    "lulc",        "nlcd",
    "class",      "mask",        "msk",         "wbm",        "flm",          "edm",         "hem",
    "error",      "err",         "num",         "count",      "stk",          "quality",     "qa",
    "sigma",      "uncertainty", "rgb",         "rgba",       "ortho",        "image",       "imagery",
    "orthophoto", "nir",         "swir",        "coherence",  "vv",           "vh",          "swb",
    "geoid",      "undulation",  "temperature", "population", "tid",          "amplitude",   "backscatter"};
const Words kLengths{"m",  "metre", "meter", "metres", "meters", "cm", "dm",     "km",
                     "mm", "ft",    "us-ft", "ftus",   "sfoot",  "yd", "fathom", "yard"};
const Words kOtherUnits{"degree", "degrees", "deg",  "radian",  "radians", "rad", "%",     "percent",
                        "k",      "kelvin",  "c",    "celsius", "degc",    "db",  "count", "dn",
                        "1",      "m/s",     "mm/h", "kg m-2",  "pa",      "hpa", "w m-2"};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Reports a satellite's band by its number: B4, B04, B8A.
bool isBandNumber(const std::string& word) {
  return word.size() >= 2 && word.size() <= 3 && word[0] == 'b' &&
         std::isdigit(static_cast<unsigned char>(word[1])) != 0;
}

/// Counts +1 for words of elevation, -1 for words of something else, 0 for neither or both; `word` gets the
/// one that speaks against it.
int sayWords(const std::string& text, std::string& word) {
  bool elevation = false, other = false;
  std::string one;
  for (const char c : lower(text) + ' ') {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      one += c;
      continue;
    }
    std::string bare = one;
    while (!bare.empty() && std::isdigit(static_cast<unsigned char>(bare.back())) != 0) bare.pop_back();
    if (kElevationWords.contains(bare)) elevation = true;
    if (kOtherWords.contains(bare) || isBandNumber(one)) other = true, word = one;
    one.clear();
  }
  return elevation == other ? 0 : elevation ? 1 : -1;
}

bool isLength(const std::string& unit) {
  const bool named = unit.find("foot") != std::string::npos || unit.find("feet") != std::string::npos ||
                     unit.find("metre") != std::string::npos || unit.find("meter") != std::string::npos;
  return kLengths.contains(unit) || (named && unit.find('/') == std::string::npos);
}

void weigh(int& points, Evidence& evidence, int weight, const std::string& why) {
  points += weight;
  if (weight < 0) evidence.against += (evidence.against.empty() ? "" : ", ") + why;
}

std::string item(GDALMajorObject& object, const char* name) {
  const char* const text = object.GetMetadataItem(name);
  return text ? std::string(text) + ' ' : "";
}

const char* colourOf(GDALColorInterp colour) {
  switch (colour) {
    case GCI_RedBand:
    case GCI_GreenBand:
    case GCI_BlueBand:
      return "red, green and blue";
    case GCI_HueBand:
    case GCI_SaturationBand:
    case GCI_LightnessBand:
      return "hue, saturation and lightness";
    case GCI_CyanBand:
    case GCI_MagentaBand:
    case GCI_YellowBand:
    case GCI_BlackBand:
      return "cyan, magenta, yellow and black";
    default:
      return nullptr;
  }
}

}  // namespace

std::optional<std::string> imageIn(GDALDataset& data) {
  const int bands = data.GetRasterCount();
  if (bands == 0) return "a raster without bands";
  GDALRasterBand& band = *data.GetRasterBand(1);
  if (band.GetColorTable() != nullptr) return "an image with a table of colours";
  const std::string count = std::to_string(bands) + (bands == 1 ? " band" : " bands");
  const bool bytes = band.GetRasterDataType() == GDT_Byte;
  const std::string type = bytes ? "bytes" : GDALGetDataTypeName(band.GetRasterDataType());
  if (const char* const colour = colourOf(band.GetColorInterpretation()))
    return "an image of " + count + " of " + type + " in " + colour;
  if (bands >= 3 && bytes) return "an image of " + count + " of " + type;
  if (GDALDataTypeIsComplex(band.GetRasterDataType())) return "complex numbers, as radar images have";
  return {};
}

Evidence declaredBy(GDALDataset& data, const std::string& name) {
  Evidence evidence;
  GDALRasterBand& band = *data.GetRasterBand(1);
  const GDALDataType type = band.GetRasterDataType();
  const std::string unit = lower(band.GetUnitType()),
                    driver = data.GetDriver() != nullptr ? data.GetDriver()->GetDescription() : "";
  evidence.form =
      driver + ' ' + GDALGetDataTypeName(type) + ' ' + std::to_string(data.GetRasterCount()) + ' ' + unit;
  int& points = evidence.declared;
  if (driver == "SRTMHGT" || driver == "DTED" || driver == "USGSDEM" || driver == "CDED") points += 6;
  if (isLength(unit)) points += 4;
  if (kOtherUnits.contains(unit))
    weigh(points, evidence, -8, "its unit is \"" + std::string(band.GetUnitType()) + '"');
  if (data.GetRasterCount() >= 3 && !isLength(unit))
    weigh(points, evidence, -6, std::to_string(data.GetRasterCount()) + " bands, where elevation has one");
  if (type == GDT_Byte)
    weigh(points, evidence, -3, "its numbers are bytes");
  else if (type != GDT_UInt16)
    points += 1;
  const OGRSpatialReference* const crs = data.GetSpatialRef();
  if (crs != nullptr && crs->IsCompound()) points += 3;
  std::string word;
  const std::string texts = std::string(band.GetDescription()) + ' ' + item(band, "standard_name") +
                            item(band, "long_name") + item(band, "NETCDF_VARNAME") +
                            item(band, "DESCRIPTION") + item(data, "TIFFTAG_IMAGEDESCRIPTION");
  if (const int said = sayWords(texts, word); said != 0)
    weigh(points, evidence, said > 0 ? 3 : -4, "it is described as \"" + word + '"');
  if (const int said = sayWords(name, word); said != 0)
    weigh(points, evidence, said > 0 ? 1 : -2, "its name says \"" + word + '"');
  return evidence;
}

void weighNumbers(Evidence& evidence, const HeightShape& shape, bool whole) {
  // Level ground looks like nothing in particular.
  if (shape.heights == 0 || !(shape.deviation > 0)) return;
  const std::string range =
      "its numbers go from " + numberText(shape.lowest, 4) + " to " + numberText(shape.highest, 4);
  int& points = evidence.numbers;
  if (!whole && shape.lowest >= -1.001 && shape.highest <= 1.001)
    weigh(points, evidence, -4, range + ", as an index has");
  else if (shape.lowest >= -1 && shape.highest > 350 && shape.highest <= 360.001 && shape.turns > 0.002)
    weigh(points, evidence, -4, range + " and turn from one end to the other, as aspects do");
  else if (!whole && shape.lowest >= 0 && shape.highest <= 90)
    weigh(points, evidence, -1, range + ", as slopes do");
  const double roughness = shape.step / shape.deviation;
  if (roughness < 0.15) points += 1;
  if (roughness > 0.35)
    weigh(points, evidence, -1,
          "neighbours differ by " + numberText(100 * roughness, 2) +
              " % of the whole spread, which ground does not");
}

}  // namespace trimtab::terrain
