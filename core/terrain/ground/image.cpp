#include "trimtab/terrain/ground/image.h"

#include <cpl_string.h>
#include <gdal_utils.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>

#include "trimtab/terrain/elevation/georeference.h"

namespace trimtab::terrain {

namespace {

namespace fs = std::filesystem;

/// What a band that is marked as alpha really holds.
enum class Alpha { none, mask, other };

/// A raster as red, green, blue and alpha where it has one, opened for one thread.
struct Picture {
  PlacedRaster file;
  Dataset bands = owned(nullptr);  ///< over the file's, where those are not in order
  Alpha alpha = Alpha::none;

  GDALDataset& data() const { return bands ? *bands : *file.data; }
};

/// Tells a mask from another band, such as infrared, that a program marked as alpha because it came fourth. A
/// mask is nearly everywhere 0 or 255; only its edges are between. Looks at blocks all over the band.
Result<Alpha> alphaOf(GDALDataset& data, const fs::path& file, const GdalErrors& errors) {
  GDALRasterBand* alpha = nullptr;
  for (int b = 1; b <= data.GetRasterCount(); ++b)
    if (data.GetRasterBand(b)->GetColorInterpretation() == GCI_AlphaBand) alpha = data.GetRasterBand(b);
  if (alpha == nullptr) return Alpha::none;
  constexpr int kLooks = 8;
  constexpr std::size_t kMostBetween = 4;  // one pixel in so many
  int wide = 1, high = 1;
  alpha->GetBlockSize(&wide, &high);
  std::vector<std::uint8_t> block(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high));
  std::size_t pixels = 0, between = 0;
  const int across = (alpha->GetXSize() - 1) / wide + 1, down = (alpha->GetYSize() - 1) / high + 1;
  for (int j = 0; j < std::min(kLooks, down); ++j)
    for (int i = 0; i < std::min(kLooks, across); ++i) {
      const int x = static_cast<int>(std::int64_t{across} * i / std::min(kLooks, across)),
                y = static_cast<int>(std::int64_t{down} * j / std::min(kLooks, down));
      if (alpha->ReadBlock(x, y, block.data()) != CE_None)
        return about(Severity::error, file, "alpha", "an image that can be read",
                     errors.last("GDAL gives no reason"));
      const int columns = std::min(wide, alpha->GetXSize() - x * wide),
                rows = std::min(high, alpha->GetYSize() - y * high);
      for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
          const std::uint8_t a = block[static_cast<std::size_t>(r) * static_cast<std::size_t>(wide) +
                                       static_cast<std::size_t>(c)];
          ++pixels;
          if (a != 0 && a != 255) ++between;
        }
    }
  return kMostBetween * between > pixels ? Alpha::other : Alpha::mask;
}

std::vector<std::string> wordsFor(GDALDataset& data, Alpha alpha) {
  GDALRasterBand& first = *data.GetRasterBand(1);
  // Colours of a palette cannot be mixed as numbers: they become colours first.
  if (first.GetColorTable() != nullptr) return {"-b", "1", "-expand", "rgba"};
  const int count = data.GetRasterCount();
  std::array<int, 4> band{0, 0, 0, 0};
  for (int b = 1; b <= count; ++b) switch (data.GetRasterBand(b)->GetColorInterpretation()) {
      case GCI_RedBand:
        band[0] = b;
        break;
      case GCI_GreenBand:
        band[1] = b;
        break;
      case GCI_BlueBand:
        band[2] = b;
        break;
      case GCI_AlphaBand:
        band[3] = b;
        break;
      default:
        break;
    }
  if (band[0] == 0 || band[1] == 0 || band[2] == 0) {
    const int last = band[3] == 0 ? count : count - 1;
    for (int k = 0; k < 3; ++k) band[static_cast<std::size_t>(k)] = last >= 3 ? k + 1 : 1;
  }
  if (alpha == Alpha::other) band[3] = 0;
  const bool inOrder = band[0] == 1 && band[1] == 2 && band[2] == 3 && (band[3] == 0 || band[3] == 4) &&
                       count == (band[3] == 0 ? 3 : 4);
  if (inOrder) return {};
  std::vector<std::string> words;
  for (const int b : band)
    if (b != 0) words.insert(words.end(), {"-b", std::to_string(b)});
  words.insert(words.end(), {"-colorinterp", band[3] == 0 ? "red,green,blue" : "red,green,blue,alpha"});
  return words;
}

