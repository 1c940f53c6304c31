#include "trimtab/culling/select_lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace trimtab::test {
namespace {

/// Cells of eight lights each, 4 km around the origin.
LightIndex scatteredLights() {
  LightIndex lights;
  std::mt19937 random(17);
  std::uniform_real_distribution<float> at(-4000, 4000), near(-60, 60);
  for (std::uint32_t n = 0; n < 400; ++n) {
    LightIndex::Cell cell;
    cell.origin = {static_cast<std::int32_t>(at(random) / 16), static_cast<std::int32_t>(at(random) / 16), 0};
    cell.first = 8 * n;
    cell.count = 8;
    const auto x0 = static_cast<float>(16 * cell.origin[0]), y0 = static_cast<float>(16 * cell.origin[1]);
    cell.bounds = {1e9f, 1e9f, 1e9f, -1e9f, -1e9f, -1e9f};
    Box& b = cell.bounds;
    for (int i = 0; i < 8; ++i) {
      const LightPoint p{near(random), near(random), near(random)};
      lights.points.push_back(p);
      b = {std::min(b.minX, x0 + p.x), std::min(b.minY, y0 + p.y), std::min(b.minZ, p.z),
           std::max(b.maxX, x0 + p.x), std::max(b.maxY, y0 + p.y), std::max(b.maxZ, p.z)};
    }
    lights.cells.push_back(cell);
  }
  return lights;
}

LightQuery lookingAlong(double headingRad, double sizePx) {
  LightQuery q;
  const Vec3 forward = normalized({std::sin(headingRad), std::cos(headingRad), -0.1});
  const Vec3 right = normalized(cross(forward, Vec3{0, 0, 1}));
  q.eye = {{0, 0, 200}, {{right, cross(right, forward), -forward}}};
  q.view.widthPx = 640, q.view.heightPx = 360;
  q.sizePx = sizePx;
  return q;
}

/// Whether any part of a light's disc is in the image, one light at a time.
bool reachesTheImage(const LightIndex::Cell& cell, const LightPoint& p, const LightQuery& q) {
  const Vec3 place = Vec3{16.0 * cell.origin[0] + double{p.x}, 16.0 * cell.origin[1] + double{p.y},
                          16.0 * cell.origin[2] + double{p.z}} -
                     q.eye.position;
  const Vec3 e = q.eye.axes * place;
  const ViewShape& v = q.view;
  if (-e.z < v.nearM || length(place) > q.airM) return false;
  const double x = (e.x / -e.z - v.left) / (v.right - v.left) * v.widthPx,
               y = (e.y / -e.z - v.bottom) / (v.top - v.bottom) * v.heightPx, r = q.sizePx / 2;
  return x > -r && x < v.widthPx + r && y > -r && y < v.heightPx + r;
}

TEST(SelectLights, everyLightThatReachesTheImageAndFewOthers) {
  const LightIndex lights = scatteredLights();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t needed = 0, chosen = 0, byHalfALight = 0;
  std::vector<std::uint32_t> cells;
  for (int n = 0; n < 300; ++n) {
    LightQuery q = lookingAlong(6.3 * unit(random), 1 + 15 * unit(random));
    if (n % 3 == 0) q.airM = 4000 * unit(random);
    selectLights(lights, q, cells);
    EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end()));
    chosen += cells.size();
    LightQuery ofCentres = q;
    ofCentres.sizePx = 0;
    for (std::uint32_t i = 0; i < lights.cells.size(); ++i) {
      const LightIndex::Cell& cell = lights.cells[i];
      const auto first = lights.points.begin() + cell.first;
      const auto any = [&](const LightQuery& query) {
        return std::any_of(first, first + cell.count,
                           [&](const LightPoint& p) { return reachesTheImage(cell, p, query); });
      };
      if (!any(q)) continue;
      ++needed;
      byHalfALight += !any(ofCentres);
      EXPECT_TRUE(std::binary_search(cells.begin(), cells.end(), i)) << "view " << n << ", cell " << i;
    }
  }
  EXPECT_GT(byHalfALight, 100u) << "the margin would not be tested";
  EXPECT_LT(static_cast<double>(chosen), 1.15 * static_cast<double>(needed));
}

TEST(SelectLights, ofSizeZeroAreNoneAndUnculledAreAll) {
  const LightIndex lights = scatteredLights();
  std::vector<std::uint32_t> cells{1, 2, 3};
  LightQuery q = lookingAlong(1, 0);
  for (const double size : {0.0, -1.0, std::nan("")}) {
    q.sizePx = size;
    q.cull = true;
    selectLights(lights, q, cells);
    EXPECT_TRUE(cells.empty());
    q.cull = false;
    selectLights(lights, q, cells);
    EXPECT_TRUE(cells.empty());
  }
  q.sizePx = 3;
  selectLights(lights, q, cells);
  EXPECT_EQ(cells.size(), lights.cells.size());
  selectLights({}, q, cells);
  EXPECT_TRUE(cells.empty());
}

}  // namespace
}  // namespace trimtab::test
