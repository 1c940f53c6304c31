#include "trimtab/terrain/grid/post_geometry.h"

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/LocalCartesian.hpp>

#include <cmath>

#include "tests/support.h"

namespace trimtab::terrain {
namespace {

Vec3 metres(const PostGeometry::Lattice& p) {
  return {static_cast<double>(p.x) / 256, static_cast<double>(p.y) / 256, static_cast<double>(p.z) / 256};
}

struct Case {
  const char* where;
  PostGrid posts;
};
const Case kCases[] = {
    {"Everest", {86, 27, 1.0 / 1200, 1.0 / 1200, 1201, 1201}},
    {"across the date line", {179.5, -20, 0.01, 0.01, 101, 101}},
    {"southern ice to the pole", {-10, -90, 0.1, 0.01, 201, 101}},
    {"north pole", {100, 89, 0.5, 0.01, 101, 101}},
};

TEST(PostGeometry, agreesWithGeographicLibToFiveMillimetres) {
  for (const Case& at : kCases) {
    const PostGeometry geometry(at.posts);
    const GeographicLib::LocalCartesian oracle(geometry.frame().origin().latitude.value(),
                                               geometry.frame().origin().longitude.value(), 0);
    for (std::uint32_t r = 1; r < at.posts.rows; r += 2)
      for (std::uint32_t c = 1; c < at.posts.columns; c += 6) {
        if (r + 1 == at.posts.rows) continue;  // the last row may be rounded wider
        const double h = -400 + 37.0 * (r % 240);
        double x, y, z;
        oracle.Forward(at.posts.latitude(r), at.posts.longitude(c), h, x, y, z);
        const Vec3 found = metres(geometry.lattice(r, c, h));
        ASSERT_LT(std::hypot(found.x - x, found.y - y, found.z - z), 0.005)
            << at.where << " row " << r << " column " << c;
      }
  }
}

TEST(PostGeometry, roundsNoPostFurtherThanItSays) {
  // 300 km: wider than floats in 1/256 m reach, so coarse levels' posts lie on a coarser lattice.
  const PostGrid posts{5, 45, 0.004, 0.003, 1001, 1001};
  const PostGeometry geometry(posts);
  EXPECT_GT(geometry.roundingM(), 0.0035);
  const GeographicLib::LocalCartesian oracle(geometry.frame().origin().latitude.value(),
                                             geometry.frame().origin().longitude.value(), 0);
  for (std::uint32_t r = 0; r < posts.rows; r += 8)
    for (std::uint32_t c = 0; c < posts.columns; c += 8) {
      double x, y, z;
      oracle.Forward(posts.latitude(r), posts.longitude(c), 1234.5, x, y, z);
      const Vec3 found = metres(geometry.lattice(r, c, 1234.5));
      ASSERT_LE(std::hypot(found.x - x, found.y - y, found.z - z), geometry.roundingM() + 1e-6);
    }
}

TEST(PostGeometry, normalOfLevelGroundPointsUp) {
  const PostGrid posts{86, 27, 0.01, 0.01, 101, 101};
  const PostGeometry geometry(posts);
  const GeographicLib::LocalCartesian oracle(geometry.frame().origin().latitude.value(),
                                             geometry.frame().origin().longitude.value(), 0);
  std::vector<double> m(9);
  double x, y, z;
  oracle.Forward(posts.latitude(7), posts.longitude(90), 0, x, y, z, m);
  const Vec3 up = geometry.normal(7, 90, 0, 0), rising = geometry.normal(7, 90, 1, 0);
  EXPECT_NEAR(up.x, m[2], 1e-12);
  EXPECT_NEAR(up.y, m[5], 1e-12);
  EXPECT_NEAR(up.z, m[8], 1e-12);
  // Rising to the east, the normal leans west by 45 degrees.
  EXPECT_NEAR(rising.x, (m[2] - m[0]) / std::sqrt(2.0), 1e-12);
}

TEST(PostGeometry, stepsAreArcsOfTheEllipsoid) {
  const PostGrid posts{10, 59, 0.001, 0.001, 11, 11};
  const PostGeometry geometry(posts);
  const GeographicLib::Geocentric& earth = GeographicLib::Geocentric::WGS84();
  double x0, y0, z0, x1, y1, z1;
  earth.Forward(posts.latitude(5), 10, 0, x0, y0, z0);
  earth.Forward(posts.latitude(5), 10.001, 0, x1, y1, z1);
  EXPECT_NEAR(geometry.columnM(5), std::hypot(x1 - x0, y1 - y0, z1 - z0), 1e-4);
  earth.Forward(posts.latitude(6), 10, 0, x1, y1, z1);
  EXPECT_NEAR(geometry.rowM(5), std::hypot(x1 - x0, y1 - y0, z1 - z0), 1e-3);
}

}  // namespace
}  // namespace trimtab::terrain
