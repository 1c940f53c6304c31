#include "trimtab/units/result.h"

#include <gtest/gtest.h>

#include "trimtab/units/labelled.h"

namespace trimtab {

TEST(Finding, readsAsOneLine) {
  EXPECT_EQ(toString(Finding{Severity::error, "a.json:3", "fuzzy.hysteresis", "0 to 0.2", "7"}),
            "a.json:3: fuzzy.hysteresis: expected 0 to 0.2, found 7");
  EXPECT_EQ(toString(Finding{Severity::error, "a.json", "", "", "an empty file"}),
            "a.json: found an empty file");
  EXPECT_EQ(toString(Finding{Severity::error, "", "", "a port", ""}), "expected a port");
}

TEST(Finding, isLabelledByItsSeverity) {
  EXPECT_EQ(labelled({Finding{Severity::note, "a", "", "", "x"}, Finding{Severity::error, "b", "", "y", ""}}),
            "note: a: found x\nerror: b: expected y\n");
}

TEST(Result, carriesAValueWithNotesOrAllErrors) {
  const Result<int> good(3, {Finding{Severity::note, "x", "", "", "odd"}});
  ASSERT_TRUE(good.ok());
  EXPECT_EQ(*good, 3);
  EXPECT_EQ(good.findings().size(), 1u);
  Result<std::string> text(std::string("on"));
  text->push_back('e');
  EXPECT_EQ(*text, "one") << "a value that is ours can be changed through the arrow";
  const Result<int> bad(Findings{Finding{}, Finding{}});
  EXPECT_FALSE(bad);
  EXPECT_EQ(bad.findings().size(), 2u);
}

}  // namespace trimtab
