#include <random>

#include "scene_test.h"
#include "trimtab/frame/frame_request.h"

namespace trimtab {
namespace {

struct Screen {
  double x, y;
};

/// How far a point is from a triangle's edges, pixels; positive inside.
double insideBy(const std::array<Screen, 3>& t, Screen p) {
  double least = 1e30;
  const auto cross = [](Screen a, Screen b, Screen c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  const double sign = cross(t[0], t[1], t[2]) < 0 ? -1 : 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const Screen a = t[i], b = t[(i + 1) % 3];
    least = std::min(least, sign * cross(a, b, p) / std::hypot(b.x - a.x, b.y - a.y));
  }
  return least;
}

class Precision : public test::SceneTest {
 protected:
  static constexpr int kSpikeColumn = 61, kSpikeRow = 63;

  /// A plain with posts 10 m apart and one spike of 20 m on it.
  void usePlain(Degrees frameOffset) {
    plain = std::make_shared<const test::SyntheticTerrain>(
        4, 0.0001, GeodeticPosition{Degrees{35}, Degrees{127}, Metres{0}},
        [](int c, int r) { return c == kSpikeColumn && r == kSpikeRow ? 20.0 : 0.0; }, frameOffset);
    use(plain);
  }

  /// Pixels above the horizon that are on the wrong side of the spike's outline, by more than `tolerance`
  /// pixels, against a projection in doubles.
  std::size_t wrong(const FrameRequest& r, double tolerance, std::size_t& near) {
    const auto rgba = picture(r);
    const LocalFrame& frame = database->index().frame;
    const Vec3 eye = frame.fromGeodetic(r.eye);
    const Mat3 axes = eyeAxes(frame, r.eye, r.attitude);
    const auto project = [&](Vec3 p) {
      const Vec3 e = axes * (p - eye);
      const ViewShape& v = r.view;
      return Screen{(e.x / -e.z - v.left) / (v.right - v.left) * v.widthPx,
                    (e.y / -e.z - v.bottom) / (v.top - v.bottom) * v.heightPx};
    };
    // A post that is odd both ways is the middle of a fan of eight.
    std::vector<std::array<Screen, 3>> fan;
    const int ring[8][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    const auto corner = [&](int i) {
      return project(plain->post(kSpikeColumn + ring[i % 8][0], kSpikeRow + ring[i % 8][1]));
    };
    for (int i = 0; i < 8; ++i)
      fan.push_back({project(plain->post(kSpikeColumn, kSpikeRow)), corner(i), corner(i + 1)});

    std::size_t bad = 0;
    const int horizon = r.view.heightPx / 2 + 10;  // the eye is level and low
    for (int y = horizon; y < r.view.heightPx; ++y)
      for (int x = 0; x < r.view.widthPx; ++x) {
        double inside = -1e30;
        for (const auto& triangle : fan) inside = std::max(inside, insideBy(triangle, {x + 0.5, y + 0.5}));
        const std::size_t i = (static_cast<std::size_t>(y) * static_cast<std::size_t>(r.view.widthPx) +
                               static_cast<std::size_t>(x)) *
                              4;
        const bool drawn = !(rgba[i] == 255 && rgba[i + 1] == 0 && rgba[i + 2] == 255);
        near += std::abs(inside) < 0.5;
        if (std::abs(inside) >= tolerance && drawn != (inside > 0)) {
          // Edges between two triangles of the fan are inside it.
          if (!drawn || inside < -tolerance) ++bad;
        }
      }
    return bad;
  }

  /// A low flight past the spike in steps that are no round numbers.
  std::size_t flyPast(double tolerance) {
    const GeodeticPosition spike = database->index().frame.toGeodetic(plain->post(kSpikeColumn, kSpikeRow));
    std::size_t bad = 0, near = 0;
    std::mt19937 random(9);
    std::uniform_real_distribution<double> part(0, 1);
    for (int i = 0; i < 24; ++i) {
      const double away = 0.00018 + 0.0004 * part(random);
      auto r = request({spike.latitude - Degrees{away}, spike.longitude + Degrees{0.0001 * part(random)},
                        Metres{1 + part(random)}},
                       {Degrees{-3 + 6 * part(random)}, Degrees{0}, Degrees{0}});
      r.view.widthPx = 1280, r.view.heightPx = 720;
      r.overlays.showHoles = true;
      r.levers.drawn.errorPx = 0.01;
      bad += wrong(r, tolerance, near);
    }
    EXPECT_GT(near, 3000u) << "the outline was hardly seen";
    return bad;
  }

  std::shared_ptr<const test::SyntheticTerrain> plain;
};

TEST_F(Precision, holdsAFixedPointWithinATenthOfAPixel) {
  usePlain(Degrees{0});
  EXPECT_EQ(flyPast(0.1), 0u);
}

TEST_F(Precision, holdsItHundredKilometresFromTheTerrainsOrigin) {
  usePlain(Degrees{0.9});
  ASSERT_GT(length(plain->post(kSpikeColumn, kSpikeRow)), 100e3);
  EXPECT_EQ(flyPast(0.1), 0u);
}

}  // namespace
}  // namespace trimtab
