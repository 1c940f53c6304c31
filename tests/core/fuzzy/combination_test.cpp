#include "trimtab/fuzzy/combination.h"

#include <gtest/gtest.h>

namespace trimtab {
namespace {

TEST(Combination, sumAddsTheMemberships) {
  EXPECT_EQ(combine(Combination::sum, 0.6, 0.5), 1.1);
  EXPECT_EQ(combine(Combination::sum, 1, 1), 2);
}

TEST(Combination, twiceTheMinimumNeedsBoth) {
  EXPECT_EQ(combine(Combination::twice_minimum, 0, 1), 0);
  EXPECT_EQ(combine(Combination::twice_minimum, 0.6, 0.5), 1);
}

}  // namespace
}  // namespace trimtab
