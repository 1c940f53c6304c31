#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "evidence.h"
#include "trimtab/terrain/elevation/georeference.h"
#include "trimtab/terrain/elevation/source.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "values.h"

namespace trimtab::terrain {

/// A height extrapolated up to one post beyond a raster's last post, for posts between two adjacent rasters.
/// `weight` falls to 0 at a distance of one post.
struct Continued {
  std::uint32_t place = 0;  ///< index of the post in the rows being read
  float height = 0, weight = 0;
  bool inside = false;  ///< within the outline of the raster's pixels
};

/// Heights of one file, resampled at the posts of another grid.
class ElevationFile {
 public:
  /// Says where a post lies in the raster, in the raster's posts, and the offset of its vertical datum,
  /// metres. A coordinate or offset that PROJ cannot compute is NaN.
  struct Place {
    double x = 0, y = 0, lift = 0;
  };
  /// Buffers for reading, some 10 MB. All files share one, because they are read one after the other.
  struct Room {
    std::vector<Place> places;
    std::vector<float> window;
    std::vector<std::uint8_t> mask;
  };

  /// Opens the file, reads every height once to find voids and damage, and closes it again.
  static Result<std::unique_ptr<ElevationFile>> open(const std::filesystem::path& path,
                                                     const Reading& options, const Progress& progress);

  const std::string& name() const { return name_; }
  /// Returns the grid that the file would have by itself.
  const PostGrid& posts() const { return own_; }
  /// Tells whether the raster is north up in degrees of WGS84, so that its posts can be used as they are.
  bool isDirect() const { return direct_; }
  /// Shifts the longitudes by whole turns, so that all files lie on one side of the earth.
  void turn(double degrees) { own_.west += degrees; }
  /// Returns the same file shifted by `degrees`, for a grid round the earth that has parts of it at both
  /// ends.
  std::unique_ptr<ElevationFile> turned(double degrees) const;
  std::uint64_t heights() const { return heights_; }  ///< posts that are no voids

  /// Returns what speaks for heights in the file, and against them.
  const Evidence& evidence() const { return evidence_; }

  /// Says what read() yields for a post of a grid with wider steps than the file's.
  enum class Sampling { means, points };
  /// Sets the grid whose posts read() yields; call it before reading. Returns false if no post of the grid is
  /// near the file.
  bool placeOn(const PostGrid& grid, Sampling sampling = Sampling::means);
  std::uint32_t firstColumn() const { return column_; }
  std::uint32_t columns() const { return columns_; }
  bool reaches(std::uint32_t firstRow, std::uint32_t rows) const {
    return firstRow < row_ + rows_ && row_ < firstRow + rows;
  }

  /// Reads rows of the grid, only the columns firstColumn() to firstColumn() + columns(): metres, NaN where
  /// the file has no height. Sets `reached` to 1 at posts inside the raster; `reached` has `rows` x the
  /// grid's columns, and Continued::place is an index into it.
  Result<Done> read(std::uint32_t firstRow, std::uint32_t rows, std::span<float> heights,
                    std::span<std::uint8_t> reached, std::vector<Continued>& continued, Room& room);
  bool isOpen() const { return raster_.data != nullptr; }
  void close() { raster_.data.reset(); }

 private:
  struct Rectangle {
    std::uint32_t row, rows, column, columns;
  };

  explicit ElevationFile(PlacedRaster raster) : raster_(std::move(raster)) {}
  Result<Done> lookThrough(const Progress& progress, Findings& notes);
  Result<Done> reopen();
  void findPlaces(const Rectangle& posts, std::vector<Place>& places) const;
  std::vector<Place> exact(std::uint32_t row, std::uint32_t firstColumn, std::uint32_t count,
                           std::uint32_t stride) const;
  std::uint32_t lattice() const;
  Result<Done> readTile(const Rectangle& posts, std::uint32_t firstRow, std::span<float> heights,
                        std::span<std::uint8_t> reached, std::vector<Continued>& continued, Room& room);
  Result<Done> readWindow(std::int64_t column, std::int64_t row, std::int64_t columns, std::int64_t rows,
                          Room& room);

  std::string name_;
  PlacedRaster raster_;
  PostGrid own_, grid_;
  Values values_;
  Vertical vertical_;
  std::shared_ptr<OGRCoordinateTransformation> toFile_;
  std::array<double, 6> inverse_{};  ///< CRS to pixels
  double turn_ = 0;                  ///< of the earth, in the CRS; 0 where no place is met again after one
  bool direct_ = false, flipped_ = false, masked_ = false;
  std::int64_t across_ = 0, down_ = 0;  ///< posts of the raster
  std::uint64_t heights_ = 0;
  Evidence evidence_;
  std::uint32_t column_ = 0, columns_ = 0, row_ = 0, rows_ = 0;
  std::uint32_t stride_ = 1;                ///< of exact places; bilinear between
  double footprintX_ = 1, footprintY_ = 1;  ///< the raster's posts to a step of the grid
};

}  // namespace trimtab::terrain
