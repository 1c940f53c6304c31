#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "grid_surface.h"
#include "trimtab/culling/horizon.h"

namespace trimtab::test {

/// A height field of square tiles, with a brute-force answer to whether a ray ends at it.
class RidgeGround {
 public:
  RidgeGround(int tiles, int cells, double stepM, unsigned seed)
      : cells_(cells), posts_(tiles * cells + 1), step_(stepM) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::array<double, 12> phase{};
    for (double& p : phase) p = 6.28 * unit(random);
    for (int y = 0; y < posts_; ++y)
      for (int x = 0; x < posts_; ++x) {
        double h = 0, size = 300;
        for (std::size_t octave = 0; octave < 4; ++octave, size *= 0.45) {
          const double f = 0.045 * std::pow(2.1, double(octave));
          h += size *
               (1 - std::abs(std::sin(f * x + phase[3 * octave] + std::sin(f * y + phase[3 * octave + 1])))) *
               (1 - std::abs(std::sin(f * y + phase[3 * octave + 2])));
        }
        h += 15 * unit(random);
        // As the earth falls away.
        const double dx = (x - posts_ / 2) * step_, dy = (y - posts_ / 2) * step_;
        heights_.push_back(static_cast<float>(h - (dx * dx + dy * dy) / 12.7e6));
      }
    for (int row = 0; row < tiles; ++row)
      for (int column = 0; column < tiles; ++column)
        reliefs_.push_back(reliefOf(column * cells, row * cells));
  }

  std::vector<HorizonTile> tiles() const {
    std::vector<HorizonTile> tiles;
    for (const TileRelief& relief : reliefs_) tiles.push_back({&relief, true});
    const std::size_t wide = static_cast<std::size_t>((posts_ - 1) / cells_);
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      if (i % wide + 1 < wide) tiles[i].east = &reliefs_[i + 1];
      if (i + wide < tiles.size()) tiles[i].north = &reliefs_[i + wide];
    }
    return tiles;
  }
  const std::vector<TileRelief>& reliefs() const { return reliefs_; }
  /// The same surface as meshes of any triangles, in the order of tiles().
  std::vector<MeshRelief> meshes(int step) const {
    std::vector<MeshRelief> meshes;
    const int tiles = (posts_ - 1) / cells_;
    for (int row = 0; row < tiles; ++row)
      for (int column = 0; column < tiles; ++column)
        meshes.push_back(meshOf(column * cells_, row * cells_, step));
    return meshes;
  }
  double sideM() const { return (posts_ - 1) * step_; }

  /// z of the surface; diagonals alternate as the terrain's do.
  double heightAt(double x, double y) const {
    const double u = std::clamp(x / step_, 0.0, posts_ - 1.0), v = std::clamp(y / step_, 0.0, posts_ - 1.0);
    const int i = std::min(static_cast<int>(u), posts_ - 2), j = std::min(static_cast<int>(v), posts_ - 2);
    const double a = u - i, b = v - j;
    const double sw = post(i, j), se = post(i + 1, j), nw = post(i, j + 1), ne = post(i + 1, j + 1);
    return heightInCell(a, b, (i + j) % 2 == 0, sw, se, nw, ne);
  }

  /// Whether the ground is over the way from `eye` to `p`.
  bool isCovered(Vec3 eye, Vec3 p) const {
    return test::isCovered(eye, p, step_, [this](double x, double y) { return heightAt(x, y); });
  }

 private:
  double post(int x, int y) const {
    return double{heights_[static_cast<std::size_t>(y) * static_cast<std::size_t>(posts_) +
                           static_cast<std::size_t>(x)]};
  }
  MeshRelief meshOf(int column, int row, int step) const {
    const Vec3 origin{(column + cells_ / 3) * step_, (row + cells_ / 2) * step_, 50};
    std::vector<ReliefVertex> vertices;
    std::vector<std::uint16_t> indices;
    for (int y = 0; y <= cells_; ++y)
      for (int x = 0; x <= cells_; ++x)
        vertices.push_back({static_cast<float>((column + x) * step_ - origin.x),
                            static_cast<float>((row + y) * step_ - origin.y),
                            static_cast<float>(post(column + x, row + y) - origin.z),
                            static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)});
    const auto at = [this](int x, int y) { return static_cast<std::uint16_t>(y * (cells_ + 1) + x); };
    for (int y = 0; y < cells_; ++y)
      for (int x = 0; x < cells_; ++x) {
        const auto sw = at(x, y), se = at(x + 1, y), nw = at(x, y + 1), ne = at(x + 1, y + 1);
        if ((column + x + row + y) % 2 == 0)
          indices.insert(indices.end(), {sw, se, ne, sw, ne, nw});
        else
          indices.insert(indices.end(), {sw, se, nw, se, ne, nw});
      }
    MeshRelief relief;
    makeMeshRelief(vertices, indices, origin, step, relief);
    return relief;
  }
  TileRelief reliefOf(int column, int row) const {
    TileRelief relief;
    relief.side = cells_ + 1;
    relief.origin = {(column + cells_ / 2) * step_, (row + cells_ / 2) * step_, 100};
    for (int y = 0; y <= cells_; ++y)
      for (int x = 0; x <= cells_; ++x) {
        relief.x.push_back(static_cast<float>((column + x) * step_ - relief.origin.x));
        relief.y.push_back(static_cast<float>((row + y) * step_ - relief.origin.y));
        relief.z.push_back(static_cast<float>(post(column + x, row + y) - relief.origin.z));
      }
    relief.finish(4);
    return relief;
  }

  int cells_, posts_;
  double step_;
  std::vector<float> heights_;
  std::vector<TileRelief> reliefs_;
};

}  // namespace trimtab::test
