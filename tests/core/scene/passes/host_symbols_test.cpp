#include <gtest/gtest.h>

#include <cmath>

#include "trimtab/preset/table.h"
#include "trimtab/scene/symbology_geometry.h"

/// Where the marks of a host's symbols lie. Their pixels are in post_passes_test.cpp.
namespace trimtab::scene {
namespace {

ViewShape view() {
  ViewShape v;
  v.widthPx = 800;
  v.heightPx = 400;
  return v;
}

HostSymbol symbol(std::uint16_t id, HostShape shape) {
  HostSymbol s;
  s.id = id;
  s.visible = true;
  s.shape = std::make_shared<const HostShape>(std::move(shape));
  return s;
}
HostShape lines(HostPrimitive primitive, std::vector<HostPoint> points) {
  HostShape shape;
  shape.primitive = primitive;
  shape.points = std::move(points);
  return shape;
}
/// From the symbol's origin one unit along u.
HostShape needle() {
  return lines(HostPrimitive::lines, {{0, 0}, {1, 0}});
}

/// Surface 0 is the image's right half, where u runs from 0 to 40 and v from 0 to 40: 10 pixels a unit.
HostSymbols onRightHalf(std::vector<HostSymbol> symbols) {
  return {{{0, 0.5F, 1, 0, 1, 0, 40, 0, 40}}, std::move(symbols)};
}

SymbologyRequest requestOf(HostSymbols symbols) {
  TuningParameters p;
  p.symbology.enabled = true;
  SymbologyRequest r{{}, symbologySetup(p), std::make_shared<const HostSymbols>(std::move(symbols))};
  for (std::size_t i = 0; i + 1 < kSymbols; ++i) r.setup.element[i].show = false;
  return r;
}
SymbologyDrawing drawn(const SymbologyRequest& r) {
  SymbologyDrawing d;
  drawSymbology(r, view(), d);
  return d;
}
SymbologyDrawing drawn(HostSymbols symbols) {
  return drawn(requestOf(std::move(symbols)));
}

void expectLine(const HostMark& m, double x0, double y0, double x1, double y1) {
  EXPECT_NEAR(m.x[0], x0, 1e-3);
  EXPECT_NEAR(m.y[0], y0, 1e-3);
  EXPECT_NEAR(m.x[1], x1, 1e-3);
  EXPECT_NEAR(m.y[1], y1, 1e-3);
}

TEST(HostSymbolMarks, followPositionRotationAndScale) {
  HostSymbol s = symbol(1, needle());
  s.u = 20;
  s.v = 10;
  s.rotationDeg = 90;
  s.scaleU = 3;
  auto d = drawn(onRightHalf({s}));
  ASSERT_EQ(d.marks.size(), 1u);
  expectLine(d.marks[0], 600, 100, 600, 130);
  EXPECT_EQ(d.marks[0].halfWidth, 0.5F) << "the thinnest line is a pixel wide";
  EXPECT_NEAR(d.box[static_cast<std::size_t>(Symbol::host)].top, 130, 1e-3);
  s.visible = false;
  EXPECT_TRUE(drawn(onRightHalf({s})).marks.empty());
}

TEST(HostSymbolMarks, hangOnTheirParents) {
  HostSymbol parent = symbol(9, needle()), child = symbol(2, needle());
  parent.u = 20;
  parent.v = 20;
  parent.rotationDeg = 90;
  parent.scaleU = parent.scaleV = 2;
  parent.rgba = {1, 2, 3, 4};
  child.attached = child.inheritsColour = true;
  child.parent = 9;
  child.u = 5;
  child.surface = 77;  // only that of the root counts
  auto d = drawn(onRightHalf({child, parent}));
  ASSERT_EQ(d.marks.size(), 2u);
  expectLine(d.marks[0], 600, 300, 600, 320);
  EXPECT_EQ(d.marks[0].rgba, parent.rgba);
  child.inheritsColour = false;
  EXPECT_EQ(drawn(onRightHalf({child, parent})).marks[0].rgba, child.rgba);
  parent.visible = false;
  EXPECT_TRUE(drawn(onRightHalf({child, parent})).marks.empty()) << "a hidden parent hides its children";
  parent.visible = true;
  parent.dutyPercent = 50;
  auto r = requestOf(onRightHalf({child, parent}));
  r.dark = {9};
  EXPECT_TRUE(drawn(r).marks.empty()) << "and so does a dark one";
  r.dark = {2};
  EXPECT_EQ(drawn(r).marks.size(), 2u) << "the parent's flash is the one that counts";
}

TEST(HostSymbolMarks, areDrawnByLayerAndThenById) {
  HostSymbol first = symbol(1, needle()), second = symbol(2, needle()), third = symbol(3, needle());
  first.layer = 200;
  first.u = 1;
  second.u = 2;
  third.u = 3;
  const auto d = drawn(onRightHalf({first, second, third}));
  ASSERT_EQ(d.marks.size(), 3u);
  EXPECT_EQ(d.marks[0].x[0], 420);
  EXPECT_EQ(d.marks[1].x[0], 430);
  EXPECT_EQ(d.marks[2].x[0], 410);
}

TEST(HostSymbolMarks, joinPointsAsThePrimitiveSays) {
  const std::vector<HostPoint> points{{1, 1}, {5, 1}, {5, 5}, {1, 5}};
  const std::size_t marks[] = {4, 2, 3, 4, 1, 2, 2};
  for (std::size_t i = 0; i < std::size(marks); ++i) {
    const auto primitive = static_cast<HostPrimitive>(i);
    const auto d = drawn(onRightHalf({symbol(1, lines(primitive, points))}));
    EXPECT_EQ(d.marks.size(), marks[i]) << i;
    for (const HostMark& m : d.marks) EXPECT_EQ(m.halfWidth == HostMark::kFilled, i >= 4) << i;
  }
}

TEST(HostSymbolMarks, areClippedToTheirSurface) {
  auto d = drawn(onRightHalf({symbol(1, lines(HostPrimitive::lines, {{-30, 20}, {90, 20}}))}));
  ASSERT_EQ(d.marks.size(), 1u);
  EXPECT_EQ(d.marks[0].x[0], 400) << "the left half is not its surface";
  EXPECT_GE(d.marks[0].x[1], 800);
  EXPECT_LE(d.marks[0].x[1], 802);
  d = drawn(onRightHalf({symbol(1, lines(HostPrimitive::triangles, {{-40, -40}, {80, -40}, {20, 90}}))}));
  EXPECT_GE(d.marks.size(), 2u);
  for (const HostMark& m : d.marks)
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(m.x[i], 399.99);
      EXPECT_LE(m.x[i], 802);
    }
}

TEST(HostSymbolMarks, ofCirclesLieOnThem) {
  HostShape shape;
  shape.kind = HostShapeKind::circles;
  shape.arcs = {{20, 20, 10, 4, 0, 360}};
  auto d = drawn(onRightHalf({symbol(1, shape)}));
  EXPECT_GE(d.marks.size(), 12u);
  for (const HostMark& m : d.marks) {
    EXPECT_NEAR(std::hypot(m.x[0] - 600, m.y[0] - 200), 100, 0.01);
    EXPECT_NEAR(std::hypot(0.5 * (m.x[0] + m.x[1]) - 600, 0.5 * (m.y[0] + m.y[1]) - 200), 100, 0.3);
  }
  shape.arcs[0].startDeg = 350;  // across the u axis
  shape.arcs[0].endDeg = 20;
  d = drawn(onRightHalf({symbol(1, shape)}));
  expectLine(
      {{d.marks.front().x[0], d.marks.back().x[1]}, {d.marks.front().y[0], d.marks.back().y[1]}, 0, {}},
      600 + 100 * std::cos(350 * M_PI / 180), 200 + 100 * std::sin(350 * M_PI / 180),
      600 + 100 * std::cos(20 * M_PI / 180), 200 + 100 * std::sin(20 * M_PI / 180));
  shape.filled = true;
  d = drawn(onRightHalf({symbol(1, shape)}));
  double area = 0;
  for (const HostMark& m : d.marks)
    area += 0.5 * std::abs((m.x[1] - m.x[0]) * (m.y[2] - m.y[0]) - (m.x[2] - m.x[0]) * (m.y[1] - m.y[0]));
  EXPECT_NEAR(area / (M_PI * (100 * 100 - 40 * 40) * 30 / 360), 1, 0.01) << "a ring's sector";
}

TEST(HostSymbolMarks, ofTextKeepToTheSideOfTheirPoint) {
  HostShape shape;
  shape.kind = HostShapeKind::text;
  shape.text = "Ab7";
  shape.fontSize = 3;
  for (std::uint8_t orientation = 0; orientation < 4; ++orientation)
    for (std::uint8_t alignment = 0; alignment < 9; ++alignment) {
      shape.orientation = orientation;
      shape.alignment = alignment;
      HostSymbol s = symbol(1, shape);
      s.u = s.v = 20;
      const SymbolBox box = drawn(onRightHalf({s})).box[static_cast<std::size_t>(Symbol::host)];
      ASSERT_FALSE(box.empty());
      const double share[] = {0, 0.5, 1};
      // Letters need not fill their cells, so that the middle may be off by some pixels.
      EXPECT_NEAR(600 - box.left, share[alignment % 3] * (box.right - box.left), 5)
          << int{orientation} << ' ' << int{alignment};
      EXPECT_NEAR(200 - box.bottom, share[2 - alignment / 3] * (box.top - box.bottom), 5)
          << int{orientation} << ' ' << int{alignment};
      EXPECT_EQ(box.top - box.bottom > box.right - box.left, orientation % 2 == 1);
    }
}

TEST(HostSymbolMarks, obeyThePreset) {
  auto r = requestOf(onRightHalf({symbol(1, needle())}));
  SymbolElement& e = r.setup.element[static_cast<std::size_t>(Symbol::host)];
  expectLine(drawn(r).marks[0], 400, 0, 410, 0);
  e.x = Ratio{0.25};
  e.y = Ratio{0.5};
  expectLine(drawn(r).marks[0], 500, 100, 510, 100);
  e.size = Ratio{0.5};
  expectLine(drawn(r).marks[0], 500, 200, 505, 200);
  e.show = false;
  EXPECT_TRUE(drawn(r).marks.empty());
  EXPECT_FALSE(quantised(r, view()).host) << "what is not shown causes no redraw";
}

TEST(HostSymbolMarks, ofHostileStoresAreBounded) {
  constexpr float kHuge = 1e6F;
  HostShape circles, text;
  circles.kind = HostShapeKind::circles;
  for (int i = 0; i < 9; ++i) circles.arcs.push_back({0, 0, kHuge / static_cast<float>(i + 1), 0, 0, 360});
  text.kind = HostShapeKind::text;
  text.fontSize = 1;
  text.text = std::string(235, '8');
  std::vector<HostSymbol> many;
  for (std::uint16_t i = 0; i < HostSymbols::kMostSymbols; ++i) {
    many.push_back(symbol(i, i % 2 == 0 ? text : circles));
    many.back().scaleU = i % 3 == 0 ? 1e4F : 0;
    many.back().scaleV = -1e4F;
    many.back().rotationDeg = i;
    many.back().attached = i > 0;
    many.back().parent = static_cast<std::uint16_t>(i - 1);
  }
  const auto chain = drawn(onRightHalf(many));
  EXPECT_GE(chain.hostSymbolsLeftOut, HostSymbols::kMostSymbols - HostSymbols::kMostAncestors - 1);
  for (const HostMark& m : chain.marks)
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(m.x[i]) && std::isfinite(m.y[i]));
  for (HostSymbol& s : many) {
    s.attached = false;
    s.scaleU = s.scaleV = 0.1F;
    s.u = 10;
    s.v = 20;
  }
  const auto crowd = drawn(onRightHalf(many));
  EXPECT_LE(crowd.marks.size(), SymbologyDrawing::kMostMarks);
  EXPECT_GT(crowd.hostSymbolsLeftOut, 0u);
  many[0].attached = true;  // a circle of parents, which no decoder lets through
  many[0].parent = 0;
  EXPECT_EQ(drawn(onRightHalf({many[0]})).hostSymbolsLeftOut, 1u);
}

}  // namespace
}  // namespace trimtab::scene
