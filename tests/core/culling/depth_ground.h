#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "trimtab/culling/depth_map.h"
#include "trimtab/frame/box_union.h"
#include "view_axes.h"

/// Ground for depth maps, views of it, and which of its tiles own the pixels there.
namespace trimtab::test {

/// A square of posts with its triangles as drawn, in tiles that may hide each other: all in double.
class DepthGround {
 public:
  static constexpr double kStepM = 40;
  static constexpr int kTiles = 6, kCells = 8, kPosts = kTiles * kCells + 1;
  explicit DepthGround(unsigned seed) : heights_(std::size_t{kPosts} * kPosts) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const double phase = 6 * unit(random), rough = 60 * unit(random);
    for (int y = 0; y < kPosts; ++y)
      for (int x = 0; x < kPosts; ++x)
        heights_[at(x, y)] =
            std::round(256 * (150 * std::sin(0.5 * x + phase) * std::cos(0.37 * y) + rough * unit(random))) /
            256;
  }
  Vec3 post(int x, int y) const { return {x * kStepM, y * kStepM, heights_[at(x, y)]}; }
  double heightNear(double x, double y) const {
    double highest = -1e9;
    for (int j = -1; j <= 2; ++j)
      for (int i = -1; i <= 2; ++i)
        highest = std::max(highest, post(std::clamp(static_cast<int>(x / kStepM) + i, 0, kPosts - 1),
                                         std::clamp(static_cast<int>(y / kStepM) + j, 0, kPosts - 1))
                                        .z);
    return highest;
  }
  /// Beside the border a texel's ray may pass by the ground.
  static bool mayOcclude(int tile) {
    const auto inside = [](int i) { return i > 0 && i + 1 < kTiles; };
    return inside(tile % kTiles) && inside(tile / kTiles);
  }
  using Triangle = std::array<Vec3, 3>;
  std::vector<Triangle> triangles(int tile) const {
    std::vector<Triangle> all;
    const int c = tile % kTiles * kCells, r = tile / kTiles * kCells;
    for (int y = r; y < r + kCells; ++y)
      for (int x = c; x < c + kCells; ++x) {
        all.push_back({post(x, y), post(x + 1, y), post(x + 1, y + 1)});
        all.push_back({post(x, y), post(x + 1, y + 1), post(x, y + 1)});
      }
    return all;
  }
  DepthMesh mesh(int tile) const {
    const int c = tile % kTiles * kCells, r = tile / kTiles * kCells;
    DepthMesh m;
    m.origin = {(c + 3) * kStepM, (r + 5) * kStepM, 16};
    m.setVertices(std::size_t{kCells + 1} * (kCells + 1));
    std::vector<Box> parts;
    const auto f = [](double v) { return static_cast<float>(v); };
    for (int y = 0; y <= kCells; ++y)
      for (int x = 0; x <= kCells; ++x) {
        const Vec3 p = post(c + x, r + y) - m.origin;
        m.setVertex(static_cast<std::size_t>(y * (kCells + 1) + x), f(p.x), f(p.y), f(p.z),
                    f(steepest(c + x, r + y)));
        if (x == kCells || y == kCells) continue;
        Box b = kNoBox;
        for (const int j : {0, 1})
          for (const int i : {0, 1}) {
            const Vec3 q = post(c + x + i, r + y + j) - m.origin;
            b = united(b, f(q.x), f(q.y), f(q.z));
          }
        parts.push_back(b);
      }
    m.finishVertices();
    m.setBoxes(parts);
    m.reach = f(2 * kStepM);
    m.farReach = f(4 * kStepM);
    m.farSlope = f(steepestOfAll());
    m.edge = f(1.42 * kStepM);
    return m;
  }
  static depth::Triangles indices() {
    std::vector<std::uint16_t> all;
    const auto add = [&](int x, int y) { all.push_back(static_cast<std::uint16_t>(y * (kCells + 1) + x)); };
    for (int y = 0; y < kCells; ++y)
      for (int x = 0; x < kCells; ++x) {
        for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}})
          add(x + i, y + j);
      }
    return depth::Triangles(all);
  }

 private:
  static std::size_t at(int x, int y) {
    return static_cast<std::size_t>(y) * kPosts + static_cast<std::size_t>(x);
  }
  double slopeOf(int x, int y) const {
    if (x < 0 || y < 0 || x + 1 >= kPosts || y + 1 >= kPosts) return 0;
    const double a = post(x, y).z, b = post(x + 1, y).z, c = post(x + 1, y + 1).z, d = post(x, y + 1).z;
    return std::max(std::hypot(b - a, c - b), std::hypot(d - a, c - d)) / kStepM;
  }
  double steepest(int x, int y) const {
    double most = 0;
    for (int j = y - 4; j <= y + 3; ++j)
      for (int i = x - 4; i <= x + 3; ++i) most = std::max(most, slopeOf(i, j));
    return most;
  }
  double steepestOfAll() const {
    double most = 0;
    for (int j = 0; j < kPosts; ++j)
      for (int i = 0; i < kPosts; ++i) most = std::max(most, slopeOf(i, j));
    return most;
  }
  std::vector<double> heights_;
};