/// Returns what says where a raster is, if it does not say so itself: what warps it asks it. Empty otherwise.
std::vector<std::string> placeFor(const PlacedRaster& file) {
  std::array<double, 6> told{};
  const bool has = file.data->GetGeoTransform(told.data()) == CE_None;
  if ((has && told == file.transform) || (!has && file.data->GetGCPCount() > 0)) return {};
  const auto text = [](double value) { return std::string(CPLSPrintf("%.17g", value)); };
  const auto& at = file.transform;
  return {"-a_srs",
          "EPSG:4326",
          "-a_ullr",
          text(at[0]),
          text(at[3]),
          text(at[0] + at[1] * file.data->GetRasterXSize()),
          text(at[3] + at[5] * file.data->GetRasterYSize())};
}

/// Returns the bands that are wanted in order, nothing copied.
Dataset inOrder(GDALDataset& data, std::vector<std::string> words) {
  words.insert(words.begin(), {"-of", "VRT"});
  std::vector<char*> list;
  for (std::string& word : words) list.push_back(word.data());
  list.push_back(nullptr);
  GDALTranslateOptions* options = GDALTranslateOptionsNew(list.data(), nullptr);
  if (options == nullptr) return owned(nullptr);
  GDALDatasetH result = GDALTranslate("", GDALDataset::ToHandle(&data), options, nullptr);
  GDALTranslateOptionsFree(options);
  return owned(GDALDataset::FromHandle(result));
}

/// `known`: what its alpha is, if it was opened before.
Result<std::unique_ptr<Picture>> openPicture(const fs::path& file, GdalErrors& errors,
                                             std::optional<Alpha> known = {}) {
  auto opened = openRaster(file, errors);
  if (!opened) return opened.findings();
  auto picture = std::make_unique<Picture>(Picture{std::move(opened).value()});
  GDALDataset& data = *picture->file.data;
  for (int b = 1; b <= data.GetRasterCount(); ++b)
    if (const GDALDataType type = data.GetRasterBand(b)->GetRasterDataType(); type != GDT_Byte)
      return about(Severity::error, file, "band " + std::to_string(b), "bytes of red, green and blue",
                   GDALGetDataTypeName(type));
  Findings notes = opened.findings();
  if (!known) {
    const auto alpha = alphaOf(data, file, errors);
    if (!alpha) return alpha.findings();
    known = *alpha;
    if (*alpha == Alpha::other)
      notes.push_back(about(Severity::note, file, "alpha", "a mask of 0 and 255 in the band marked as alpha",
                            "values between, as of infrared: this band is left out"));
  }
  picture->alpha = *known;
  auto words = wordsFor(data, *known);
  for (std::string& word : placeFor(picture->file)) words.push_back(std::move(word));
  if (!words.empty()) {
    picture->bands = inOrder(data, words);
    if (!picture->bands)
      return about(Severity::error, file, "", "bands of red, green and blue",
                   errors.last("GDAL gives no reason"));
  }
  return Result<std::unique_ptr<Picture>>(std::move(picture), std::move(notes));
}

/// Degrees; longitudes on one side of the earth.
struct Outline {
  double west = 0, east = 0, south = 0, north = 0, step = 0;
  bool known = false;  ///< else it may be anywhere
};

