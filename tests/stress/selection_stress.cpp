#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "quad.h"
#include "table.h"
#include "tests/core/culling/random_index.h"
#include "trimtab/culling/box_arrays.h"
#include "trimtab/culling/box_distance.h"
#include "trimtab/culling/depth_pyramid.h"
#include "trimtab/culling/frustum.h"
#include "trimtab/culling/select.h"
#include "trimtab/culling/select_static.h"

namespace trimtab::stress {
namespace {

class ViewDice {
 public:
  explicit ViewDice(std::uint64_t seed) : random_(seed) {}
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  double signedUnit() { return 2 * unit() - 1; }
  /// From a millimetre to 10,000 km, evenly by magnitude.
  double metres(double low = 1e-3, double high = 1e7) { return low * std::pow(high / low, unit()); }
  bool one(double chance) { return unit() < chance; }

  Mat3 axes() {
    const Attitude a{Degrees{360 * unit()}, Degrees{one(0.1) ? 90 : 90 * signedUnit()},
                     Degrees{180 * signedUnit()}};
    return eyeAxes(LocalFrame(), GeodeticPosition{}, a);
  }
  ViewShape view() {
    const auto tangent = [this] { return std::tan((0.5 + 84.5 * unit()) * 0.017453292519943295); };
    ViewShape v;
    v.left = -tangent(), v.right = tangent(), v.bottom = -tangent(), v.top = tangent();
    if (one(0.2)) v.left = 0.5 * v.right;  // a host's window off the axis
    v.nearM = metres(1e-3, 1000);
    v.widthPx = 16 + static_cast<int>(2000 * unit()), v.heightPx = 16 + static_cast<int>(1200 * unit());
    return v;
  }
  EyePose eye() {
    const double far = one(0.5) ? 1e6 : 1;
    return {{far * signedUnit(), far * signedUnit(), 0.1 * far * signedUnit()}, axes()};
  }

