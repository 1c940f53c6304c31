#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tiled_database.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/format/object_file.h"
#include "trimtab/terrain/format/post_sources.h"
#include "trimtab/terrain/format/static_lod_terrain.h"
#include "trimtab/terrain/format/store.h"
#include "trimtab/terrain/grid/land_cover.h"
#include "trimtab/terrain/grid/post_geometry.h"
#include "trimtab/terrain/grid/post_gradient.h"

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kCells = TerrainIndex::kTileCells, kSide = kCells + 1;
constexpr int kNear = 2;  ///< cells either side of a vertex that its slope speaks for
constexpr double kRadian = std::numbers::pi / 180;

class TiledDatabase final : public Database {
 public:
  TiledDatabase(Contents contents, std::filesystem::path folder)
      : contents_(std::move(contents)), folder_(std::move(folder)), geometry_(contents_.posts) {
    contents_.index.frame = geometry_.frame();
  }

  const TerrainInfo& info() const override { return contents_.info; }
  const TerrainIndex& index() const override { return contents_.index; }
  void buildTile(std::uint32_t node, TileMesh& mesh) const override;
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override;
  Metres postDistance() const override {
    constexpr double kMetresPerDegree = 111195;
    return Metres{contents_.posts.stepLatitude * kMetresPerDegree};
  }
  std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres radius) const override;
  std::shared_ptr<const StaticLodTerrain> staticLod() const override { return contents_.staticLod; }
  std::shared_ptr<const PatchTerrain> patches() const override { return contents_.patches; }
  std::shared_ptr<const GroundPyramid> ground() const override { return contents_.ground; }
  std::shared_ptr<const ObjectTerrain> objects() const override { return contents_.objects; }
  Findings damage() const override;
  Findings checkAll() const override;

 private:
  using Rows = CheckedRows::Reader;
  Findings rowDamage() const;
  /// Returns the lowest of all heights where the file is damaged.
  double height(Rows& rows, std::uint32_t row, std::uint32_t column) const {
    const auto* heights = reinterpret_cast<const float*>(rows.row(row));
    return heights ? double{heights[column]} : contents_.info.lowest.value();
  }
  /// Rise towards east and north a metre at a post, from the eight posts around it.
  PostGradient gradient(Rows& rows, std::uint32_t row, std::uint32_t column) const;
  void vertexSlopes(const TilePosts& tile, std::array<std::uint8_t, kSide * kSide>& slopes) const;

  Contents contents_;
  std::filesystem::path folder_;
  PostGeometry geometry_;
};

PostGradient TiledDatabase::gradient(Rows& rows, std::uint32_t row, std::uint32_t column) const {
  return gradientAt(contents_.posts, geometry_, row, column,
                    [&](std::uint32_t r, std::uint32_t c) { return height(rows, r, c); });
}

void TiledDatabase::vertexSlopes(const TilePosts& tile,
                                 std::array<std::uint8_t, kSide * kSide>& slopes) const {
  const TerrainIndex& index = contents_.index;
  const CellSlopes& all = contents_.slopes;
  constexpr int kWide = static_cast<int>(kCells) + 2 * kNear;
  std::array<std::uint8_t, kWide * kWide> cells{};
  const TerrainIndex::Level& level = index.levels[tile.level];
  const int rows = static_cast<int>(level.rows * kCells), columns = static_cast<int>(level.columns * kCells);
  for (int j = 0; j < kWide; ++j) {
    const int row = static_cast<int>(tile.tileRow * kCells) + j - kNear;
    if (row < 0 || row >= rows) continue;
    for (int i = 0; i < kWide; ++i) {
      const int column = static_cast<int>(tile.tileColumn * kCells) + i - kNear;
      if (column < 0 || column >= columns) continue;
      const auto r = static_cast<std::uint32_t>(row), c = static_cast<std::uint32_t>(column);
      std::uint8_t steepest = all.cells[all.at(index, tile.level, r, c)];
      if (tile.level + 1 < index.levels.size())
        steepest = std::max(steepest, all.cells[all.at(index, tile.level + 1, r / 2, c / 2)]);
      if (tile.level > 0) {
        const TerrainIndex::Level& finer = index.levels[tile.level - 1];
        for (const std::uint32_t dr : {0u, 1u})
          for (const std::uint32_t dc : {0u, 1u})
            if (r * 2 + dr < finer.rows * kCells && c * 2 + dc < finer.columns * kCells)
              steepest = std::max(steepest, all.cells[all.at(index, tile.level - 1, r * 2 + dr, c * 2 + dc)]);
      }
      cells[static_cast<std::size_t>(j * kWide + i)] = steepest;
    }
  }
  // The largest of 2 * kNear cells along rows, then along columns.
  std::array<std::uint8_t, kWide* static_cast<int>(kSide)> along{};
  for (std::size_t j = 0; j < kWide; ++j)
    for (std::size_t i = 0; i < kSide; ++i)
      along[j * kSide + i] = *std::max_element(&cells[j * kWide + i], &cells[j * kWide + i] + 2 * kNear);
  for (std::size_t j = 0; j < kSide; ++j)
    for (std::size_t i = 0; i < kSide; ++i) {
      std::uint8_t steepest = 0;
      for (std::size_t k = 0; k < 2 * kNear; ++k) steepest = std::max(steepest, along[(j + k) * kSide + i]);
      slopes[j * kSide + i] = steepest;
    }
}