Outline outlineOf(const PlacedRaster& raster) {
  const auto& g = raster.transform;
  const OGRSpatialReference to = degreesOfWgs84();
  const std::unique_ptr<OGRCoordinateTransformation> transform(
      OGRCreateCoordinateTransformation(&raster.crs, &to));
  const double columns = raster.data->GetRasterXSize(), rows = raster.data->GetRasterYSize();
  const bool geographic = raster.crs.IsGeographic() != 0;
  const auto place = [&](double column, double row, std::array<double, 2>& at) {
    at = {g[0] + g[1] * column + g[2] * row, g[3] + g[4] * column + g[5] * row};
    const double before = at[0];
    if (!transform || !transform->Transform(1, &at[0], &at[1]) || !std::isfinite(at[0]) ||
        !std::isfinite(at[1]))
      return false;
    // If the raster is in degrees, only the datum has changed, so one across 180 continues.
    if (geographic) at[0] = before + std::remainder(at[0] - before, 360.0);
    return true;
  };
  Outline outline;
  std::array<double, 2> middle{}, right{}, below{};
  if (!place(columns / 2, rows / 2, middle) || !place(columns / 2 + 1, rows / 2, right) ||
      !place(columns / 2, rows / 2 + 1, below))
    return outline;
  const double cosine = std::max(std::cos(middle[1] * 0.017453292519943295), 1e-3);
  const auto apart = [&](const std::array<double, 2>& a) {
    return std::hypot(std::remainder(a[0] - middle[0], 360.0) * cosine, a[1] - middle[1]);
  };
  // An image in degrees has its own step north; others are about as fine in all directions.
  outline.step = geographic && g[4] == 0 ? std::abs(g[5]) : std::sqrt(apart(right) * apart(below));
  outline.west = outline.east = middle[0];
  outline.south = outline.north = middle[1];
  constexpr int kSteps = 32;
  for (int j = 0; j <= kSteps; ++j)
    for (int i = 0; i <= kSteps; ++i) {
      std::array<double, 2> at{};
      if (!place(columns * i / kSteps, rows * j / kSteps, at)) return outline;
      if (!geographic) at[0] = middle[0] + std::remainder(at[0] - middle[0], 360.0);
      outline.west = std::min(outline.west, at[0]), outline.east = std::max(outline.east, at[0]);
      outline.south = std::min(outline.south, at[1]), outline.north = std::max(outline.north, at[1]);
    }
  // About a pole a projected image has all longitudes.
  outline.known = geographic || std::max(-outline.south, outline.north) < 80;
  const double slack = 2 * outline.step + 0.02 * (outline.north - outline.south);
  if (!geographic)
    outline.west -= slack / cosine, outline.east += slack / cosine, outline.south -= slack,
        outline.north += slack;
  return outline;
}

