#include <gmock/gmock.h>
#include <time.h>

#include <algorithm>
#include <functional>
#include <random>

#include "tests/support.h"
#include "trimtab/preset/json_text.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/finding_list.h"

/// Files with a mistake in every line: which findings a reader reports, and how its time grows.
namespace trimtab {
namespace {

using ::testing::HasSubstr;

const char* const kLanguages[] = {"json", "xml", "ini"};

/// A preset whose parameters are lines of a format, made for each number below `lines`.
std::string presetOf(const std::string& format, std::size_t lines,
                     const std::function<std::string(std::size_t)>& key, const std::string& last = "") {
  std::string text;
  for (std::size_t i = 0; i < lines; ++i) {
    if (format == "json")
      text += (i == 0 ? "\n\"" : ",\n\"") + key(i) + "\": 1";
    else if (format == "xml")
      text += "<" + key(i) + ">1</" + key(i) + ">\n";
    else
      text += key(i) + " = 1\n";
  }
  if (format == "json")
    return "{\"format\": \"trimtab-preset\", \"version\": 3, \"parameters\": {" + text + last + "\n}}\n";
  if (format == "xml")
    return "<?xml version=\"1.0\" "
           "encoding=\"UTF-8\"?>\n<PropertyList>\n<export><format>trimtab-preset</format>"
           "<version>3</version></export>\n" +
           text + last + "</PropertyList>\n";
  return "[export]\nformat = trimtab-preset\nversion = 3\n[parameters]\n" + text + last;
}

/// Near to a key of this version, so that each may have been meant.
std::string almost(std::size_t i) {
  return "lod.scal" + std::to_string(i);
}

TEST(ManyKeys, thatAreUnknownAreToldInAFewLinesAndAllKept) {
  constexpr std::size_t kKeys = 40000;
  for (const std::string format : kLanguages) {
    const auto read = parsePreset(presetOf(format, kKeys, almost), "p");
    ASSERT_TRUE(read) << toString(read.findings());
    ASSERT_EQ(read.findings().size(), FindingList::kMost + 1) << format;
    EXPECT_THAT(toString(read.findings()[0]), HasSubstr("(lod.scale?), found an unknown key"));
    EXPECT_EQ(toString(read.findings().back()), "p: found 39,980 more warnings") << format;
    EXPECT_EQ(read->unknown.size(), kKeys) << format;
    const auto text = presetText(*read);
    ASSERT_TRUE(text);
    const auto again = parsePreset(*text, "again");
    ASSERT_TRUE(again);
    EXPECT_EQ(again->unknown, read->unknown) << format;
  }
}

TEST(ManyKeys, hideNoErrorBehindThem) {
  const std::pair<std::string, std::string> wrong[] = {{"json", ",\n\"lod.scale\": \"two\""},
                                                       {"xml", "<lod><scale>two</scale></lod>"},
                                                       {"ini", "lod.scale = two\n"}};
  for (const auto& [format, line] : wrong) {
    const auto read = parsePreset(presetOf(format, 5000, almost, line), "p");
    ASSERT_FALSE(read) << format;
    EXPECT_THAT(toString(read.findings()), HasSubstr("lod.scale: expected a number")) << format;
  }
}

TEST(ManyKeys, thatAreRefusedAreCountedToo) {
  const auto same = [](std::size_t) { return std::string("lod.scale"); };
  for (const std::string format : kLanguages) {
    const auto read = parsePreset(presetOf(format, 3001, same), "p");
    ASSERT_FALSE(read);
    EXPECT_EQ(toString(read.findings().back()), "p: found 2,980 more errors") << format;
  }
  const auto bands = [](std::size_t i) { return "[section" + std::to_string(i) + "]\nx"; };
  EXPECT_EQ(toString(parsePreset(presetOf("ini", 3000, bands), "p").findings().back()),
            "p: found 2,980 more errors");
}

TEST(ManyKeys, inALongNameCostNoMoreThanTheFile) {
  const std::string name(300, 'a');
  const auto read =
      parsePreset(presetOf("xml", 0, almost, "<" + name + "><b>1</b><c>2</c></" + name + ">"), "p");
  EXPECT_THAT(toString(read.findings()), HasSubstr("expected at most 200 characters, found 300"));
  // What the JSON reader says of a text without its closing quote quotes it.
  const auto open = parsePreset("{\"format\": \"" + std::string(100000, 'x'), "p");
  ASSERT_FALSE(open);
  EXPECT_LT(toString(open.findings()).size(), 1000u);
  const auto value =
      parsePreset(presetOf("ini", 0, almost, "lod.scale = " + std::string(100000, 'x') + '\n'), "p");
  ASSERT_FALSE(value);
  EXPECT_LT(toString(value.findings()).size(), 1000u);
}

TEST(Places, areTheLinesInAnyOrder) {
  const std::string text = "a\n\nb\nc", where = "f";
  json::Places places(where, text);
  std::vector<std::size_t> offsets{0, 1, 2, 3, 4, 5, 6, 7, 100};
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    for (const std::size_t offset : offsets)
      EXPECT_EQ(places.at(offset), json::place(where, text, offset)) << offset;
    std::shuffle(offsets.begin(), offsets.end(), random);
  }
  EXPECT_EQ(places.at(0), "f:1");
  EXPECT_EQ(places.at(3), "f:3");
  EXPECT_EQ(places.at(100), "f:4");
}

/// Processor time of this thread for some work: the least of several runs, since others work on the machine.
double leastSeconds(const std::function<void()>& work) {
  const auto now = [] {
    timespec t{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  double least = 1e9;
  for (int i = 0; i < 5; ++i) {
    const double before = now();
    work();
    least = std::min(least, now() - before);
  }
  return least;
}

TEST(ManyKeys, areReadAndWrittenInATimeThatGrowsAsTheFile) {
  constexpr std::size_t kFew = 20000, kTimes = 8;
  // Where work grows as the square it is 64; as the file, it is 8 and a little for sorting.
  constexpr double kMost = 28;
  const auto ratio = [&](const std::function<void(std::size_t)>& work) {
    return leastSeconds([&] { work(kFew * kTimes); }) / leastSeconds([&] { work(kFew); });
  };
  for (const std::string format : kLanguages) {
    const std::string few = presetOf(format, kFew, almost), many = presetOf(format, kFew * kTimes, almost);
    EXPECT_LT(ratio([&](std::size_t keys) { EXPECT_TRUE(parsePreset(keys == kFew ? few : many, "p")); }),
              kMost)
        << format;
  }
  Preset few, many;
  for (std::size_t i = 0; i < kFew * kTimes; ++i) (i < kFew ? few : many).unknown[almost(i)] = "1";
  many.unknown.insert(few.unknown.begin(), few.unknown.end());
  EXPECT_LT(ratio([&](std::size_t keys) { EXPECT_TRUE(presetText(keys == kFew ? few : many)); }), kMost);
}

}  // namespace
}  // namespace trimtab
