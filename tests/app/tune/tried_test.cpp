#include "app/tune/tried.h"

#include <gmock/gmock.h>

#include "app/tune/candidates.h"

namespace trimtab::tune {
namespace {

/// The estimates of one preset over twelve rows, of which every second row of the flight is kept.
std::vector<RowEstimate> estimatesOf(const std::function<double(std::size_t)>& ms) {
  std::vector<RowEstimate> rows;
  for (std::size_t i = 0; i < 12; ++i) rows.push_back({2 * i, ms(i), 0.01});
  return rows;
}

TEST(TriedOut, rowsTellPresetsApart) {
  const std::vector<std::vector<RowEstimate>> estimates{
      estimatesOf([](std::size_t) { return 20.0; }),
      estimatesOf([](std::size_t i) { return i == 3 || i == 4 || i == 11 ? 30.0 : 20.0 + 0.1 * double(i); })};
  EXPECT_THAT(rowsApart(estimates, 3), testing::ElementsAre(6, 8, 22)) << "one in each third";
  EXPECT_EQ(rowsApart(estimates, 100).size(), 12u);
  EXPECT_TRUE(rowsApart({}, 3).empty());
}

TEST(TriedOut, missesAreOfTheRowsThatWereDrawn) {
  const std::vector<RowEstimate> estimates{{0, 10, 0.01}, {5, 20, 0.02}, {9, 30, 0.03}};
  std::vector<harness::MeasuredFrame> drawn(2);
  drawn[0].row = 5, drawn[0].cost.total = 30, drawn[0].error.flip = 0.02;
  drawn[1].row = 9, drawn[1].cost.total = 30, drawn[1].error.flip = 0.005;
  const Missed missed = missedBy(ErrorKind::flip, estimates, drawn);
  EXPECT_DOUBLE_EQ(missed.time, 60.0 / 50);
  EXPECT_DOUBLE_EQ(missed.error, 0.025 / 0.05);
  const Missed unknown = missedBy(ErrorKind::flip, estimates, {});
  EXPECT_EQ(unknown.time, 1);
  EXPECT_EQ(unknown.error, 1) << "of what nobody drew, nothing is known";
}

}  // namespace
}  // namespace trimtab::tune
