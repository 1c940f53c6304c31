#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "grid_surface.h"
#include "trimtab/culling/horizon.h"
#include "trimtab/culling/select.h"
#include "trimtab/frame/box_union.h"

/// A height field in levels, with a brute-force answer to what its surface, as a cut draws it, hides.
namespace trimtab::test {

class LodGround {
 public:
  static constexpr int kCells = 16;

  /// `tiles` x `tiles` of the finest level, a power of two.
  LodGround(int tiles, double stepM, unsigned seed) : posts_(tiles * kCells + 1), step_(stepM) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::array<double, 18> phase{};
    for (double& p : phase) p = 6.28 * unit(random);
    for (int y = 0; y < posts_; ++y)
      for (int x = 0; x < posts_; ++x) {
        double h = 0, size = 420;
        for (std::size_t octave = 0; octave < 6; ++octave, size *= 0.5) {
          const double f = 0.0012 * step_ * std::pow(2.1, double(octave));
          h += size *
               (1 - std::abs(std::sin(f * x + phase[3 * octave] + std::sin(f * y + phase[3 * octave + 1])))) *
               (1 - std::abs(std::sin(f * y + phase[3 * octave + 2])));
        }
        heights_.push_back(static_cast<float>(h + 4 * unit(random)));
      }
    makeIndex(tiles);
  }

  const TerrainIndex& index() const { return index_; }
  double sideM() const { return (posts_ - 1) * step_; }
  const TileRelief& relief(std::uint32_t node) const { return reliefs_[node]; }

  /// Height of the post that is nearest.
  double sourceAt(double x, double y) const {
    const auto post = [this](double v) {
      return std::clamp(static_cast<int>(std::lround(v / step_)), 0, posts_ - 1);
    };
    return double{source(post(x), post(y))};
  }
  void draw(const LevelCut& cut) {
    drawn_.assign(index_.size(), -1);
    for (const TileDraw& tile : cut.tiles) drawn_[tile.node] = tile.border.bits;
  }
  std::vector<HorizonTile> tiles(const LevelCut& cut) const {
    std::vector<int> at(index_.size(), -1);
    for (const TileDraw& tile : cut.tiles) at[tile.node] = 1;
    std::vector<HorizonTile> tiles;
    for (const TileDraw& tile : cut.tiles) {
      const auto on = [&](std::size_t side) -> const TileRelief* {
        const std::uint32_t next = index_.neighbours[tile.node][side];
        return next != TerrainIndex::kNone && at[next] == 1 ? &reliefs_[next] : nullptr;
      };
      tiles.push_back({.relief = &reliefs_[tile.node], .mayOcclude = true, .east = on(1), .north = on(3)});
    }
    return tiles;
  }

  /// z of the surface as drawn; diagonals alternate as the terrain's do.
  double heightAt(double x, double y) const {
    for (std::size_t level = 0; level < index_.levels.size(); ++level) {
      const TerrainIndex::Level& l = index_.levels[level];
      const double cellM = step_ * (1 << level), tileM = cellM * kCells;
      const auto cut = [](double v, int n) { return std::clamp(static_cast<int>(v), 0, n - 1); };
      const int column = cut(x / tileM, static_cast<int>(l.columns)),
                row = cut(y / tileM, static_cast<int>(l.rows));
      const std::uint32_t node =
          l.firstNode + static_cast<std::uint32_t>(row) * l.columns + static_cast<std::uint32_t>(column);
      if (drawn_[node] < 0) continue;
      const double u = std::clamp(x / cellM - column * kCells, 0.0, double{kCells}),
                   v = std::clamp(y / cellM - row * kCells, 0.0, double{kCells});
      const int i = cut(u, kCells), j = cut(v, kCells);
      const double a = u - i, b = v - j;
      const auto post = [&](int c, int r) { return drawnPost(node, level, column, row, c, r); };
      const double sw = post(i, j), se = post(i + 1, j), nw = post(i, j + 1), ne = post(i + 1, j + 1);
      return heightInCell(a, b, (i + j) % 2 == 0, sw, se, nw, ne);
    }
    return 0;
  }

  /// Whether the ground is over the way from `eye` to `p`.
  bool isCovered(Vec3 eye, Vec3 p) const {
    return test::isCovered(eye, p, step_, [this](double x, double y) { return heightAt(x, y); });
  }
  /// A point of a tile's surface as drawn.
  Vec3 pointOf(std::uint32_t node, double u, double v) const {
    const TileRelief& r = reliefs_[node];
    const auto side = static_cast<std::size_t>(kCells);
    const double x0 = r.origin.x + double{r.x[0]}, y0 = r.origin.y + double{r.y[0]},
                 m = double{r.x[side]} - double{r.x[0]};
    const double x = x0 + u * m, y = y0 + v * m;
    return {x, y, heightAt(x, y)};
  }

