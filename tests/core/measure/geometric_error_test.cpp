#include "trimtab/measure/geometric_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace trimtab {
namespace {

constexpr float kSky = std::numeric_limits<float>::infinity();

ViewShape viewOf(int width, int height) {
  ViewShape view;
  view.widthPx = width;
  view.heightPx = height;
  view.bottom = view.left * height / width;
  view.top = view.right * height / width;
  return view;
}

/// Depth along the view's axis of what a direction (tangents) shows.
using Scene = std::function<double(double across, double up)>;

std::vector<float> pictureOf(const ViewShape& v, const Scene& scene) {
  std::vector<float> distances;
  for (int y = 0; y < v.heightPx; ++y)
    for (int x = 0; x < v.widthPx; ++x) {
      const double a = v.left + (v.right - v.left) * (x + 0.5) / v.widthPx,
                   b = v.bottom + (v.top - v.bottom) * (y + 0.5) / v.heightPx;
      distances.push_back(static_cast<float>(scene(a, b) * std::sqrt(1 + a * a + b * b)));
    }
  return distances;
}

/// A wall that faces the eye up to a height in the picture, and what is behind it.
Scene wall(double depth, double upTo, double behind) {
  return [=](double, double up) { return up < upTo ? depth : behind; };
}

/// Level ground so far below the eye.
Scene ground(double below) {
  return [=](double, double up) { return up < 0 ? below / -up : double{kSky}; };
}

/// The definition word for word, in doubles: every line within the window, for every pixel.
double slowly(const std::vector<float>& own, const std::vector<float>& other, const ViewShape& v, int window,
              double& mean) {
  struct Point {
    double x, y, z;
  };
  const double dx = (v.right - v.left) / v.widthPx, dy = (v.top - v.bottom) / v.heightPx,
               pixel = std::min(dx, dy);
  const auto at = [&](const std::vector<float>& distances, int x, int y) {
    const double a = v.left + dx * (x + 0.5), b = v.bottom + dy * (y + 0.5);
    double d = double{distances[static_cast<std::size_t>(y * v.widthPx + x)]};
    if (!(d > 0 && d < 1e12)) d = 1e12;
    const double z = d == 1e12 ? d : d / std::sqrt(1 + a * a + b * b);
    return Point{a * z, b * z, z};
  };
  const auto toLine = [](const Point& p, const Point& q, const Point& r) {
    const double ux = q.x - p.x, uy = q.y - p.y, uz = q.z - p.z, ex = r.x - q.x, ey = r.y - q.y,
                 ez = r.z - q.z;
    const double s = std::clamp(-(ux * ex + uy * ey + uz * ez) / (ex * ex + ey * ey + ez * ez), 0.0, 1.0);
    return std::sqrt(std::pow(ux + s * ex, 2) + std::pow(uy + s * ey, 2) + std::pow(uz + s * ez, 2));
  };
  double most = 0, sum = 0;
  for (int y = 0; y < v.heightPx; ++y)
    for (int x = 0; x < v.widthPx; ++x) {
      const Point p = at(own, x, y);
      double least = std::min({double(window), (std::min(x, v.widthPx - 1 - x) + 0.5) * dx / pixel,
                               (std::min(y, v.heightPx - 1 - y) + 0.5) * dy / pixel});
      for (int j = std::max(0, y - window); j <= std::min(v.heightPx - 1, y + window); ++j)
        for (int i = std::max(0, x - window); i <= std::min(v.widthPx - 1, x + window); ++i) {
          const Point q = at(other, i, j);
          if (p.z >= 1e11) {
            if (q.z >= 1e11) least = std::min(least, std::hypot((i - x) * dx / pixel, (j - y) * dy / pixel));
            continue;
          }
          for (const auto [nextX, nextY] : {std::array{i + 1, j}, std::array{i, j + 1}}) {
            if (nextX > std::min(v.widthPx - 1, x + window) || nextY > std::min(v.heightPx - 1, y + window))
              continue;
            const Point r = at(other, nextX, nextY);
            least = std::min(least, (q.z < r.z ? toLine(p, q, r) : toLine(p, r, q)) / p.z / pixel);
          }
        }
      most = std::max(most, least);
      sum += least;
    }
  mean = sum / (v.widthPx * v.heightPx);
  return most;
}

TEST(GeometricError, isNothingForEqualPictures) {
  const ViewShape view = viewOf(64, 48);
  const auto picture = pictureOf(view, ground(100));
  const GeometricError error = geometricError(picture, picture, view);
  EXPECT_EQ(error.maxPx, 0);
  EXPECT_EQ(error.meanPx, 0);
}

TEST(GeometricError, ofALoweredWallIsThePixelsItLost) {
  const ViewShape view = viewOf(200, 120);
  const double pixel = (view.right - view.left) / view.widthPx;
  for (const double behind : {double{kSky}, 20000.0})
    for (const int lower : {1, 3, 9}) {
      const auto before = pictureOf(view, wall(2000, 0, behind)),
                 after = pictureOf(view, wall(2000, -lower * pixel, behind));
      const GeometricError error = geometricError(before, after, view);
      EXPECT_NEAR(error.maxPx, lower, 0.02 * lower) << behind;
      // The rows that differ err by 1, 2, .. pixels, as seen from one side or the other.
      EXPECT_NEAR(error.meanPx, lower * (lower + 1) / 2.0 / view.heightPx, 0.02 * lower) << behind;
      EXPECT_EQ(geometricError(after, before, view).maxPx, error.maxPx) << "which is which does not matter";
    }
}

TEST(GeometricError, ofGroundAtAGrazingAngleIsItsHeightAndNotItsDepth) {
  const ViewShape view = viewOf(320, 180);
  const double pixel = (view.right - view.left) / view.widthPx;
  // Half a metre lower, 100 m below: the horizon's rows differ by kilometres of depth.
  const GeometricError error =
      geometricError(pictureOf(view, ground(100)), pictureOf(view, ground(100.5)), view);
  const double steepest = -view.bottom - 0.5 * pixel;
  EXPECT_GT(error.maxPx, 0.5 * steepest / 100 / pixel - 0.01);
  EXPECT_LE(error.maxPx, 0.5) << "at the lower edge, where the nearest point lies outside";
  double mean = 0;
  for (int y = 0; y < view.heightPx / 2; ++y)
    mean += 0.5 * -(view.bottom + (y + 0.5) * pixel) / 100 / pixel / view.heightPx;
  EXPECT_NEAR(error.meanPx, mean, 0.02 * mean);
}

TEST(GeometricError, ofAWallThatCameNearerIsWhatItsDepthSpans) {
  const ViewShape view = viewOf(200, 120);
  const double pixel = (view.right - view.left) / view.widthPx;
  const auto far = pictureOf(view, wall(1000, 1, 1)),
             near = pictureOf(view, wall(1000 * (1 - 4 * pixel), 1, 1));
  const GeometricError error = geometricError(far, near, view);
  // From the nearer one a pixel spans less.
  const double expected = 4 / (1 - 4 * pixel);
  EXPECT_GT(error.maxPx, expected - 0.01);
  EXPECT_LT(error.maxPx, std::hypot(expected, 0.5) + 0.01);
}

TEST(GeometricError, saturatesAtTheWindowAndAtTheEdge) {
  const ViewShape view = viewOf(200, 120);
  const double pixel = (view.right - view.left) / view.widthPx;
  const auto before = pictureOf(view, wall(2000, 20 * pixel, kSky)),
             after = pictureOf(view, wall(2000, 0, kSky));
  EXPECT_NEAR(geometricError(before, after, view, 32).maxPx, 20, 0.4);
  EXPECT_EQ(geometricError(before, after, view, 8).maxPx, 8);
  // Ground against sky: nowhere to be found, but near the edge it might be outside.
  const auto sky = pictureOf(view, wall(1, -9, kSky)), all = pictureOf(view, wall(500, 9, kSky));
  const GeometricError error = geometricError(sky, all, view, 16);
  EXPECT_EQ(error.maxPx, 16);
  EXPECT_LT(error.meanPx, 16);
  EXPECT_GT(error.meanPx, 12);
}

TEST(GeometricError, takesAnyNumbers) {
  const ViewShape view = viewOf(64, 48);
  constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
  const auto picture = pictureOf(view, ground(100));
  const auto clean = geometricError(picture, picture, view);
  EXPECT_EQ(clean.maxPx, 0);
  for (const float odd : {kNanF, -5.0f, 0.0f, kSky, -kSky}) {
    auto spoilt = picture;
    spoilt[10 * 64 + 30] = odd;  // of ground: as if nothing were there
    for (const GeometricError& error :
         {geometricError(picture, spoilt, view), geometricError(spoilt, picture, view)}) {
      EXPECT_GT(error.maxPx, 0.1) << odd;
      EXPECT_TRUE(std::isfinite(error.meanPx)) << odd;
    }
  }
  for (const float odd : {1e-30f, 1e-3f, 1e11f, 3e38f}) {
    auto spoilt = picture;
    spoilt[10 * 64 + 30] = odd;
    const GeometricError error = geometricError(picture, spoilt, view);
    EXPECT_TRUE(std::isfinite(error.maxPx) && error.maxPx <= 32 && std::isfinite(error.meanPx)) << odd;
  }
}

TEST(GeometricError, isNoNumberWithoutPictures) {
  const ViewShape view = viewOf(64, 48);
  const auto picture = pictureOf(view, ground(100));
  const std::span<const float> all(picture);
  const auto none = [](const GeometricError& e) { return std::isnan(e.maxPx) && std::isnan(e.meanPx); };
  EXPECT_TRUE(none(geometricError(all, all.first(100), view)));
  EXPECT_TRUE(none(geometricError(all.first(100), all, view)));
  EXPECT_TRUE(none(geometricError({}, {}, view)));
  EXPECT_TRUE(none(geometricError({}, {}, viewOf(0, 0))));
  EXPECT_TRUE(none(geometricError(all, all, view, 0)));
  ViewShape folded = view;
  std::swap(folded.left, folded.right);
  EXPECT_TRUE(none(geometricError(all, all, folded)));
  const ViewShape one = viewOf(1, 1);
  EXPECT_EQ(geometricError(all.first(1), all.first(1), one).maxPx, 0);
  EXPECT_LE(geometricError(all.first(1), all.last(1), one).maxPx, 1);
}

/// Hills before hills before sky, by sums of waves; the same for the same seed.
Scene hills(unsigned seed, double lower) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<std::array<double, 3>> layers;
  for (int i = 0; i < 4; ++i)
    layers.push_back({0.15 * unit(random), 6 * unit(random), 5 + 25 * unit(random)});
  return [=](double across, double up) {
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const auto& [height, phase, wave] = layers[i];
      const double depth = 300 * std::pow(4.0, double(i));
      const double top = height * std::sin(across * wave + phase) - 0.15 + 0.07 * double(i) - lower;
      if (up < top) return depth * (1 + 2 * (top - up) * std::cos(across * wave) * 0.4);
    }
    return double{kSky};
  };
}

TEST(GeometricError, agreesWithTheDefinitionTriedOutInFull) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    ViewShape view = viewOf(72, 44);
    if (seed % 3 == 1) view.left = -0.2, view.right = 0.9;  // pixels that are no squares
    if (seed % 4 == 3) view.left *= 3, view.right *= 3, view.bottom *= 3, view.top *= 3;
    const double lower = 0.003 * seed;
    const auto a = pictureOf(view, hills(seed, 0)), b = pictureOf(view, hills(seed, lower));
    double there = 0, back = 0;
    const int window = 6 + static_cast<int>(seed) % 3;
    const double most = std::max(slowly(a, b, view, window, there), slowly(b, a, view, window, back));
    const GeometricError error = geometricError(a, b, view, window);
    EXPECT_NEAR(error.maxPx, most, 1e-3) << seed;
    EXPECT_NEAR(error.meanPx, std::max(there, back), 1e-4) << seed;
  }
}

}  // namespace
}  // namespace trimtab