/// For each pixel of the picture the nearest surface's depth, infinite where there is none, and whose it is.
struct PixelOwners {
  std::vector<double> depth;
  std::vector<int> owner;
  int width, height;
  PixelOwners(const DepthGround& ground, const EyePose& eye, const ViewShape& view)
      : depth(static_cast<std::size_t>(view.widthPx * view.heightPx),
              std::numeric_limits<double>::infinity()),
        owner(depth.size(), -1),
        width(view.widthPx),
        height(view.heightPx) {
    for (int tile = 0; tile < DepthGround::kTiles * DepthGround::kTiles; ++tile)
      for (const DepthGround::Triangle& t : ground.triangles(tile)) add(t, tile, eye, view);
  }

 private:
  void add(const DepthGround::Triangle& t, int tile, const EyePose& eye, const ViewShape& view) {
    std::array<Vec3, 3> c;
    int x0 = 0, x1 = width - 1, y0 = 0, y1 = height - 1;
    double lowX = 1e9, highX = -1e9, lowY = 1e9, highY = -1e9, nearest = 1e9;
    for (std::size_t k = 0; k < 3; ++k) {
      c[k] = eye.axes * (t[k] - eye.position);
      nearest = std::min(nearest, -c[k].z);
      const double x = c[k].x / -c[k].z, y = c[k].y / -c[k].z;
      lowX = std::min(lowX, x), highX = std::max(highX, x), lowY = std::min(lowY, y),
      highY = std::max(highY, y);
    }
    if (nearest > 0.1) {
      const auto pixel = [](double v, double from, double to, int n, int more) {
        return static_cast<int>(std::clamp(std::floor((v - from) / (to - from) * n) + more, 0.0, n - 1.0));
      };
      x0 = pixel(lowX, view.left, view.right, width, -1), x1 = pixel(highX, view.left, view.right, width, 1);
      y0 = pixel(lowY, view.bottom, view.top, height, -1),
      y1 = pixel(highY, view.bottom, view.top, height, 1);
    }
    const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const Vec3 ray{view.left + (view.right - view.left) * (x + 0.5) / width,
                       view.bottom + (view.top - view.bottom) * (y + 0.5) / height, -1};
        const double z = dot(n, c[0]) / dot(n, ray);
        if (!(z > view.nearM)) continue;
        const Vec3 p = ray * z;
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k)
          inside = inside && dot(cross(c[(k + 1) % 3] - c[k], p - c[k]), n) >= 0;
        const auto i = static_cast<std::size_t>(y * width + x);
        if (inside && z < depth[i]) depth[i] = z, owner[i] = tile;
      }
  }
};

struct DepthView {
  EyePose eye;
  ViewShape shape;
  int width, height;  ///< of the map
};
inline DepthView randomView(const DepthGround& ground, std::mt19937& random, int i) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double side = (DepthGround::kPosts - 1) * DepthGround::kStepM, x = side * (0.25 + 0.5 * unit(random)),
               y = side * (0.25 + 0.5 * unit(random));
  const Vec3 eye{x, y, ground.heightNear(x, y) + 3 + 250 * unit(random) * unit(random)};
  const double heading = 360 * unit(random),
               pitch = i % 4 == 3 ? -70 + 30 * unit(random) : -20 + 23 * unit(random),
               roll = i % 3 == 2 ? 360 * unit(random) : 0;
  DepthView v{{eye, axesOf(heading, pitch, roll)}, {}, 0, 0};
  v.shape.widthPx = 200, v.shape.heightPx = 112;
  if (i % 5 == 4) v.shape.left = -0.2, v.shape.right = 0.9, v.shape.bottom = -0.6, v.shape.top = 0.1;
  constexpr std::array<std::pair<int, int>, 6> kSizes{
      {{100, 56}, {50, 28}, {64, 48}, {200, 112}, {33, 77}, {320, 240}}};
  std::tie(v.width, v.height) = kSizes[static_cast<std::size_t>(i) % kSizes.size()];
  return v;
}

}  // namespace trimtab::test
