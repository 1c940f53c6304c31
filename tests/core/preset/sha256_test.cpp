#include "trimtab/preset/sha256.h"

#include <gtest/gtest.h>

#include "tests/support.h"

namespace trimtab {
namespace {

std::string sumOf(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.hex();
}

TEST(Sha256, givesThePublishedSums) {
  // FIPS 180-4 examples and the vectors of NIST's validation programme.
  EXPECT_EQ(sumOf(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sumOf("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sumOf("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sumOf(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, takesBytesInPieces) {
  const std::string text = "abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    Sha256 sum;
    sum.add(std::string_view(text).substr(0, cut));
    sum.add(std::string_view(text).substr(cut));
    EXPECT_EQ(sum.hex(), sumOf(text)) << cut;
  }
}

TEST(Sha256, agreesWithTheSystemsProgramAtEveryLengthAroundABlock) {
  if (test::run("sha256sum --version").exitCode != 0) GTEST_SKIP() << "needs sha256sum";
  const test::ScratchDir dir;
  for (std::size_t length = 0; length < 140; ++length)
    test::writeFile(dir / std::to_string(1000 + length), std::string(length, static_cast<char>(length * 37)));
  std::istringstream sums(test::run("cd " + dir.path().string() + " && sha256sum [0-9]*").out);
  std::size_t checked = 0;
  for (std::string sum, name; sums >> sum >> name; ++checked) {
    const std::size_t length = std::stoul(name) - 1000;
    EXPECT_EQ(sumOf(std::string(length, static_cast<char>(length * 37))), sum) << length;
  }
  EXPECT_EQ(checked, 140u);
}

}  // namespace
}  // namespace trimtab
