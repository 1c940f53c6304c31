#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>

#include "trimtab/frame/box_union.h"
#include "trimtab/terrain/format/database.h"

/// A small terrain made of a function, by means of its own: an oracle for what draws and culls any database.
namespace trimtab::test {

/// Of floats, so that the place is inside.
inline Box around(Vec3 p) {
  const auto down = [](double v) { return std::nextafter(static_cast<float>(v), -1e30f); };
  const auto upwards = [](double v) { return std::nextafter(static_cast<float>(v), 1e30f); };
  return {down(p.x), down(p.y), down(p.z), upwards(p.x), upwards(p.y), upwards(p.z)};
}

class SyntheticTerrain final : public terrain::Database {
 public:
  /// Height, metres, of post (column, row) from the south-west.
  using Height = std::function<double(int column, int row)>;

  /// `tiles` x `tiles` tiles of the finest level, a power of two; posts `stepDegrees` apart.
  /// The frame's origin stands in the middle, or `frameOffset` north-east of it.
  SyntheticTerrain(int tiles, double stepDegrees, GeodeticPosition southWest, Height height,
                   Degrees frameOffset = Degrees{0})
      : posts_(tiles * kCells + 1), step_(stepDegrees), southWest_(southWest) {
    const double middle = stepDegrees * (posts_ - 1) / 2;
    index_.frame = LocalFrame({southWest.latitude + Degrees{middle} + frameOffset,
                               southWest.longitude + Degrees{middle} + frameOffset, Metres{0}});
    info_.name = "synthetic";
    info_.southWest = southWest;
    info_.northEast = {southWest.latitude + Degrees{2 * middle},
                       wrapped180(southWest.longitude + Degrees{2 * middle}), Metres{0}};
    info_.columns = info_.rows = static_cast<std::uint32_t>(posts_);
    info_.postLatitude = info_.postLongitude = Degrees{stepDegrees};
    position_.resize(static_cast<std::size_t>(posts_) * static_cast<std::size_t>(posts_));
    height_.resize(position_.size());
    for (int row = 0; row < posts_; ++row)
      for (int column = 0; column < posts_; ++column) {
        const double h = height(column, row);
        const Vec3 p = index_.frame.fromGeodetic(place(column, row, h));
        const auto lattice = [](double x) { return std::round(x * 256) / 256; };
        position_[at(column, row)] = {lattice(p.x), lattice(p.y), lattice(p.z)};
        height_[at(column, row)] = h;
      }
    const auto [low, high] = std::minmax_element(height_.begin(), height_.end());
    info_.lowest = Metres{*low}, info_.highest = Metres{*high};
    makeIndex(tiles);
    tiles_.resize(index_.size());
  }

  const terrain::TerrainInfo& info() const override { return info_; }
  const TerrainIndex& index() const override { return index_; }
  std::optional<Metres> heightAt(Degrees latitude, Degrees longitude) const override {
    const double x = wrapped180(longitude - southWest_.longitude).value() / step_,
                 y = (latitude - southWest_.latitude).value() / step_;
    if (!(x >= 0 && y >= 0 && x <= posts_ - 1 && y <= posts_ - 1)) return {};
    const int column = std::min(static_cast<int>(x), posts_ - 2),
              row = std::min(static_cast<int>(y), posts_ - 2);
    const double u = x - column, v = y - row;
    const auto h = [&](int dx, int dy) { return height_[at(column + dx, row + dy)]; };
    return Metres{(1 - v) * ((1 - u) * h(0, 0) + u * h(1, 0)) + v * ((1 - u) * h(0, 1) + u * h(1, 1))};
  }
  std::optional<Metres> highestWithin(Degrees latitude, Degrees longitude, Metres) const override {
    if (!heightAt(latitude, longitude)) return {};
    return Metres{*std::max_element(height_.begin(), height_.end())};
  }

