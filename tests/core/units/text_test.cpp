#include "trimtab/units/text.h"

#include <gtest/gtest.h>

namespace trimtab {
namespace {

TEST(Text, isTrimmedAtItsEndsOnly) {
  EXPECT_EQ(trimmed(" \t a b\r\n"), "a b");
  EXPECT_EQ(trimmed("a"), "a");
  EXPECT_EQ(trimmed(" \r\n\t"), "");
  EXPECT_EQ(trimmed(""), "");
}

}  // namespace
}  // namespace trimtab
