// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/policy/term_edit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "views/policy/policy_draft.h"

namespace trimtab::views {
namespace {

constexpr Range kView{0, 1000};

PolicyTerm term(const std::string& shape) {
  auto read = readShape(shape, "test");
  EXPECT_TRUE(read) << toString(read.findings());
  PolicyTerm made = read ? *read : PolicyTerm{};
  made.signal = Signal::speed;
  made.name = "term";
  return made;
}

const char* const kShapes[] = {"points 100 0 300 1 500 0.25",
                               "triangle 100 300 500",
                               "trapezoid 100 200 300 500",
                               "trapezoid -inf 200 300 500",
                               "trapezoid 100 200 300 inf",
                               "ramp 200 400",
                               "ramp 400 200",
                               "gaussian 300 100",
                               "bell 300 100 2",
                               "sigmoid 300 0.02",
                               "sigmoid 300 -0.02"};

TEST(TermEdit, pointsLieOnTheCurveOrAtItsFeet) {
  for (const char* shape : kShapes) {
    const PolicyTerm t = term(shape);
    const std::vector<EditPoint> handles = handlesOf(t, kView);
    ASSERT_GE(handles.size(), 2u) << shape;
    for (const EditPoint& handle : handles) {
      EXPECT_NEAR(membershipOf(t, handle.x), handle.y, 1e-6) << shape << ": " << handle.name.toStdString();
      EXPECT_FALSE(handle.name.isEmpty());
      EXPECT_TRUE(handle.movesX || handle.movesY);
    }
  }
}

TEST(TermEdit, aMovedPointIsWhereItWasMovedTo) {
  for (const char* shape : kShapes) {
    const PolicyTerm t = term(shape);
    const std::vector<EditPoint> handles = handlesOf(t, kView);
    for (std::size_t i = 0; i < handles.size(); ++i) {
      const double x = handles[i].x + 20, y = std::clamp(handles[i].y - 0.1, 0.05, 0.95);
      const PolicyTerm moved = withHandleAt(t, i, x, y, 1);
      EXPECT_TRUE(isSound(moved)) << shapeText(moved);
      EXPECT_NE(moved, t) << shape << " " << i;
      const EditPoint after = handlesOf(moved, kView)[i];
      if (handles[i].movesX) {
        EXPECT_NEAR(after.x, x, 0.2) << shape << " " << i;
      }
      if (handles[i].movesY) {
        EXPECT_NEAR(after.y, y, 0.01) << shape << " " << i;
      }
    }
  }
}

TEST(TermEdit, noMoveMakesATermThatDoesNotCompile) {
  for (const char* shape : kShapes) {
    const PolicyTerm t = term(shape);
    for (std::size_t i = 0; i < handlesOf(t, kView).size(); ++i)
      for (const double x : {-1e6, 0.0, 100.0, 199.0, 200.0, 300.0, 301.0, 500.0, 999.0, 1e6})
        for (const double y : {-1.0, 0.0, 0.3, 1.0, 2.0}) {
          const PolicyTerm moved = withHandleAt(t, i, x, y, 0.5);
          EXPECT_TRUE(isSound(moved))
              << shape << " point " << i << " to " << x << ", " << y << ": " << shapeText(moved);
        }
  }
}

TEST(TermEdit, pointsThatMoveTogetherKeepTheirDistances) {
  const auto moved = [](const char* shape, std::vector<std::size_t> handles, double dx, double dy = 0) {
    return shapeText(withHandlesMoved(term(shape), handles, dx, dy, 1));
  };
  EXPECT_EQ(moved("points 0 0.2 100 0.8 300 0", {0, 1}, 50, 0.1), "points 50 0.3 150 0.9 300 0");
  EXPECT_EQ(moved("points 0 0.2 100 0.8 300 0", {0, 1}, 1000, 1), "points 199 0.4 299 1 300 0")
      << "as far as the first that meets something";
  EXPECT_EQ(moved("points 0 0.2 100 0.8 300 0", {1, 2}, -1000), "points 0 0.2 1 0.8 201 0");
  EXPECT_EQ(moved("points 0 0.2 100 0.8 300 0", {0, 2}, 1000), "points 99 0.2 100 0.8 399 0");
  EXPECT_EQ(moved("triangle 100 300 500", {0, 1, 2}, -250), "triangle -150 50 250");
  EXPECT_EQ(moved("trapezoid -inf 0 200 400", {0, 1, 2}, 50), "trapezoid -inf 50 250 400");
  EXPECT_EQ(moved("trapezoid 0 100 200 400", {1, 2}, 500), "trapezoid 0 299 399 400");
  EXPECT_EQ(moved("ramp 400 200", {0, 1}, 100), "ramp 500 300");
  EXPECT_EQ(moved("ramp 400 200", {1}, 1000), "ramp 400 399");
  EXPECT_EQ(moved("gaussian 300 100", {0, 1}, 30), "gaussian 330 100") << "the width goes with its middle";
  EXPECT_EQ(moved("bell 300 100 2", {0, 1, 2}, 30, 0.2), "bell 330 100 2");
  EXPECT_EQ(moved("sigmoid 300 0.02", {0, 1}, -30), "sigmoid 270 0.02");
}

TEST(TermEdit, noPointsThatMoveTogetherMakeATermThatDoesNotCompile) {
  for (const char* shape : kShapes) {
    const PolicyTerm t = term(shape);
    const std::size_t count = handlesOf(t, kView).size();
    for (std::size_t set = 0; set < std::size_t{1} << count; ++set) {
      std::vector<std::size_t> handles;
      for (std::size_t i = 0; i < count; ++i)
        if (set >> i & 1) handles.push_back(i);
      for (const double dx : {-1e6, -250.0, -1.0, 0.0, 0.3, 40.0, 1e6})
        for (const double dy : {-2.0, 0.0, 0.3}) {
          const PolicyTerm moved = withHandlesMoved(t, handles, dx, dy, 0.5);
          EXPECT_TRUE(isSound(moved))
              << shape << " points " << set << " by " << dx << ", " << dy << ": " << shapeText(moved);
          if (handles.empty()) {
            EXPECT_EQ(moved, t);
          }
        }
    }
  }
}

TEST(TermEdit, everyShapeBecomesEveryOtherAndStaysAboutWhereItWas) {
  for (const char* from : kShapes)
    for (std::size_t to = 0; to < kTermShapes.size(); ++to) {
      const PolicyTerm t = term(from), changed = withShape(t, static_cast<TermShape>(to), kView);
      ASSERT_TRUE(isSound(changed)) << from << " to " << shapeText(changed);
      EXPECT_EQ(changed.shape, static_cast<TermShape>(to));
      EXPECT_EQ(changed.name, t.name);
      double most = 0;
      for (double x = 0; x <= 1000; x += 5) most = std::max(most, membershipOf(changed, x));
      EXPECT_GT(most, 0.85) << from << " to " << shapeText(changed);
    }
  EXPECT_EQ(shapeText(withShape(term("triangle 100 300 500"), TermShape::trapezoid, kView)),
            "trapezoid 100 300 300 500");
  EXPECT_EQ(shapeText(withShape(term("ramp 400 200"), TermShape::trapezoid, kView)),
            "trapezoid -inf 0 200 400");
  const PolicyTerm hill = withShape(term("gaussian 300 100"), TermShape::bell, kView);
  EXPECT_NEAR(membershipOf(hill, 300 + 117.7), 0.5, 0.02) << "the half-way points stay";
}

TEST(TermEdit, pointsAreAddedAndRemovedButTwoStay) {
  const PolicyTerm t = term("points 100 0 300 1");
  const auto added = withPoint(t, 200, 0.7);
  ASSERT_TRUE(added);
  EXPECT_EQ(shapeText(added->term), "points 100 0 200 0.7 300 1");
  EXPECT_EQ(added->handle, 1u);
  EXPECT_FALSE(withPoint(t, 300, 0.5)) << "a place that is taken";
  EXPECT_EQ(withoutPoint(added->term, 1), t);
  EXPECT_FALSE(withoutPoint(t, 0));
  EXPECT_FALSE(withPoint(term("ramp 0 1"), 200, 0.7));
  PolicyTerm full = t;
  while (full.numbers.size() < kMostTermNumbers) full = withPoint(full, full.numbers[0] - 1, 0)->term;
  EXPECT_FALSE(withPoint(full, 200, 0.7));
}

TEST(TermEdit, theViewHoldsTheTermsAndNoMoreThanTheRange) {
  EXPECT_EQ(viewOf(Signal::speed, {}).high, 1500);
  const Range view = viewOf(Signal::speed, {term("trapezoid -inf 200 300 500")});
  EXPECT_LE(view.low, 200);
  EXPECT_GE(view.high, 500);
  EXPECT_LT(view.high, 700);
  EXPECT_GE(viewOf(Signal::speed, {term("triangle 0 10 20")}).low, 0);
  EXPECT_TRUE(isSound(newTerm(Signal::triangles, "t", rowOf(Signal::triangles).range)));
}

TEST(TermEdit, numbersAreReadAsTheyAreWritten) {
  const PolicyTerm t = term("trapezoid -inf 0.25 300 500");
  EXPECT_EQ(numbersText(t), QStringLiteral("-inf 0.25 300 500"));
  EXPECT_EQ(readNumbers(numbersText(t)), t.numbers);
  EXPECT_EQ(readNumbers(QStringLiteral("  −1 ;2  ")), (std::vector<double>{-1, 2}));
  EXPECT_FALSE(readNumbers(QStringLiteral("1 two")));
}

}  // namespace
}  // namespace trimtab::views
