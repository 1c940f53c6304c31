#include "trimtab/units/large_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>

namespace trimtab {
namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;

std::uintptr_t addressOf(const void* memory) {
  return reinterpret_cast<std::uintptr_t>(memory);
}

TEST(LargeArray, beginsAtALineAndHoldsWhatItIsGiven) {
  for (const std::size_t bytes :
       {std::size_t{1}, std::size_t{64}, kHugePage - 1, kHugePage, kHugePage + 1, 3 * kHugePage + 12345}) {
    LargeArray<unsigned char> array(bytes, 7);
    EXPECT_EQ(addressOf(array.data()) % 64, 0u) << bytes;
    EXPECT_EQ(std::count(array.begin(), array.end(), 7), static_cast<std::ptrdiff_t>(bytes));
  }
  LargeArray<int> grown;
  for (int i = 0; i < 2'000'000; ++i) grown.push_back(i);
  const LargeArray<int> copy = grown;
  grown = {};
  for (int i = 0; i < 2'000'000; ++i) ASSERT_EQ(copy[static_cast<std::size_t>(i)], i);
}

TEST(LargeArray, onesOfALengthBeginAtDifferentPlacesOfAPage) {
  std::vector<LargeArray<float>> arrays;
  std::set<std::uintptr_t> lines, pages;
  for (std::size_t i = 0; i < kLargeColours; ++i) {
    arrays.emplace_back(kHugePage / sizeof(float));
    lines.insert(addressOf(arrays.back().data()) / 64 % 64);
    pages.insert(addressOf(arrays.back().data()) / 4096 % kLargeColours);
  }
  EXPECT_EQ(lines.size(), kLargeColours);
  EXPECT_EQ(pages.size(), kLargeColours);
}

}  // namespace
}  // namespace trimtab