void TiledDatabase::buildTile(std::uint32_t node, TileMesh& mesh) const {
  const PostGrid& posts = contents_.posts;
  const TilePosts tile(contents_.index, posts, node);
  const Box& box = contents_.index.bounds[node];
  const auto middle = [](float low, float high) {
    return static_cast<std::int32_t>(std::lround((double{low} + double{high}) / 32));
  };
  mesh.origin[0] = middle(box.minX, box.maxX);
  mesh.origin[1] = middle(box.minY, box.maxY);
  mesh.origin[2] = middle(box.minZ, box.maxZ);
  constexpr std::int64_t kOriginSteps = 16 * PostGeometry::kStepsPerMetre;
  const std::int64_t x0 = mesh.origin[0] * kOriginSteps, y0 = mesh.origin[1] * kOriginSteps,
                     z0 = mesh.origin[2] * kOriginSteps;
  constexpr float kStep = 1.0f / static_cast<float>(PostGeometry::kStepsPerMetre);

  std::array<std::uint8_t, kSide * kSide> slopes;
  vertexSlopes(tile, slopes);
  mesh.vertices.resize(kSide * kSide);
  Rows heights(*contents_.heights);
  std::optional<Rows> image;
  if (contents_.image) image.emplace(*contents_.image);
  std::size_t at = 0;
  for (std::uint32_t j = 0; j < kSide; ++j) {
    const std::uint32_t row = tile.row(j);
    const double latitude = posts.latitude(row);
    for (std::uint32_t i = 0; i < kSide; ++i, ++at) {
      const std::uint32_t column = tile.column(i);
      const double h = height(heights, row, column);
      const PostGeometry::Lattice p = geometry_.lattice(row, column, h);
      TileVertex& v = mesh.vertices[at];
      v.x = static_cast<float>(p.x - x0) * kStep;
      v.y = static_cast<float>(p.y - y0) * kStep;
      v.z = static_cast<float>(p.z - z0) * kStep;
      const auto [east, north] = gradient(heights, row, column);
      const Vec3 n = geometry_.normal(row, column, east, north);
      const auto byte = [](double c) {
        return static_cast<std::int8_t>(static_cast<int>(c * 127 + 127.5) - 127);
      };
      v.normal[0] = byte(n.x);
      v.normal[1] = byte(n.y);
      v.normal[2] = byte(n.z);
      v.slope = slopes[at];
      const std::byte* colours = image ? image->row(row) : nullptr;
      const auto* draped =
          colours ? reinterpret_cast<const std::uint8_t*>(colours + std::size_t{column} * 4) : nullptr;
      if (draped && draped[3] != 0) {
        std::copy_n(draped, 3, v.colour);
      } else {
        const auto colour = landCover(h, std::sqrt(east * east + north * north), latitude, row, column);
        std::copy_n(colour.data(), 3, v.colour);
      }
      v.colour[3] = 255;
    }
  }
}

std::optional<Metres> TiledDatabase::heightAt(Degrees latitude, Degrees longitude) const {
  const PostGrid& posts = contents_.posts;
  // Rounding must not put a point on the border outside.
  constexpr double kSlack = 1e-6;
  double column = posts.columnOf(longitude.value()), row = posts.rowOf(latitude.value());
  if (!(column >= -kSlack && column <= posts.columns - 1 + kSlack && row >= -kSlack &&
        row <= posts.rows - 1 + kSlack))
    return {};
  column = std::clamp(column, 0.0, posts.columns - 1.0);
  row = std::clamp(row, 0.0, posts.rows - 1.0);
  const auto c = std::min(static_cast<std::uint32_t>(column), posts.columns - 2);
  const auto r = std::min(static_cast<std::uint32_t>(row), posts.rows - 2);
  Rows rows(*contents_.heights);
  if (!rows.row(r) || !rows.row(r + 1)) return {};
  const double u = column - c, v = row - r;
  const double south = height(rows, r, c) * (1 - u) + height(rows, r, c + 1) * u;
  const double north = height(rows, r + 1, c) * (1 - u) + height(rows, r + 1, c + 1) * u;
  return Metres{south * (1 - v) + north * v};
}

