#include "trimtab/units/finding_list.h"

#include <gtest/gtest.h>

namespace trimtab {
namespace {

TEST(FindingList, keepsTheFirstOfEachSeverityInTheirOrderAndCountsTheOthers) {
  FindingList list;
  for (int i = 0; i < 40000; ++i)
    list.add({i % 2 == 0 ? Severity::warning : Severity::note, "f:" + std::to_string(i), "", "", "x"});
  EXPECT_FALSE(list.hasError());
  list.add({Severity::error, "f:last", "", "", "what is wrong"});
  EXPECT_TRUE(list.hasError());
  const Findings all = list.all("f");
  ASSERT_EQ(all.size(), 2 * FindingList::kMost + 1 + 2);
  EXPECT_EQ(all[0].where, "f:0");
  EXPECT_EQ(all[1].where, "f:1");
  EXPECT_EQ(all[2 * FindingList::kMost].where, "f:last") << "warnings before it hide no error";
  EXPECT_EQ(toString(all[2 * FindingList::kMost + 1]), "f: found 19,980 more warnings");
  EXPECT_EQ(all[2 * FindingList::kMost + 1].severity, Severity::warning);
  EXPECT_EQ(toString(all[2 * FindingList::kMost + 2]), "f: found 19,980 more notes");
}

TEST(FindingList, saysNothingMoreOfAListThatItHoldsWhole) {
  Findings few(FindingList::kMost, Finding{Severity::error, "f", "", "", "x"});
  EXPECT_EQ(firstOf(few, "f"), few);
  few.push_back(few[0]);
  EXPECT_EQ(toString(firstOf(few, "f").back()), "f: found 1 more error");
  FindingList million;
  for (int i = 0; i < 1234020; ++i) million.add(few[0]);
  EXPECT_EQ(toString(million.all("f").back()), "f: found 1,234,000 more errors");
}

TEST(FindingList, makesNoFindingThatItOnlyCounts) {
  FindingList list;
  std::size_t made = 0;
  for (int i = 0; i < 1000; ++i)
    list.add(Severity::warning, [&] {
      ++made;
      return Finding{Severity::warning, "f", "", "", "x"};
    });
  EXPECT_EQ(made, FindingList::kMost);
  EXPECT_EQ(toString(list.all("f").back()), "f: found 980 more warnings");
}

}  // namespace
}  // namespace trimtab