  /// The first time takes some ms for its slopes, so that it is kept.
  void buildTile(std::uint32_t node, terrain::TileMesh& mesh) const override {
    const std::scoped_lock lock(tilesMutex_);
    std::unique_ptr<const terrain::TileMesh>& kept = tiles_.at(node);
    if (!kept) {
      auto made = std::make_unique<terrain::TileMesh>();
      makeTile(node, *made);
      kept = std::move(made);
    }
    mesh = *kept;
  }
  void makeTile(std::uint32_t node, terrain::TileMesh& mesh) const {
    const auto [column, row, step] = cornerOf(node);
    const Vec3& middle = post(column + kCells / 2 * step, row + kCells / 2 * step);
    const std::array<double, 3> m{middle.x, middle.y, middle.z};
    for (std::size_t i = 0; i < 3; ++i) mesh.origin[i] = static_cast<std::int32_t>(std::floor(m[i] / 16));
    mesh.vertices.resize(terrain::TileMesh::kSide * terrain::TileMesh::kSide);
    for (int y = 0; y <= kCells; ++y)
      for (int x = 0; x <= kCells; ++x) {
        terrain::TileVertex& v = mesh.vertices[static_cast<std::size_t>(y * terrain::TileMesh::kSide + x)];
        const int c = column + x * step, r = row + y * step;
        const Vec3& p = post(c, r);
        v.x = static_cast<float>(p.x - 16.0 * mesh.origin[0]);
        v.y = static_cast<float>(p.y - 16.0 * mesh.origin[1]);
        v.z = static_cast<float>(p.z - 16.0 * mesh.origin[2]);
        const Vec3 across = post(c + step, r) - post(c - step, r),
                   along = post(c, r + step) - post(c, r - step);
        const Vec3 n = normalized(cross(across, along));
        v.normal[0] = static_cast<std::int8_t>(std::lround(127 * n.x));
        v.normal[1] = static_cast<std::int8_t>(std::lround(127 * n.y));
        v.normal[2] = static_cast<std::int8_t>(std::lround(127 * n.z));
        v.slope = static_cast<std::uint8_t>(std::min(254.0, std::ceil(16 * steepest(c, r, 2 * step, step))));
        // Land that differs from post to post, so that a pixel of the wrong triangle shows.
        const auto shade = static_cast<std::uint8_t>(90 + (c * 37 + r * 91) % 120);
        v.colour[0] = shade;
        v.colour[1] = static_cast<std::uint8_t>(250 - shade);
        v.colour[2] = static_cast<std::uint8_t>(60 + (c ^ r) % 64);
        v.colour[3] = 255;
      }
  }

  Vec3 post(int column, int row) const {
    return position_[at(std::clamp(column, 0, posts_ - 1), std::clamp(row, 0, posts_ - 1))];
  }
  int posts() const { return posts_; }

  /// Corner post and spacing of a node, in finest posts.
  struct Corner {
    int column, row, step;
  };
  Corner cornerOf(std::uint32_t node) const {
    const int level = index_.level[node];
    const TerrainIndex::Level& l = index_.levels[static_cast<std::size_t>(level)];
    const std::uint32_t i = node - l.firstNode;
    const int step = 1 << level;
    return {static_cast<int>(i % l.columns) * kCells * step, static_cast<int>(i / l.columns) * kCells * step,
            step};
  }

 private:
  static constexpr int kCells = TerrainIndex::kTileCells;

  std::size_t at(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(posts_) +
           static_cast<std::size_t>(column);
  }
  GeodeticPosition place(int column, int row, double h) const {
    return {southWest_.latitude + Degrees{step_ * row}, southWest_.longitude + Degrees{step_ * column},
            Metres{h}};
  }

  /// Upper bound on the slope of triangles by posts `spacing` or half or twice as far apart, within `reach`
  /// posts.
  double steepest(int column, int row, int reach, int spacing) const {
    double slope = 0;
    for (int s : {std::max(1, spacing / 2), spacing, 2 * spacing})
      for (int r = row - reach - 2 * spacing; r <= row + reach + 2 * spacing; r += s)
        for (int c = column - reach - 2 * spacing; c <= column + reach + 2 * spacing; c += s) {
          const auto rise = [&](int dc, int dr) {
            const Vec3 d = post(c + dc, r + dr) - post(c, r);
            const double run = std::hypot(d.x, d.y);
            return run > 0 ? std::abs(d.z) / run : 0;
          };
          slope = std::max(slope, std::hypot(rise(s, 0), rise(0, s)));
        }
    return slope + 0.02;
  }

  void makeIndex(int tiles) {
    for (int level = 0, n = tiles; n >= 1; ++level, n /= 2) {
      const auto first = static_cast<std::uint32_t>(index_.level.size());
      const auto count = static_cast<std::uint32_t>(n);
      index_.levels.push_back({first, count, count});
      for (std::uint32_t row = 0; row < count; ++row)
        for (std::uint32_t column = 0; column < count; ++column) addNode(level, row, column, count);
    }
    // From the roots' side everything is there: link and gather.
    for (std::uint32_t node = 0; node < index_.size(); ++node) {
      const std::uint32_t parent = index_.parent[node];
      measure(node);
      index_.cones.push_back(coneOf(node));
      if (parent == TerrainIndex::kNone) continue;
      index_.bounds[parent] = united(index_.bounds[parent], index_.bounds[node]);
      index_.errorM[parent] = std::max(index_.errorM[parent], index_.errorM[node]);
    }
    double slope = 0;
    for (int row = 0; row < posts_; row += 64)
      for (int column = 0; column < posts_; column += 64)
        slope = std::max(slope, steepest(column, row, 64, 1));
    index_.slopeMax.assign(index_.size(), static_cast<float>(slope));
  }