std::optional<Metres> TiledDatabase::highestWithin(Degrees latitude, Degrees longitude, Metres radius) const {
  const PostGrid& posts = contents_.posts;
  const double r = radius.value();
  if (!(r >= 0) || !(std::abs(latitude.value()) <= 90) || !std::isfinite(longitude.value())) return {};
  // The smallest radius of curvature gives the largest angle; the chord is compared, so poles and date line
  // are plain.
  const double angle = std::min(r / 6.335e6, std::numbers::pi);
  const double chord = 2 * 6.371e6 * std::sin(std::min(r / (2 * 6.371e6), std::numbers::pi / 2));
  const Vec3 centre = trimtab::toEcef({latitude, longitude, Metres{0}});
  const double rowsAway = angle / (posts.stepLatitude * kRadian);
  const double row = (latitude.value() - posts.south) / posts.stepLatitude;
  const double lastRow = posts.rows - 1.0, lastColumn = posts.columns - 1.0;
  if (row + rowsAway < 0 || row - rowsAway > lastRow) return {};
  const auto r0 = static_cast<std::uint32_t>(std::clamp(std::floor(row - rowsAway), 0.0, lastRow));
  const auto r1 = static_cast<std::uint32_t>(std::clamp(std::ceil(row + rowsAway), 0.0, lastRow));
  // A circle that holds a pole, or a grid that may meet it on both sides, is searched in full width.
  double c0 = 0, c1 = lastColumn;
  const double reach = std::abs(latitude.value()) * kRadian + angle;
  if (reach < std::numbers::pi / 2 - 1e-3) {
    const double wide = std::asin(std::sin(angle) / std::cos(latitude.value() * kRadian)) /
                            (posts.stepLongitude * kRadian) * 1.01 +
                        1;
    const double column = posts.columnOf(longitude.value());
    const double round = 360 / posts.stepLongitude;
    if (lastColumn + 2 * wide < round) {
      if (column + wide < 0 || column - wide > lastColumn) return {};
      c0 = std::clamp(std::floor(column - wide), 0.0, lastColumn);
      c1 = std::clamp(std::ceil(column + wide), 0.0, lastColumn);
    }
  }
  Rows rows(*contents_.heights);
  std::optional<Metres> highest;
  for (std::uint32_t j = r0; j <= r1; ++j) {
    // No height is better than one that misses a hill.
    if (!rows.row(j)) return {};
    for (auto i = static_cast<std::uint32_t>(c0); i <= static_cast<std::uint32_t>(c1); ++i) {
      if (highest && height(rows, j, i) <= highest->value()) continue;
      const Vec3 d = geometry_.onEllipsoid(j, i) - centre;
      if (dot(d, d) <= chord * chord) highest = Metres{height(rows, j, i)};
    }
  }
  return highest;
}

void append(Findings& all, const Findings& more) {
  all.insert(all.end(), more.begin(), more.end());
}

Findings TiledDatabase::rowDamage() const {
  Findings findings = contents_.heights->damage();
  if (contents_.image) append(findings, contents_.image->damage());
  return findings;
}

Findings TiledDatabase::damage() const {
  Findings findings = rowDamage();
  for (const auto& pages : contents_.pageFiles) append(findings, pages->damage());
  return findings;
}

Findings TiledDatabase::checkAll() const {
  contents_.heights->checkAll();
  if (contents_.image) contents_.image->checkAll();
  Findings findings = rowDamage();
  for (const auto& pages : contents_.pageFiles) append(findings, pages->checkAll().findings());
  append(findings, readPostSources(folder_).findings());
  // Objects are in memory since the database was opened: this is about their file.
  if (contents_.objects) append(findings, readObjects(folder_ / kObjectsName).findings());
  return findings;
}

}  // namespace

std::shared_ptr<const Database> makeDatabase(Contents contents, std::filesystem::path folder) {
  const PostGrid& posts = contents.posts;
  TerrainInfo& info = contents.info;
  info.columns = posts.columns;
  info.rows = posts.rows;
  info.postLongitude = Degrees{posts.stepLongitude};
  info.postLatitude = Degrees{posts.stepLatitude};
  info.southWest = {Degrees{posts.south}, wrapped180(Degrees{posts.west}), info.lowest};
  info.northEast = {Degrees{posts.latitude(posts.rows - 1)},
                    wrapped180(Degrees{posts.longitude(posts.columns - 1)}), info.highest};
  return std::make_shared<TiledDatabase>(std::move(contents), std::move(folder));
}

bool isDatabase(const std::filesystem::path& folder) {
  std::error_code error;
  return std::filesystem::is_regular_file(folder / kManifestName, error);
}

Result<std::shared_ptr<const Database>> Database::open(const std::filesystem::path& folder) {
  return withinMemory(folder, [&]() -> Result<std::shared_ptr<const Database>> {
    auto contents = readContents(folder);
    if (!contents) return contents.findings();
    return Result<std::shared_ptr<const Database>>(makeDatabase(std::move(contents).value(), folder));
  });
}

}  // namespace trimtab::terrain
