#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "trimtab/culling/horizon.h"
#include "trimtab/frame/eye_pose.h"
#include "trimtab/frame/frame.h"

namespace trimtab::bench {

/// 1,201 posts square, 30 m apart, in 80 x 80 tiles of 15 cells: fractal ground with the earth's bend.
class RoughGround {
 public:
  static constexpr int kPosts = 1201, kCells = 15, kTiles = (kPosts - 1) / kCells;
  static constexpr double kPostM = 30;

  RoughGround() {
    heights_.resize(std::size_t{kPosts} * kPosts);
    for (int y = 0; y < kPosts; ++y)
      for (int x = 0; x < kPosts; ++x) {
        double sum = 0, size = 1200, f = 1.0 / 300;
        for (int octave = 0; octave < 9; ++octave, size *= 0.52, f *= 2) sum += size * noise(x * f, y * f);
        const double dx = (x - kPosts / 2) * kPostM, dy = (y - kPosts / 2) * kPostM;
        heights_[at(x, y)] = static_cast<float>(sum - (dx * dx + dy * dy) / 12.74e6);
      }
    reliefs_.resize(std::size_t{kTiles} * kTiles);
    for (int row = 0; row < kTiles; ++row)
      for (int column = 0; column < kTiles; ++column) {
        TileRelief& t = reliefs_[static_cast<std::size_t>(row * kTiles + column)];
        t.side = kCells + 1;
        t.origin = {(column * kCells + 7) * kPostM, (row * kCells + 7) * kPostM, 500};
        for (int y = 0; y <= kCells; ++y)
          for (int x = 0; x <= kCells; ++x) {
            t.x.push_back(static_cast<float>((column * kCells + x) * kPostM - t.origin.x));
            t.y.push_back(static_cast<float>((row * kCells + y) * kPostM - t.origin.y));
            t.z.push_back(
                static_cast<float>(double{heights_[at(column * kCells + x, row * kCells + y)]} - t.origin.z));
          }
        t.finish(8);
      }
    for (std::size_t i = 0; i < reliefs_.size(); ++i)
      tiles_.push_back({&reliefs_[i], true, i % kTiles + 1 < kTiles ? &reliefs_[i + 1] : nullptr,
                        i + kTiles < reliefs_.size() ? &reliefs_[i + kTiles] : nullptr});
  }

  const std::vector<HorizonTile>& tiles() const { return tiles_; }
  double heightAt(double x, double y) const {
    const double u = std::clamp(x / kPostM, 0.0, kPosts - 1.001),
                 v = std::clamp(y / kPostM, 0.0, kPosts - 1.001);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const double a = u - i, b = v - j;
    const auto h = [&](int dx, int dy) { return double{heights_[at(i + dx, j + dy)]}; };
    return (1 - b) * ((1 - a) * h(0, 0) + a * h(1, 0)) + b * ((1 - a) * h(0, 1) + a * h(1, 1));
  }
  Box boxOf(std::size_t tile) const {
    const TileRelief& t = reliefs_[tile];
    const auto x = static_cast<float>(t.origin.x), y = static_cast<float>(t.origin.y),
               z = static_cast<float>(t.origin.z);
    return {x + t.bounds.minX, y + t.bounds.minY, z + t.bounds.minZ,
            x + t.bounds.maxX, y + t.bounds.maxY, z + t.bounds.maxZ};
  }

  /// Which tiles own the centre of a pixel in a level view: every column of pixels walked outwards, a tenth
  /// of a post at a time near by and never more than half a post.
  std::vector<std::uint8_t> owners(const EyePose& eye, const ViewShape& view) const {
    std::vector<std::uint8_t> owns(reliefs_.size());
    const Vec3 right = eye.axes.row[0], forward = -eye.axes.row[2];
    for (int column = 0; column < view.widthPx; ++column) {
      const double across = view.left + (view.right - view.left) * (column + 0.5) / view.widthPx;
      const Vec3 along = forward + right * across;
      double row = -0.5;  // of the highest pixel that is covered
      for (double f = 1; row < view.heightPx - 1; f += std::clamp(f / 100, kPostM / 10, kPostM / 2)) {
        const Vec3 p = eye.position + along * f;
        const double end = (kPosts - 1) * kPostM;
        if (!(p.x >= 0 && p.x < end && p.y >= 0 && p.y < end)) break;
        const double up = (heightAt(p.x, p.y) - eye.position.z) / f;
        const double reached =
            std::floor((up - view.bottom) / (view.top - view.bottom) * view.heightPx - 0.5);
        if (reached < 0 || reached <= row) continue;
        row = reached;
        const int tile = std::min(static_cast<int>(p.y / kPostM) / kCells, kTiles - 1) * kTiles +
                         std::min(static_cast<int>(p.x / kPostM) / kCells, kTiles - 1);
        owns[static_cast<std::size_t>(tile)] = 1;
      }
    }
    return owns;
  }

 private:
  static std::size_t at(int x, int y) {
    return static_cast<std::size_t>(y) * kPosts + static_cast<std::size_t>(x);
  }
  static double hash(int x, int y) {
    unsigned n = static_cast<unsigned>(x) * 374761393u + static_cast<unsigned>(y) * 668265263u;
    n = (n ^ (n >> 13)) * 1274126177u;
    return ((n ^ (n >> 16)) & 0xffffffu) / 16777215.0;
  }
  static double noise(double x, double y) {
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    double a = x - i, b = y - j;
    a = a * a * (3 - 2 * a);
    b = b * b * (3 - 2 * b);
    return (1 - b) * ((1 - a) * hash(i, j) + a * hash(i + 1, j)) +
           b * ((1 - a) * hash(i, j + 1) + a * hash(i + 1, j + 1));
  }

  std::vector<float> heights_;
  std::vector<TileRelief> reliefs_;
  std::vector<HorizonTile> tiles_;
};

inline EyePose levelEye(Vec3 position, double heading) {
  return {position,
          {{Vec3{std::cos(heading), -std::sin(heading), 0}, Vec3{0, 0, 1},
            Vec3{-std::sin(heading), -std::cos(heading), 0}}}};
}

/// Level views from over the ground's middle, the same ones for the same seed.
class RoughViews {
 public:
  RoughViews(const RoughGround& ground, unsigned seed) : ground_(ground), random_(seed) {}
  EyePose next(double aboveM) {
    const double side = (RoughGround::kPosts - 1) * RoughGround::kPostM;
    const double x = side * place_(random_), y = side * place_(random_);
    return levelEye({x, y, ground_.heightAt(x, y) + aboveM}, circle_(random_));
  }

 private:
  const RoughGround& ground_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> place_{0.3, 0.7}, circle_{0, 6.283185307};
};

}  // namespace trimtab::bench