 private:
  float source(int x, int y) const {
    return heights_[static_cast<std::size_t>(y) * static_cast<std::size_t>(posts_) +
                    static_cast<std::size_t>(x)];
  }
  /// Odd posts of a border beside a coarser tile lie on its edge.
  double drawnPost(std::uint32_t node, std::size_t level, int column, int row, int c, int r) const {
    const auto at = [&](int i, int j) {
      return double{source((column * kCells + i) << level, (row * kCells + j) << level)};
    };
    const int coarser = drawn_[node];
    if (((c == 0 && (coarser & 1)) || (c == kCells && (coarser & 2))) && r % 2 != 0)
      return 0.5 * (at(c, r - 1) + at(c, r + 1));
    if (((r == 0 && (coarser & 4)) || (r == kCells && (coarser & 8))) && c % 2 != 0)
      return 0.5 * (at(c - 1, r) + at(c + 1, r));
    return at(c, r);
  }

  void makeIndex(int tiles) {
    for (int n = tiles, level = 0; n >= 1; n /= 2, ++level) {
      const auto side = static_cast<std::uint32_t>(n);
      index_.levels.push_back({static_cast<std::uint32_t>(index_.bounds.size()), side, side});
      for (int i = 0; i < n * n; ++i) {
        index_.bounds.push_back({});
        index_.level.push_back(static_cast<std::uint8_t>(level));
      }
    }
    const std::size_t count = index_.bounds.size();
    index_.errorM.assign(count, 0);
    index_.slopeMax.assign(count, 1);
    index_.parent.assign(count, TerrainIndex::kNone);
    index_.children.assign(
        count, {TerrainIndex::kNone, TerrainIndex::kNone, TerrainIndex::kNone, TerrainIndex::kNone});
    index_.neighbours = index_.children;
    reliefs_.resize(count);
    for (std::size_t level = 0; level < index_.levels.size(); ++level) {
      const TerrainIndex::Level& l = index_.levels[level];
      for (std::uint32_t row = 0; row < l.rows; ++row)
        for (std::uint32_t column = 0; column < l.columns; ++column) {
          const std::uint32_t node = l.firstNode + row * l.columns + column;
          auto& beside = index_.neighbours[node];
          if (column > 0) beside[0] = node - 1;
          if (column + 1 < l.columns) beside[1] = node + 1;
          if (row > 0) beside[2] = node - l.columns;
          if (row + 1 < l.rows) beside[3] = node + l.columns;
          if (level > 0) {
            const TerrainIndex::Level& finer = index_.levels[level - 1];
            for (std::uint32_t k = 0; k < 4; ++k) {
              const std::uint32_t child =
                  finer.firstNode + (2 * row + k / 2) * finer.columns + 2 * column + k % 2;
              index_.children[node][k] = child;
              index_.parent[child] = node;
            }
          }
          makeTile(node, static_cast<int>(level), static_cast<int>(column), static_cast<int>(row));
        }
    }
  }
  void makeTile(std::uint32_t node, int level, int column, int row) {
    drawn_.assign(index_.size(), -1);
    drawn_[node] = 0;
    TileRelief& r = reliefs_[node];
    const int cell = 1 << level, x0 = column * kCells * cell, y0 = row * kCells * cell;
    r.side = kCells + 1;
    r.origin = {(x0 + 3) * step_, (y0 + 5) * step_, 200};
    Box box = kNoBox;
    double error = 0;
    for (int y = 0; y <= kCells * cell; ++y)
      for (int x = 0; x <= kCells * cell; ++x) {
        const Vec3 p{(x0 + x) * step_, (y0 + y) * step_, double{source(x0 + x, y0 + y)}};
        box = united(box, static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
        if (x % cell == 0 && y % cell == 0) {
          r.x.push_back(static_cast<float>(p.x - r.origin.x));
          r.y.push_back(static_cast<float>(p.y - r.origin.y));
          r.z.push_back(static_cast<float>(p.z - r.origin.z));
        } else {
          error = std::max(error, std::abs(heightOfLevel(level, x0 + x, y0 + y, x0, y0) - p.z));
        }
      }
    r.finish(4);
    index_.bounds[node] = box;
    index_.errorM[node] = static_cast<float>(error * 1.001);
    for (const std::uint32_t child : index_.children[node])
      if (child != TerrainIndex::kNone)
        index_.errorM[node] = std::max(index_.errorM[node], index_.errorM[child]);
  }
  /// Of a tile that begins at post (x0, y0) of the source, unstitched.
  double heightOfLevel(int level, int x, int y, int x0, int y0) const {
    const int cell = 1 << level;
    const int i = std::min((x - x0) / cell, kCells - 1), j = std::min((y - y0) / cell, kCells - 1);
    const double a = double(x - x0) / cell - i, b = double(y - y0) / cell - j;
    const auto post = [&](int c, int r) { return double{source(x0 + c * cell, y0 + r * cell)}; };
    const double sw = post(i, j), se = post(i + 1, j), nw = post(i, j + 1), ne = post(i + 1, j + 1);
    return heightInCell(a, b, (i + j) % 2 == 0, sw, se, nw, ne);
  }

  int posts_;
  double step_;
  std::vector<float> heights_;
  TerrainIndex index_;
  std::vector<TileRelief> reliefs_;
  std::vector<int> drawn_;  ///< one a node: its coarser sides, -1 where it is not drawn
};

}  // namespace trimtab::test
