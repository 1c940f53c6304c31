#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "trimtab/terrain/elevation/georeference.h"
#include "trimtab/terrain/grid/post_grid.h"
#include "trimtab/terrain/grid/progress.h"
#include "values.h"

namespace trimtab::terrain {

/// A height up to a post beyond where a raster's posts end, for posts between two rasters that stand side by
/// side. `weight` falls to 0 at a post's distance.
struct Continued {
  std::uint32_t place = 0;  ///< in the rows that were asked for
  float height = 0, weight = 0;
  bool inside = false;  ///< within the outline of the raster's pixels
};

/// One file's heights at posts of a grid that is not its own.
class ElevationFile {
 public:
  /// Where a post lies in the raster, and what is to be added to its height: NaN where PROJ does not know.
  struct Place {
    double x = 0, y = 0, lift = 0;
  };
  /// Memory to read in, some 10 MB: one for all files, which are read one after the other.
  struct Room {
    std::vector<Place> places;
    std::vector<float> window;
    std::vector<std::uint8_t> mask;
  };

  /// Opens, looks through every height once (for voids, and for damage), and closes again.
  static Result<std::unique_ptr<ElevationFile>> open(const std::filesystem::path& path,
                                                     const Progress& progress);

  const std::string& name() const { return name_; }
  /// Its posts as they would be alone.
  const PostGrid& posts() const { return own_; }
  /// Upright and in degrees of WGS84: its posts are used as they are.
  bool isDirect() const { return direct_; }
  /// By whole turns, so that all files lie on one side of the earth.
  void turn(double degrees) { own_.west += degrees; }
  /// The same file turned: for a grid round the earth that has parts of it at both ends.
  std::unique_ptr<ElevationFile> turned(double degrees) const;
  std::uint64_t heights() const { return heights_; }  ///< that are no voids

  /// Before reading. None: no post of the grid is near it.
  bool placeOn(const PostGrid& grid);
  std::uint32_t firstColumn() const { return column_; }
  std::uint32_t columns() const { return columns_; }
  bool reaches(std::uint32_t firstRow, std::uint32_t rows) const {
    return firstRow < row_ + rows_ && row_ < firstRow + rows;
  }

  /// Rows of the grid, this file's columns of them: NaN where it has no height. `reached` is set to 1 where
  /// it could have one; it is `rows` x the grid's columns, as `Continued::place` counts.
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
  std::uint32_t column_ = 0, columns_ = 0, row_ = 0, rows_ = 0;
  std::uint32_t stride_ = 1;                ///< of exact places; bilinear between
  double footprintX_ = 1, footprintY_ = 1;  ///< the raster's posts to a step of the grid
};

}  // namespace trimtab::terrain
