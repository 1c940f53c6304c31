#include "file.h"

#include <cpl_string.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "census.h"
#include "dted.h"
#include "height_unit.h"
#include "sample.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/units/number.h"

namespace trimtab::terrain {

namespace fs = std::filesystem;

namespace {

constexpr float kVoid = std::numeric_limits<float>::quiet_NaN();
constexpr double kMostPosts = 4e9;
constexpr std::int64_t kLongestSide = 500'000;
/// So many posts of a raster are in memory at a time, and more only if one row is longer.
constexpr std::int64_t kWindow = std::int64_t{1} << 21;
constexpr double kMostBlockBytes = 512e6;
/// An axis of a file that has more posts to a step than this is averaged along it.
constexpr double kFiner = 1.5;

}  // namespace

Result<std::unique_ptr<ElevationFile>> ElevationFile::open(const fs::path& path, const Reading& options,
                                                           const Progress& progress) {
  useGdal();
  GdalErrors errors;
  auto opened = openRaster(path, errors, RasterKind::heights);
  if (!opened) return opened.findings();
  Findings notes = opened.findings();
  std::unique_ptr<ElevationFile> file(new ElevationFile(std::move(opened).value()));
  PlacedRaster& raster = file->raster_;
  GDALRasterBand& band = *raster.data->GetRasterBand(1);
  file->name_ = path.string();
  file->evidence_ = declaredBy(*raster.data, path.filename().string());
  file->across_ = raster.data->GetRasterXSize();
  file->down_ = raster.data->GetRasterYSize();
  if (Findings faults = dtedFaults(raster, path, options.ignoreChecksums); !faults.empty()) {
    notes.insert(notes.end(), faults.begin(), faults.end());
    if (hasError(faults)) return notes;
  }
  const double posts = static_cast<double>(file->across_) * static_cast<double>(file->down_);
  if (posts > kMostPosts || std::max(file->across_, file->down_) > kLongestSide || file->across_ < 2 ||
      file->down_ < 2)
    return about(Severity::error, path, "size",
                 "2 x 2 to 4 thousand million posts, at most half a million a side",
                 std::to_string(file->across_) + " x " + std::to_string(file->down_));
  int blockColumns = 0, blockRows = 0;
  band.GetBlockSize(&blockColumns, &blockRows);
  if (static_cast<double>(blockColumns) * blockRows * GDALGetDataTypeSizeBytes(band.GetRasterDataType()) >
      kMostBlockBytes)
    return about(Severity::error, path, "blocks", "blocks of at most 512 MB, as it is read block by block",
                 std::to_string(blockColumns) + " x " + std::to_string(blockRows) + " posts in one");

  file->turn_ = turnOf(raster);
  // The last post may stand where the first does; what comes after it repeats others.
  const double pixel = std::abs(raster.transform[1]);
  if (const double once = file->turn_ / pixel + 1.5;
      file->turn_ > 0 && static_cast<double>(file->across_) > once) {
    raster.columns = static_cast<int>(once);
    notes.push_back(about(Severity::note, path, "longitude",
                          "at most 360 degrees from the first post to the last",
                          std::to_string(file->across_ - raster.columns) + " columns more, from column " +
                              std::to_string(raster.columns) + " on: left out, as they repeat the first"));
    file->across_ = raster.columns;
  }
  const auto direct = geographicPosts(raster);
  file->direct_ = direct.has_value();
  file->flipped_ = direct && raster.transform[5] < 0;
  const auto own = direct ? direct : fittingPosts(raster);
  if (!own)
    return about(Severity::error, path, "coordinate reference system", "one that PROJ can turn to WGS84",
                 errors.last("a raster that does not fit on the earth"));
  file->own_ = upToPoles(*own);
  if (own->south < -90.001 || own->latitude(own->rows - 1) > 90.001)
    return about(Severity::error, path, "latitude", "-90 to 90",
                 numberText(own->south, 9) + " to " + numberText(own->latitude(own->rows - 1), 9));
  if (Findings beyond = beyondLimits(file->own_, path.string()); !beyond.empty()) return beyond;
  file->vertical_ = verticalOf(raster);
  if (file->vertical_.note)
    notes.push_back(about(Severity::note, path, "vertical datum", file->vertical_.note->first,
                          file->vertical_.note->second));
  if (file->vertical_.lost)
    notes.push_back(about(Severity::warning, path, "vertical datum", file->vertical_.lost->first,
                          file->vertical_.lost->second));
  const auto unit = heightUnitOf(raster, file->name_, file->vertical_, options.heightUnit);
  notes.insert(notes.end(), unit.findings().begin(), unit.findings().end());
  if (!unit) return notes;
  file->values_ = valuesOf(band, *unit);
  if (file->values_.scale != 1)
    notes.push_back(about(Severity::note, path, "unit", "metres",
                          "a scale of " + numberText(file->values_.scale, 9) + " m, applied"));
  const int flags = band.GetMaskFlags();
  file->masked_ = (flags & (GMF_ALL_VALID | GMF_NODATA)) == 0;
  if (auto looked = file->lookThrough(progress, notes); !looked) {
    notes.insert(notes.end(), looked.findings().begin(), looked.findings().end());
    return notes;
  }
  errors.moveTo(notes, path.string(), Severity::warning);
  file->close();
  return Result<std::unique_ptr<ElevationFile>>(std::move(file), std::move(notes));
}

std::unique_ptr<ElevationFile> ElevationFile::turned(double degrees) const {
  std::unique_ptr<ElevationFile> file(new ElevationFile(
      PlacedRaster{owned(nullptr), raster_.transform, raster_.crs, raster_.columns, raster_.name}));
  file->name_ = name_;
  file->own_ = own_;
  file->values_ = values_;
  file->vertical_ = vertical_;
  file->turn_ = turn_;
  file->direct_ = direct_, file->flipped_ = flipped_, file->masked_ = masked_;
  file->across_ = across_, file->down_ = down_;
  file->heights_ = heights_;
  file->evidence_ = evidence_;
  file->turn(degrees);
  return file;
}

Result<Done> ElevationFile::lookThrough(const Progress& progress, Findings& notes) {
  GDALRasterBand& band = *raster_.data->GetRasterBand(1);
  int blockColumns = 1, blockRows = 1;
  band.GetBlockSize(&blockColumns, &blockRows);
  // Whole blocks, as many as fit.
  const auto most = [](std::int64_t block, std::int64_t room, std::int64_t all) {
    return std::min(all, std::max<std::int64_t>(1, room / block) * block);
  };
  const std::int64_t rows =
      most(blockRows, std::max<std::int64_t>(1, std::min<std::int64_t>(kWindow / across_, 512)), down_);
  const std::int64_t columns = most(blockColumns, std::max<std::int64_t>(1, kWindow / rows), across_);
  Census census;
  Room room;
  const std::string what = "reading " + fs::path(name_).filename().string();
  flipped_ = false;
  for (std::int64_t r = 0; r < down_; r += rows)
    for (std::int64_t c = 0; c < across_; c += columns) {
      if (progress && !progress(static_cast<double>(r) / static_cast<double>(down_), what))
        return cancelled(name_);
      const std::int64_t w = std::min(columns, across_ - c), h = std::min(rows, down_ - r);
      // Posts that a sparse file leaves out need not be looked at.
      const int there =
          band.GetDataCoverageStatus(static_cast<int>(c), static_cast<int>(r), static_cast<int>(w),
                                     static_cast<int>(h), GDAL_DATA_COVERAGE_STATUS_DATA, nullptr);
      if (there == GDAL_DATA_COVERAGE_STATUS_EMPTY) {
        census.leaveOut(static_cast<std::uint64_t>(w * h), values_);
        continue;
      }
      if (auto read = readWindow(c, r, w, h, room); !read) return read.findings();
      census.add(room.window, static_cast<std::size_t>(w), values_);
    }
  flipped_ = direct_ && raster_.transform[5] < 0;
  census.judge(values_);
  if (const auto impossible = census.impossible())
    return about(Severity::error, name_, "band 1", "heights from -11500 to 9500 m", *impossible);
  heights_ = census.heights();
  weighNumbers(evidence_, census.shape(values_), GDALDataTypeIsInteger(band.GetRasterDataType()) != 0);
  if (census.untagged() > 0) {
    const std::string& byNumber = census.untaggedByNumber();
    notes.push_back(about(Severity::note, name_, "no-data",
                          values_.noData ? "heights, or the no-data value " + numberText(*values_.noData, 9)
                                         : "a tag for the value that means none",
                          std::to_string(census.untagged()) +
                              " posts with impossible heights, taken as voids" +
                              (byNumber.empty() ? "" : ": " + byNumber)));
  }
  if (heights_ == 0) notes.push_back(about(Severity::warning, name_, "", "heights", "voids alone"));
  return Done{};
}

Result<Done> ElevationFile::reopen() {
  if (isOpen()) return Done{};
  const GdalErrors quiet;
  raster_.data = owned(GDALDataset::FromHandle(
      GDALOpenEx(raster_.name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr)));
  if (!raster_.data || raster_.data->GetRasterXSize() < across_ || raster_.data->GetRasterYSize() != down_)
    return about(Severity::error, name_, "", "the file as it was a moment ago", "another one, or none");
  return Done{};
}

Result<Done> ElevationFile::readWindow(std::int64_t column, std::int64_t row, std::int64_t columns,
                                       std::int64_t rows, Room& room) {
  const GdalErrors errors;
  GDALRasterBand& band = *raster_.data->GetRasterBand(1);
  room.window.resize(static_cast<std::size_t>(columns * rows));
  // Rows that come from the north are put by a line spacing that runs backwards.
  const std::int64_t first = flipped_ ? down_ - row - rows : row;
  const GSpacing line = static_cast<GSpacing>(sizeof(float)) * columns * (flipped_ ? -1 : 1);
  float* start = room.window.data() + (flipped_ ? (rows - 1) * columns : 0);
  const int x = static_cast<int>(column), y = static_cast<int>(first), w = static_cast<int>(columns),
            h = static_cast<int>(rows);
  if (band.RasterIO(GF_Read, x, y, w, h, start, w, h, GDT_Float32, sizeof(float), line, nullptr) != CE_None)
    return about(Severity::error, name_, "row " + std::to_string(y),
                 "heights of " + std::to_string(h) + " rows", errors.last("GDAL gives no reason"));
  if (!masked_) return Done{};
  room.mask.resize(room.window.size());
  std::uint8_t* last = room.mask.data() + (flipped_ ? (rows - 1) * columns : 0);
  if (band.GetMaskBand()->RasterIO(GF_Read, x, y, w, h, last, w, h, GDT_Byte, 1,
                                   static_cast<GSpacing>(flipped_ ? -columns : columns), nullptr) != CE_None)
    return about(Severity::error, name_, "mask, row " + std::to_string(y), "a mask that can be read",
                 errors.last("GDAL gives no reason"));
  for (std::size_t i = 0; i < room.window.size(); ++i)
    if (room.mask[i] == 0) room.window[i] = kVoid;
  return Done{};
}

Result<Done> ElevationFile::read(std::uint32_t firstRow, std::uint32_t rows, std::span<float> heights,
                                 std::span<std::uint8_t> reached, std::vector<Continued>& continued,
                                 Room& room) {
  std::fill(heights.begin(), heights.end(), kVoid);
  continued.clear();
  const std::uint32_t from = std::max(firstRow, row_), to = std::min(firstRow + rows, row_ + rows_);
  if (from >= to) return Done{};
  if (auto opened = reopen(); !opened) return opened;
  const std::uint32_t tile = direct_ ? 4096 : 256;
  for (std::uint32_t c = 0; c < columns_; c += tile)
    if (auto read = readTile({from, to - from, column_ + c, std::min(tile, columns_ - c)}, firstRow, heights,
                             reached, continued, room);
        !read)
      return read;
  return Done{};
}

Result<Done> ElevationFile::readTile(const Rectangle& posts, std::uint32_t firstRow, std::span<float> heights,
                                     std::span<std::uint8_t> reached, std::vector<Continued>& continued,
                                     Room& room) {
  findPlaces(posts, room.places);
  const auto nearby = [&](const Place& p) {
    return p.x > -1 && p.y > -1 && p.x < static_cast<double>(across_) && p.y < static_cast<double>(down_);
  };
  double west = 1e18, east = -1e18, low = 1e18, high = -1e18;
  for (const Place& p : room.places)
    if (nearby(p))
      west = std::min(west, p.x), east = std::max(east, p.x), low = std::min(low, p.y),
      high = std::max(high, p.y);
  if (west > east) return Done{};
  const bool averagesX = footprintX_ > kFiner, averagesY = footprintY_ > kFiner;
  const double marginX = averagesX ? footprintX_ / 2 : 0, marginY = averagesY ? footprintY_ / 2 : 0;
  const auto bounds = [](double from, double to, std::int64_t count) {
    const double end = static_cast<double>(count - 1);
    const auto first = static_cast<std::int64_t>(std::clamp(std::floor(from) - 2, 0.0, end)),
               last = static_cast<std::int64_t>(std::clamp(std::floor(to) + 3, 0.0, end));
    return std::pair{first, last - first + 1};
  };
  const auto [column, columns] = bounds(west - marginX, east + marginX, across_);
  const auto [row, rows] = bounds(low - marginY, high + marginY, down_);
  if (columns * rows > kWindow && (posts.columns > 1 || posts.rows > 1)) {
    // The raster is too much at once, so it is read in halves.
    Rectangle one = posts, two = posts;
    if (posts.columns >= posts.rows) {
      one.columns = posts.columns / 2;
      two.column += one.columns, two.columns -= one.columns;
    } else {
      one.rows = posts.rows / 2;
      two.row += one.rows, two.rows -= one.rows;
    }
    if (auto read = readTile(one, firstRow, heights, reached, continued, room); !read) return read;
    return readTile(two, firstRow, heights, reached, continued, room);
  }
  // A post for which even that is too much: its mean by strips of rows.
  const bool inStrips = averagesX && averagesY && columns * rows > kWindow;
  const std::int64_t strip = inStrips ? std::max<std::int64_t>(1, kWindow / columns) : rows;
  PostMean mean;
  for (std::int64_t from = 0; from < rows; from += strip) {
    const std::int64_t count = std::min(strip, rows - from);
    if (auto read = readWindow(column, row + from, columns, count, room); !read) return read;
    toMetres(room.window, values_);
    if (inStrips)
      mean.add({column, row + from, columns, count, room.window}, room.places[0].x, room.places[0].y,
               footprintX_, footprintY_);
  }
  const RasterWindow window{column, row, columns, rows, room.window};
  const double lastX = static_cast<double>(across_ - 1), lastY = static_cast<double>(down_ - 1);
  for (std::uint32_t r = 0; r < posts.rows; ++r)
    for (std::uint32_t c = 0; c < posts.columns; ++c) {
      const Place& p = room.places[std::size_t{r} * posts.columns + c];
      if (!nearby(p)) continue;
      float height = 0;
      if (inStrips)
        height = mean.mean();
      else if (averagesX && averagesY)
        height = meanAbout(window, p.x, p.y, footprintX_, footprintY_);
      else if (averagesX || averagesY)
        height =
            meanAlong(window, averagesX, across_, down_, p.x, p.y, averagesX ? footprintX_ : footprintY_);
      else
        height = heightBetween(window, across_, down_, p.x, p.y);
      if (vertical_.toFile) height = static_cast<float>(height + p.lift);
      const std::size_t line = posts.row + r - firstRow;
      const auto place = static_cast<std::uint32_t>(line * grid_.columns + posts.column + c);
      const double outX = std::max({0.0, -p.x, p.x - lastX}), outY = std::max({0.0, -p.y, p.y - lastY});
      if (outX == 0 && outY == 0) {
        reached[place] = 1;
        heights[line * columns_ + posts.column + c - column_] = height;
        continue;
      }
      const bool inside = outX <= 0.5 + 1e-9 && outY <= 0.5 + 1e-9;
      if (inside) reached[place] = 1;
      if (!std::isnan(height))
        continued.push_back({place, height, static_cast<float>((1 - outX) * (1 - outY)), inside});
    }
  return Done{};
}

}  // namespace trimtab::terrain