 private:
  std::mt19937_64 random_;
};

/// The float below or above.
float outward(Quad x, float side) {
  float f = static_cast<float>(x);
  if (side < 0 ? Quad{f} > x : Quad{f} < x)
    f = std::nextafter(f, side * std::numeric_limits<float>::infinity());
  return f;
}

/// A box that a point touches: at a corner, an edge, a face or inside.
Box boxAt(Quad3 p, ViewDice& dice, double size) {
  Box b;
  const auto side = [&](Quad x, float& low, float& high) {
    const double kind = dice.unit();
    const Quad below = kind < 0.4 ? 0 : dice.unit() * size, above = kind > 0.6 ? 0 : dice.unit() * size;
    low = outward(x - below, -1), high = outward(x + above, 1);
  };
  side(p.x, b.minX, b.maxX);
  side(p.y, b.minY, b.maxY);
  side(p.z, b.minZ, b.maxZ);
  return b;
}

Quad distanceTwin(const Box& b, Vec3 p) {
  const auto beyond = [](float low, float high, double x) {
    return std::max({Quad{low} - x, Quad{0}, Quad{x} - high});
  };
  const Quad3 d{beyond(b.minX, b.maxX, p.x), beyond(b.minY, b.maxY, p.y), beyond(b.minZ, b.maxZ, p.z)};
  return length(d);
}

/// A point of the picture at a depth: in it, or exactly on its border.
Quad3 inPicture(const EyePose& eye, const ViewShape& v, ViewDice& dice, Quad depth) {
  const auto place = [&dice](double low, double high) -> Quad {
    const double kind = dice.unit();
    if (kind < 0.3) return low;
    if (kind < 0.6) return high;
    return low + (Quad{high} - low) * dice.unit();
  };
  const Quad3 right = quad(eye.axes.row[0]), up = quad(eye.axes.row[1]), back = quad(eye.axes.row[2]);
  return quad(eye.position) + right * (place(v.left, v.right) * depth) +
         up * (place(v.bottom, v.top) * depth) - back * depth;
}

TEST(SelectionStress, theFrustumNeverDropsWhatIsInThePicture) {
  ViewDice dice(21);
  Case inside("selection", "frustum: a box that holds a vertex seen in the picture", 0, "dropped",
              "conservative: a box may be dropped only when no point of it can show");
  Case outside("selection", "frustum: a small box well outside", 0, "kept",
               "a degree outside any side the test must see it, or it tests nothing");
  Case blocks("selection", "frustum: 64 boxes at a time, at every instruction set", 0, "differences",
              "the same set to the box, so what holds of one holds of all");
  BoxArrays boxes;
  boxes.resize(BoxArrays::kBlock);
  for (std::size_t i = 0; i < samples(5000); ++i) {
    const EyePose eye = dice.eye();
    const ViewShape v = dice.view();
    const Frustum frustum(eye, v);
    for (std::size_t k = 0; k < BoxArrays::kBlock; ++k) {
      const double depth = v.nearM * (dice.one(0.2) ? 1 : dice.metres(1, 1e7 / v.nearM));
      // A vertex is drawn from floats relative to the eye: seen there, it lies up to 1e-6 of its distance
      // off.
      const Quad3 seen = inPicture(eye, v, dice, depth),
                  aside{dice.signedUnit(), dice.signedUnit(), dice.signedUnit()};
      const Quad moved = 0.99e-6 * length(seen - quad(eye.position)) / length(aside);
      const Box box = boxAt(seen + aside * moved, dice, dice.one(0.5) ? 0 : dice.metres(1e-3, 1e5));
      inside.require(frustum.mayShow(box),
                     [&] { return "depth " + digits(depth) + ", near " + digits(v.nearM); });
      // To the left of the left side by more than the floats of the box and the test's margin may hide.
      const double far = 1e5;
      const Vec3 off =
          eye.position + (eye.axes.row[0] * (v.left - 0.02 * (1 + v.left * v.left)) - eye.axes.row[2]) * far;
      const auto point = [](double x) { return static_cast<float>(x); };
      const Box speck{point(off.x), point(off.y), point(off.z), point(off.x), point(off.y), point(off.z)};
      outside.require(!frustum.mayShow(speck));
      boxes.set(k, dice.one(0.5) ? box : dice.one(0.5) ? speck : boxAt(quad(off), dice, dice.metres(1, far)));
    }
    for (const SimdLevel level : {SimdLevel::portable, SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > simdLevel()) break;
      const std::uint64_t bits = BlockTest(boxes, frustum, level)(0);
      for (std::size_t k = 0; k < BoxArrays::kBlock; ++k)
        blocks.require(((bits >> k) & 1) == (frustum.mayShow(boxes[k]) ? 1u : 0u));
    }
  }
}

TEST(SelectionStress, distancesToBoxesHold) {
  ViewDice dice(22);
  Case box("selection", "squared distance to a box, relative", 5 * kU, "",
           "a difference rounds once and counts twice, its square once, two sums of positive terms");
  Case beyond("selection", "beyond the far distance", 0, "violations",
              "never beyond when the exact nearest point is within; surely beyond 1e-5 farther");
  for (std::size_t i = 0; i < samples(300000); ++i) {
    const Vec3 eye{dice.metres() * dice.signedUnit(), dice.metres() * dice.signedUnit(),
                   dice.metres() * dice.signedUnit()};
    const Quad3 near =
        quad(eye) + Quad3{dice.signedUnit(), dice.signedUnit(), dice.signedUnit()} * dice.metres();
    const Box b = boxAt(near, dice, dice.metres());
    const Quad exact = distanceTwin(b, eye);
    box.see(relative(distanceSquared(b, eye), exact * exact));
    const double far = toDouble(exact);
    beyond.require(exact > Quad{far} || !isBeyond(b, eye, far));
    beyond.require(!isBeyond(b, eye, stepped(far, 1)));
    if (far > 1) beyond.require(isBeyond(b, eye, far * (1 - 1e-5) - 2e-3));
    beyond.require(!isBeyond(b, eye, std::numeric_limits<double>::infinity()) &&
                   !isBeyond(b, eye, std::nan("")) && !isBeyond(b, {std::nan(""), 0, 0}, far));
  }
}

/// A root and its four children, all in one box.
TerrainIndex oneSplit(const Box& box, float error) {
  static const TerrainIndex index = test::randomIndex(2, 1);
  TerrainIndex scaled = index;
  for (Box& b : scaled.bounds) b = box;
  for (float& e : scaled.errorM) e = 0;
  scaled.errorM.back() = error;
  return scaled;
}

TEST(SelectionStress, levelsSplitWhereTheirErrorIsTooLarge) {
  ViewDice dice(23);
  Case tie("selection", "level split: distance from the tie at which it differs, relative", 7 * kU, "",
           "thirteen roundings of squares, by half for the distance");
  LevelCut cut;
  for (std::size_t i = 0; i < samples(300000); ++i) {
    const double pixels = 0.05 * std::pow(5120, dice.unit()), scale = 0.05 * std::pow(2000, dice.unit());
    const double perRadian = 100 * std::pow(1000, dice.unit());
    const auto error = static_cast<float>(dice.metres(1e-3, 1e4));
    // An eye beside a box, at the distance where the error spans the allowed pixels, give or take an ulp.
    const Quad limit = Quad{error} * perRadian / (Quad{pixels} * scale);
    const auto size = static_cast<float>(dice.metres());
    const Box box{-size, -size, -size, 0, 0, 0};
    const double away = stepped(toDouble(limit), static_cast<int>(6 * dice.signedUnit()));
    const Vec3 eye = dice.one(0.5) ? Vec3{away, -size * dice.unit(), 0}
                                   : Vec3{away * 0.6, away * 0.8, -size * dice.unit()};
    const Quad exact = distanceTwin(box, eye);
    const TerrainIndex index = oneSplit(box, error);
    selectLevels(index, eye, {pixels, scale, perRadian}, cut);
    const bool split = cut.tiles.size() == 4, wanted = exact < limit;
    tie.see(split == wanted ? 0 : toDouble(fabsq(exact / limit - 1)), [&] { return digits(away); });
  }
}

TEST(SelectionStress, staticNodesSplitWhereTheViewerIsTooNear) {
  ViewDice dice(24);
  Case tie("selection", "static node: distance from the tie at which it differs, relative", 7 * kU, "",
           "thirteen roundings of squares, by half for the distance");
  Case broken("selection", "cuts by an eye that is no number", 0, "violations",
              "roots alone: select.h and select_static.h");
  StaticLodIndex index;
  index.roots = {0};
  for (int i = 0; i < 3; ++i) index.nodes.push_back({});
  index.nodes[0].children = {1, 2};
  LevelCut cut;
  LevelCut levels;
  for (std::size_t i = 0; i < samples(300000); ++i) {
    StaticLodParameters p;
    p.rule = dice.one(0.5) ? StaticDistanceRule::picture : StaticDistanceRule::factor;
    p.errorPx = Pixels{0.05 * std::pow(5120, dice.unit())};
    p.distancePerError = Ratio{dice.metres(1, 1e5)};
    const double scale = 0.05 * std::pow(2000, dice.unit()), perRadian = 100 * std::pow(1000, dice.unit());
    const auto error = static_cast<float>(dice.metres(1e-3, 1e4));
    const Quad perError = p.rule == StaticDistanceRule::picture ? Quad{perRadian} / p.errorPx.value()
                                                                : Quad{p.distancePerError.value()};
    const Quad limit = Quad{error} * perError / scale;
    const auto size = static_cast<float>(dice.metres());
    const Box box{-size, -size, -size, 0, 0, 0};
    index.bounds.assign(3, box);
    const double away = stepped(toDouble(limit), static_cast<int>(6 * dice.signedUnit()));
    const Vec3 eye = dice.one(0.5) ? Vec3{away, -size * dice.unit(), 0}
                                   : Vec3{away * 0.6, away * 0.8, -size * dice.unit()};
    const std::vector<float> errors{error, 0, 0};
    selectStatic(index, errors, {staticLodDistancePerError(p, scale, perRadian)}, eye, cut);
    const Quad exact = distanceTwin(box, eye);
    const bool split = cut.tiles.size() == 2, wanted = exact < limit;
    tie.see(split == wanted ? 0 : toDouble(fabsq(exact / limit - 1)), [&] { return digits(away); });
    if (i % 1000 != 0) continue;
    const Vec3 nowhere{std::nan(""), 0, 0};
    selectStatic(index, errors, {1000}, nowhere, cut);
    selectLevels(oneSplit(box, error), nowhere, {2, 1, 1000}, levels);
    broken.require(*cut.nodes == std::vector<std::uint32_t>{0} && levels.tiles.size() == 1);
  }
}

TEST(SelectionStress, theDepthMapHidesOnlyWhatIsBehindIt) {
  ViewDice dice(25);
  Case hidden("selection", "depth map: a box called hidden that exact arithmetic sees", 0, "violations",
              "conservative: each texel that the exact projection touches must be nearer than the box's "
              "nearest corner");
  Case seen("selection", "depth map: boxes well behind a wall", 0, "kept",
            "ten times farther than a wall over all the picture it must hide, or it tests nothing");
  for (std::size_t i = 0; i < samples(40000); ++i) {
    const EyePose eye = dice.eye();
    ViewShape v = dice.view();
    v.left = -v.right;
    const int width = 1 + static_cast<int>(24 * dice.unit()), height = 1 + static_cast<int>(24 * dice.unit());
    const double wall = v.nearM * dice.metres(2, 1e6);
    std::vector<float> depths(static_cast<std::size_t>(width * height));
    // A wall with a few holes.
    for (float& d : depths)
      d = dice.one(0.02) ? 0 : static_cast<float>(v.nearM / wall * (1 + 0.01 * dice.unit()));
    DepthPyramid pyramid;
    pyramid.build(depths, width, height, width, height);
    const double depth = wall * (dice.one(0.5) ? 1 + 2e-4 * dice.unit() : dice.metres(1, 10));
    const Box box = boxAt(inPicture(eye, v, dice, depth), dice, depth * 0.2 * dice.unit());
    Quad low[2] = {1e30, 1e30}, high[2] = {-1e30, -1e30}, nearest = 1e30;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const Quad3 p = Quad3{corner & 1u ? box.maxX : box.minX, corner & 2u ? box.maxY : box.minY,
                            corner & 4u ? box.maxZ : box.minZ} -
                      quad(eye.position);
      const Quad z = -dot(quad(eye.axes.row[2]), p);
      const Quad at[2] = {dot(quad(eye.axes.row[0]), p) / z, dot(quad(eye.axes.row[1]), p) / z};
      nearest = std::min(nearest, z);
      for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    }
    const auto texel = [](Quad t, double from, double to, int count) {
      return static_cast<int>(std::clamp<Quad>(floorq((t - from) / (Quad{to} - from) * count), 0, count - 1));
    };
    bool covered = nearest > v.nearM;
    for (int y = texel(low[1], v.bottom, v.top, height);
         covered && y <= texel(high[1], v.bottom, v.top, height); ++y)
      for (int x = texel(low[0], v.left, v.right, width); x <= texel(high[0], v.left, v.right, width); ++x)
        covered &= Quad{depths[static_cast<std::size_t>(y * width + x)]} > v.nearM / nearest;
    hidden.require(covered || !pyramid.isHidden(box, eye, v),
                   [&] { return "depth " + digits(depth) + " behind " + digits(wall); });

    std::fill(depths.begin(), depths.end(), static_cast<float>(v.nearM / wall));
    pyramid.build(depths, width, height, width, height);
    const Box behind = boxAt(inPicture(eye, v, dice, 10 * wall), dice, wall * 0.1);
    // Nearer than that the floats of a box a thousand kilometres from the origin reach the eye.
    if (wall > 10) seen.require(pyramid.isHidden(behind, eye, v));
  }
}

TEST(SelectionStress, viewsHaveTheTangentsOfTheirAngles) {
  ViewDice dice(26);
  Case tangent(
      "projection", "tangents of half-angles up to 89 degrees, relative", (2 * 89.1 + 2) * kU, "",
      "two roundings of the angle count x / (sin x cos x) = 89 times at 89 degrees; the tangent's own two");
  Case ignored("projection", "host views that make no picture", 0, "violations",
               "NaN, infinity, crossed or beyond 89 degrees: the preset's view");
  ViewParameters p;
  p.source = ViewSource::host;
  const auto exact = [](double degrees) { return tanq(radians(degrees)); };
  for (std::size_t i = 0; i < samples(100000); ++i) {
    HostView host;
    host.left = Degrees{-89 * dice.unit()},
    host.right = Degrees{i % 3 == 0 ? 89 : 89 * dice.unit() * dice.unit() + 1e-9};
    host.bottom = Degrees{-dice.metres(1e-12, 89)}, host.top = Degrees{dice.metres(1e-12, 89)};
    host.nearDistance = Metres{dice.metres(1e-6, 1e6)};
    const ViewShape v = viewShape(p, 100, 100, host);
    tangent.see(relative(v.left, exact(host.left->value())));
    tangent.see(relative(v.right, exact(host.right->value())));
    tangent.see(relative(v.bottom, exact(host.bottom->value())));
    tangent.see(relative(v.top, exact(host.top->value())));
    ignored.require(v.nearM == host.nearDistance->value());
  }
  const ViewShape preset = viewShape(p, 100, 100, std::nullopt);
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 89.1, -89.1, 1e308}) {
    HostView across, upwards, near;
    across.left = Degrees{bad}, across.right = Degrees{std::min(bad, 10.0)};
    upwards.bottom = Degrees{10}, upwards.top = Degrees{std::isnan(bad) ? bad : -std::abs(bad)};
    near.nearDistance = Metres{bad};
    ignored.require(viewShape(p, 100, 100, across) == preset);
    ignored.require(viewShape(p, 100, 100, upwards) == preset);
    ignored.require((bad > 0 && bad < HUGE_VAL) || viewShape(p, 100, 100, near) == preset);
  }
}

}  // namespace
}  // namespace trimtab::stress