  void addNode(int level, std::uint32_t row, std::uint32_t column, std::uint32_t n) {
    const std::uint32_t first = index_.levels.back().firstNode, node = first + row * n + column;
    constexpr std::uint32_t kNone = TerrainIndex::kNone;
    index_.bounds.push_back(kNoBox);
    index_.errorM.push_back(0);
    index_.level.push_back(static_cast<std::uint8_t>(level));
    index_.parent.push_back(n == 1 ? kNone : first + n * n + row / 2 * (n / 2) + column / 2);
    const std::uint32_t below = level == 0 ? 0
                                           : index_.levels[static_cast<std::size_t>(level) - 1].firstNode +
                                                 2 * row * 2 * n + 2 * column;
    index_.children.push_back(
        level == 0 ? std::array<std::uint32_t, 4>{kNone, kNone, kNone, kNone}
                   : std::array<std::uint32_t, 4>{below, below + 1, below + 2 * n, below + 2 * n + 1});
    index_.neighbours.push_back({column > 0 ? node - 1 : kNone, column + 1 < n ? node + 1 : kNone,
                                 row > 0 ? node - n : kNone, row + 1 < n ? node + n : kNone});
  }

  /// Own posts into the bounds, and how far the posts between them are from the own triangles.
  void measure(std::uint32_t node) {
    const auto [column, row, step] = cornerOf(node);
    Box& box = index_.bounds[node];
    float& error = index_.errorM[node];
    for (int y = 0; y <= kCells; ++y)
      for (int x = 0; x <= kCells; ++x) {
        const Vec3 p = post(column + x * step, row + y * step);
        box = united(box, around(p));
      }
    if (step == 1) return;
    for (int r = row; r < row + kCells * step; r += step / 2)
      for (int c = column; c < column + kCells * step; c += step / 2) {
        const int x = c / step * step, y = r / step * step;
        const double u = double(c - x) / step, v = double(r - y) / step;
        const double h00 = height_[at(x, y)], h10 = height_[at(x + step, y)], h01 = height_[at(x, y + step)],
                     h11 = height_[at(x + step, y + step)];
        const double onPlanes =
            (x + y) / step % 2 == 0
                ? (u > v ? h00 + u * (h10 - h00) + v * (h11 - h10) : h00 + v * (h01 - h00) + u * (h11 - h01))
                : (u + v < 1 ? h00 + u * (h10 - h00) + v * (h01 - h00)
                             : h11 + (1 - u) * (h01 - h11) + (1 - v) * (h10 - h11));
        error = std::max(error, static_cast<float>(std::abs(height_[at(c, r)] - onPlanes) * 1.5));
      }
  }

  /// Of the own triangles, no border folded and each that has a neighbour.
  NormalCone coneOf(std::uint32_t node) const {
    const auto corner = cornerOf(node);
    const auto beside = [&](std::size_t side) {
      return index_.neighbours[node][side] != TerrainIndex::kNone;
    };
    std::vector<Vec3> normals;
    for (const bool folded : {false, true}) {
      const auto place = [&](int i, int j) {
        if (folded && j % 2 != 0 && ((i == 0 && beside(0)) || (i == kCells && beside(1)))) --j;
        if (folded && i % 2 != 0 && ((j == 0 && beside(2)) || (j == kCells && beside(3)))) --i;
        return post(corner.column + i * corner.step, corner.row + j * corner.step);
      };
      const auto add = [&](Vec3 a, Vec3 b, Vec3 c) {
        const Vec3 n = cross(b - a, c - a);
        if (dot(n, n) > 0) normals.push_back(normalized(n));
      };
      for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i) {
          const Vec3 sw = place(i, j), se = place(i + 1, j), nw = place(i, j + 1), ne = place(i + 1, j + 1);
          const bool rising = (i + j) % 2 == 0;
          add(sw, se, rising ? ne : nw);
          add(rising ? sw : se, ne, nw);
        }
    }
    return NormalCone::of(normals);
  }

  int posts_;
  double step_;
  GeodeticPosition southWest_;
  terrain::TerrainInfo info_;
  TerrainIndex index_;
  std::vector<Vec3> position_;
  std::vector<double> height_;
  mutable std::mutex tilesMutex_;
  mutable std::vector<std::unique_ptr<const terrain::TileMesh>> tiles_;
};

/// Ridges and valleys of several sizes, to 1,600 m; the same every time.
inline double mountains(int column, int row) {
  const double x = column * 0.021, y = row * 0.023;
  const auto ridge = [](double v) { return 1 - std::abs(std::sin(v)); };
  const double large = ridge(x * 0.7 + 0.6 * std::sin(y * 0.5)) * ridge(y * 0.45 + 0.8 * std::sin(x * 0.33));
  return 1300 * large + 220 * ridge(x * 3.1 + y) * ridge(y * 2.7) + 25 * std::sin(x * 19) * std::cos(y * 17);
}

}  // namespace trimtab::test