class File final : public GroundImage {
 public:
  File(fs::path file, std::unique_ptr<Picture> first)
      : file_(std::move(file)),
        outline_(outlineOf(first->file)),
        geographic_(first->file.crs.IsGeographic() != 0),
        alpha_(first->alpha) {
    giveBack(std::move(first));
  }
  ~File() override { open_ -= idle_.size(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  double stepDegrees() const override { return outline_.step; }
  bool touches(const PostGrid& posts) const override { return !turns(posts).empty(); }

  Result<std::vector<std::uint8_t>> read(const PostGrid& posts) const override {
    std::vector<std::uint8_t> rgba(posts.size() * 4, 0);
    const std::vector<double> all = turns(posts);
    if (all.empty()) return rgba;
    GdalErrors errors;
    auto picture = take(errors);
    if (!picture) return picture.findings();
    for (const double turn : all) {
      PostGrid turned = posts;
      turned.west += turn;
      if (auto done = readTurned(**picture, turned, errors, rgba); !done) return done.findings();
    }
    giveBack(std::move(picture).value());
    return rgba;
  }

 private:
  /// A folder may hold more images than a program may have open at once. So many stay open; the others are
  /// opened anew whenever they are needed.
  static constexpr std::size_t kMostOpen = 128;

  void giveBack(std::unique_ptr<Picture> picture) const {
    if (open_ >= kMostOpen) return;
    ++open_;
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(picture));
  }

  /// Returns by how many degrees posts must be turned about the earth to meet the image: several turns if
  /// they meet both of its ends.
  std::vector<double> turns(const PostGrid& posts) const {
    if (!outline_.known) return {0.0};
    const double west = posts.longitude(-0.5), east = posts.longitude(posts.columns - 0.5),
                 south = posts.latitude(-0.5), north = posts.latitude(posts.rows - 0.5);
    if (north < outline_.south || south > outline_.north) return {};
    std::vector<double> all;
    for (const double turn : {0.0, -360.0, 360.0, -720.0, 720.0})
      if (east + turn > outline_.west && west + turn < outline_.east) {
        all.push_back(geographic_ ? turn : 0.0);
        if (!geographic_) break;  // the projection knows them all
      }
    return all;
  }

  Result<std::unique_ptr<Picture>> take(GdalErrors& errors) const {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        auto picture = std::move(idle_.back());
        idle_.pop_back();
        --open_;
        return picture;
      }
    }
    return openPicture(file_, errors, alpha_);
  }

  Result<Done> readTurned(Picture& picture, const PostGrid& posts, GdalErrors& errors,
                          std::vector<std::uint8_t>& rgba) const {
    GDALDataset& data = picture.data();
    const bool hasAlpha =
        data.GetRasterBand(data.GetRasterCount())->GetColorInterpretation() == GCI_AlphaBand;
    // A tenth of a pixel of error at most in where a pixel goes; exact places cost ten times as much.
    std::vector<std::string> words = {"-r",  "bilinear", "-wm",           "32",  "-et",
                                      "0.1", "-wo",      "NUM_THREADS=1", "-wo", "UNIFIED_SRC_NODATA=YES"};
    if (!hasAlpha) words.push_back("-dstalpha");
    const Dataset result = warped(data, picture.file.crs, posts, words);
    if (!result)
      return about(Severity::error, file_, "", "an image that GDAL can warp to WGS84",
                   errors.last("GDAL gives no reason"));
    const std::size_t columns = posts.columns;
    std::vector<std::uint8_t> lines(posts.size() * 4);
    const auto line = static_cast<GSpacing>(columns * 4);
    if (result->RasterIO(GF_Read, 0, 0, static_cast<int>(posts.columns), static_cast<int>(posts.rows),
                         lines.data(), static_cast<int>(posts.columns), static_cast<int>(posts.rows),
                         GDT_Byte, 4, nullptr, 4, line, 1, nullptr) != CE_None)
      return about(Severity::error, file_, "bands", "an image that can be read",
                   errors.last("GDAL gives no reason"));
    for (std::size_t r = 0; r < posts.rows; ++r)
      for (std::size_t c = 0; c < columns; ++c) {
        const std::uint8_t* from = &lines[((posts.rows - 1 - r) * columns + c) * 4];
        std::uint8_t* to = &rgba[(r * columns + c) * 4];
        if (from[3] >= 128 && to[3] == 0) std::copy_n(from, 3, to), to[3] = 255;
      }
    return Done{};
  }

  fs::path file_;
  Outline outline_;
  bool geographic_;
  Alpha alpha_;
  static inline std::atomic<std::size_t> open_ = 0;  ///< idle pictures of all files
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Picture>> idle_;
};

}  // namespace

Result<std::unique_ptr<GroundImage>> GroundImage::open(const fs::path& file) {
  useGdal();
  GdalErrors errors;
  auto picture = openPicture(file, errors);
  if (!picture) return picture.findings();
  Findings notes = picture.findings();
  errors.moveTo(notes, file.string(), Severity::warning);
  return Result<std::unique_ptr<GroundImage>>(std::make_unique<File>(file, std::move(picture).value()),
                                              std::move(notes));
}

}  // namespace trimtab::terrain
