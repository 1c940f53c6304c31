#include "app/harness/sweep.h"

#include <gtest/gtest.h>

namespace trimtab::harness {
namespace {

TEST(Sweep, readsAnAxisAndRefusesWhatIsNone) {
  const auto axis = parseAxis("lod.screen_space_error_px=1,2,4");
  ASSERT_TRUE(axis);
  EXPECT_EQ(axis->key, "lod.screen_space_error_px");
  EXPECT_EQ(axis->values, (std::vector<std::string>{"1", "2", "4"}));
  for (const char* bad : {"", "key", "=1,2", "key=", "key=1,,2", "key=1,", "key=1, 2", "key=1,2,1"})
    EXPECT_FALSE(parseAxis(bad)) << bad;
}

TEST(Sweep, namesEveryCombinationOnce) {
  const std::vector<SweepAxis> axes{{"a", {"1", "2"}}, {"b", {"x", "y", "z"}}};
  std::vector<std::string> names;
  for (const Settings& settings : combinations(axes)) names.push_back(sweptName("my preset", settings));
  EXPECT_EQ(names, (std::vector<std::string>{"my preset a=1 b=x", "my preset a=1 b=y", "my preset a=1 b=z",
                                             "my preset a=2 b=x", "my preset a=2 b=y", "my preset a=2 b=z"}));
  ASSERT_EQ(combinations({}).size(), 1u);
  EXPECT_EQ(sweptName("default", combinations({}).front()), "default");
}

TEST(Sweep, isFoundAgainInTheAnswerWithWhatIsMissing) {
  Answer answer;
  const auto add = [&](const char* preset, const char* method = "proposed") {
    answer.rows.push_back({});
    answer.rows.back().name = {"circuit", preset, method};
  };
  add("default");
  add("my preset a=1 b=x");
  add("my preset a=1 b=y");
  add("my preset a=2 b=y");
  add("default a=1", "none");
  const std::vector<Sweep> sweeps = sweepsOf(answer);
  ASSERT_EQ(sweeps.size(), 2u);
  EXPECT_EQ(sweeps[0].base, "my preset");
  ASSERT_EQ(sweeps[0].axes.size(), 2u);
  EXPECT_EQ(sweeps[0].at(0, 0), 1u);
  EXPECT_EQ(sweeps[0].at(0, 1), 2u);
  EXPECT_EQ(sweeps[0].at(1, 0), Sweep::kNotMeasured);
  EXPECT_EQ(sweeps[0].at(1, 1), 3u);
  EXPECT_EQ(sweeps[1].base, "default");
  EXPECT_EQ(sweeps[1].method, "none");
  EXPECT_EQ(sweeps[1].at(0, 0), 4u);
}

}  // namespace
}  // namespace trimtab::harness
