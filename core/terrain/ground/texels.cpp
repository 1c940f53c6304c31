#include "texels.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "trimtab/terrain/grid/land_cover.h"
#include "trimtab/terrain/grid/post_gradient.h"

namespace trimtab::terrain {

namespace {

constexpr std::uint32_t kTile = GroundShape::kTile;

/// Holds what there is to know of the posts under a tile.
class Posts {
 public:
  Posts(const HeightSource& source, const PostGeometry& geometry, const PostWindow& inner)
      : posts_(source.posts()), geometry_(geometry), inner_(inner) {
    // A post more all around, for differences.
    outer_.column = inner.column == 0 ? 0 : inner.column - 1;
    outer_.row = inner.row == 0 ? 0 : inner.row - 1;
    outer_.columns = std::min(inner.column + inner.columns + 1, posts_.columns) - outer_.column;
    outer_.rows = std::min(inner.row + inner.rows + 1, posts_.rows) - outer_.row;
    heights_.resize(outer_.size());
    source.read(outer_, 1, heights_);
    voids_.resize(inner.size());
    source.readVoids(inner, 1, voids_);
    slopes_.resize(inner.size());
    cover_.resize(inner.size());
    for (std::uint32_t r = 0; r < inner.rows; ++r)
      for (std::uint32_t c = 0; c < inner.columns; ++c)
        slopes_[at(inner.row + r, inner.column + c)] =
            gradientAt(posts_, geometry_, inner.row + r, inner.column + c,
                       [&](std::uint32_t row, std::uint32_t column) { return height(row, column); });
  }

  struct Colour {
    std::uint8_t rgb[3] = {};
    bool known = false;
  };

  std::size_t at(std::uint32_t row, std::uint32_t column) const {
    return std::size_t{row - inner_.row} * inner_.columns + (column - inner_.column);
  }
  const PostGradient& slope(std::uint32_t row, std::uint32_t column) const {
    return slopes_[at(row, column)];
  }
  bool filled(std::uint32_t row, std::uint32_t column) const { return voids_[at(row, column)] != 0; }
  const Colour& cover(std::uint32_t row, std::uint32_t column) {
    Colour& colour = cover_[at(row, column)];
    if (!colour.known) {
      const PostGradient& s = slope(row, column);
      const auto rgb = landCover(height(row, column), std::sqrt(s.east * s.east + s.north * s.north),
                                 posts_.latitude(row), row, column);
      std::copy(rgb.begin(), rgb.end(), colour.rgb);
      colour.known = true;
    }
    return colour;
  }

 private:
  double height(std::uint32_t row, std::uint32_t column) const {
    return static_cast<double>(
        heights_[std::size_t{row - outer_.row} * outer_.columns + (column - outer_.column)]);
  }

  const PostGrid& posts_;
  const PostGeometry& geometry_;
  PostWindow inner_, outer_;
  std::vector<float> heights_;
  std::vector<std::uint8_t> voids_;
  std::vector<PostGradient> slopes_;
  std::vector<Colour> cover_;
};

/// A texel between two posts.
struct Between {
  std::uint32_t low = 0, high = 0, nearest = 0;
  double part = 0;

  Between(std::uint32_t texel, double texelsPerPost, std::uint32_t posts) {
    const double post = texel / texelsPerPost;
    low = static_cast<std::uint32_t>(post);
    high = std::min(low + 1, posts - 1);
    part = post - low;
    nearest = part < 0.5 ? low : high;
  }
};

}  // namespace

GroundTile groundTexels(const HeightSource& heights, const PostGeometry& geometry, double texelsPerPost,
                        std::uint32_t tileColumn, std::uint32_t tileRow, GroundTileSize size,
                        std::span<const std::uint8_t> rgba, std::size_t line) {
  const PostGrid& grid = heights.posts();
  std::vector<Between> across, up;
  for (std::uint32_t c = 0; c < size.columns; ++c)
    across.emplace_back(tileColumn * kTile + c, texelsPerPost, grid.columns);
  for (std::uint32_t r = 0; r < size.rows; ++r)
    up.emplace_back(tileRow * kTile + r, texelsPerPost, grid.rows);
  Posts posts(heights, geometry,
              {across.front().low, up.front().low, across.back().high - across.front().low + 1,
               up.back().high - up.front().low + 1});

  GroundTile tile(std::size_t{kTile} * kTile);
  for (std::uint32_t r = 0; r < size.rows; ++r)
    for (std::uint32_t c = 0; c < size.columns; ++c) {
      const Between &x = across[c], &y = up[r];
      GroundTexel& texel = tile[std::size_t{r} * kTile + c];
      const auto mixed = [&](const auto& value) {
        if (x.part == 0 && y.part == 0) return value(y.low, x.low);
        const double south = value(y.low, x.low) * (1 - x.part) + value(y.low, x.high) * x.part;
        const double north = value(y.high, x.low) * (1 - x.part) + value(y.high, x.high) * x.part;
        return south * (1 - y.part) + north * y.part;
      };
      const double east = mixed([&](auto row, auto column) { return posts.slope(row, column).east; });
      const double north = mixed([&](auto row, auto column) { return posts.slope(row, column).north; });
      const Vec3 normal = geometry.normal(y.nearest, x.nearest, east, north);
      texel.normalX = byteOf(normal.x);
      texel.normalY = byteOf(normal.y);
      texel.voids = posts.filled(y.nearest, x.nearest) ? 255 : 0;
      const std::uint8_t* given = rgba.empty() ? nullptr : &rgba[(r * line + c) * 4];
      if (given != nullptr && given[3] != 0) {
        texel.red = given[0], texel.green = given[1], texel.blue = given[2];
        continue;
      }
      const auto colour = [&](int k) {
        return static_cast<std::uint8_t>(mixed([&](auto row, auto column) {
                                           return static_cast<double>(posts.cover(row, column).rgb[k]);
                                         }) +
                                         0.5);
      };
      texel.red = colour(0), texel.green = colour(1), texel.blue = colour(2);
    }
  padGroundTile(tile, size);
  return tile;
}

}  // namespace trimtab::terrain
