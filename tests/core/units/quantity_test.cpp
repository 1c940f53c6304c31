#include "trimtab/units/quantity.h"

#include <gtest/gtest.h>

#include <limits>

namespace trimtab {

TEST(Quantity, convertsWithinItsDimensionOnly) {
  EXPECT_DOUBLE_EQ(Feet{4000}.in<Metres>(), 1219.2);
  EXPECT_DOUBLE_EQ(Metres{0.3048}.in<Feet>(), 1);
  EXPECT_DOUBLE_EQ(Degrees{180}.in<Radians>(), std::numbers::pi);
  EXPECT_DOUBLE_EQ(Knots{3600}.in<MetresPerSecond>(), 1852);
  EXPECT_DOUBLE_EQ(Milliseconds{16.7}.in<Seconds>(), 0.0167);
}

TEST(Quantity, keepsItsOwnUnitToTheBit) {
  for (const double v : {0.1, 1e-308, std::numeric_limits<double>::denorm_min(), 1e308, -0.0})
    EXPECT_EQ(Feet{v}.in<Feet>(), v);
}

TEST(Quantity, comparesAndCalculates) {
  EXPECT_LT(Feet{1}, Feet{2});
  EXPECT_EQ(Feet{1} + Feet{2}, Feet{3});
  EXPECT_EQ(Feet{6} / Feet{2}, 3.0);
  EXPECT_EQ(-(Feet{2} * 3), Feet{-6});
}

}  // namespace trimtab
