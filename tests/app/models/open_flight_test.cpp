#include "app/models/open_flight.h"

#include <bit>
#include <cmath>

#include "tests/support.h"

namespace trimtab::models {
namespace {

void add(std::string& file, std::uint64_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) file += static_cast<char>(value >> shift);
}
void record(std::string& file, int code, std::size_t length = 4) {
  add(file, static_cast<std::uint64_t>(code), 2);
  add(file, length, 2);
  file.resize(file.size() + length - 4, '\0');
}
/// Adds a level of detail; returns where it begins.
std::size_t level(std::string& file, double size, double in = 0, double out = 0) {
  const std::size_t at = file.size();
  record(file, 73, 80);
  for (const auto& [offset, value] : {std::pair{16u, in}, {24u, out}, {72u, size}}) {
    std::string bytes;
    add(bytes, std::bit_cast<std::uint64_t>(value), 8);
    file.replace(at + offset, 8, bytes);
  }
  return at;
}
double number(const std::string& file, std::size_t at) {
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < 8; ++k) bits = bits << 8 | static_cast<unsigned char>(file[at + k]);
  return std::bit_cast<double>(bits);
}
struct Range {
  double from, to;
};
Range rangeAt(const std::string& file, std::size_t level) {
  return {number(file, level + 24), number(file, level + 16)};
}

TEST(OpenFlight, theLeastSignificantSizeIsTheFinestOfLevelsSideBySide) {
  std::string file;
  record(file, 1, 300);
  record(file, 10);
  const std::size_t coarse = level(file, 60);
  record(file, 10);
  record(file, 4, 28);
  record(file, 11);
  const std::size_t fine = level(file, 5), middle = level(file, 20), alsoFine = level(file, 5);
  record(file, 11);
  const std::string done = withRangesBySize(file);
  ASSERT_EQ(done.size(), file.size());
  EXPECT_EQ(rangeAt(done, fine).from, 0);
  EXPECT_EQ(rangeAt(done, fine).to, rangeAt(done, middle).from);
  EXPECT_EQ(rangeAt(done, middle).to, rangeAt(done, coarse).from);
  EXPECT_LT(rangeAt(done, middle).from, rangeAt(done, coarse).from);
  EXPECT_TRUE(std::isinf(rangeAt(done, coarse).to));
  EXPECT_EQ(rangeAt(done, alsoFine).to, rangeAt(done, fine).to);
  EXPECT_EQ(number(done, coarse + 72), 60) << "sizes stay";
}

TEST(OpenFlight, aLevelInsideAnotherIsAddedWhereItIsFineEnough) {
  std::string file;
  const std::size_t outer = level(file, 30);
  record(file, 10);
  record(file, 2, 44);
  record(file, 10);
  const std::size_t inner = level(file, 8);
  record(file, 11);
  record(file, 11);
  const std::string done = withRangesBySize(file);
  EXPECT_EQ(rangeAt(done, outer).from, 0);
  EXPECT_TRUE(std::isinf(rangeAt(done, outer).to));
  EXPECT_EQ(rangeAt(done, inner).from, 0);
  EXPECT_EQ(rangeAt(done, inner).to, 1000 * 30);
}

TEST(OpenFlight, rangesAndWhatIsNoRecordStay) {
  std::string file;
  level(file, 9, 800, 100);
  level(file, 0);
  level(file, NAN);
  level(file, -4);
  record(file, 73, 72);
  EXPECT_EQ(withRangesBySize(file), file);
  for (std::size_t cut = 0; cut < file.size(); ++cut)
    EXPECT_EQ(withRangesBySize(file.substr(0, cut)), file.substr(0, cut));
  std::string pops;
  for (int i = 0; i < 5; ++i) record(pops, 11);
  EXPECT_EQ(withRangesBySize(pops), pops);
}

}  // namespace
}  // namespace trimtab::models
