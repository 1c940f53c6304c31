#include <gmock/gmock.h>

#include <string>

#include "random_parameters.h"
#include "tests/support.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/sealed.h"

namespace trimtab {
namespace {

using test::sameBits;
using ::testing::HasSubstr;

struct Format {
  ExportFormat format;
  const char* ending;
};
constexpr Format kFormats[] = {
    {ExportFormat::json, "json"}, {ExportFormat::xml, "xml"}, {ExportFormat::ini, "ini"}};

std::string exportedText(const TuningParameters& parameters, ExportFormat format) {
  return exportText(*validate(parameters), "tuned; \"best\" <\\n>",
                    {"A & B", "2024-05-06T07:08:09Z", "test", "T", "two\nlines; # = [x]"}, format);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST(ReadExport, givesTheSameBitsInEveryFormat) {
  test::RandomParameters random(11);
  for (int made = 0; made < 40;) {
    TuningParameters parameters = random();
    parameters.scheme.hysteresis = Membership{0};
    parameters.altitude.maximum = Feet{200000};
    if (!validate(parameters)) continue;
    ++made;
    for (const auto& [format, ending] : kFormats) {
      const auto read = parsePreset(exportedText(parameters, format), ending);
      ASSERT_TRUE(read) << toString(read.findings());
      EXPECT_TRUE(sameBits(read->parameters, parameters)) << ending;
      EXPECT_EQ(read->name, "tuned; \"best\" <\\n>");
      for (const Finding& f : read.findings()) EXPECT_EQ(f.severity, Severity::warning) << toString(f);
    }
  }
}

TEST(ReadExport, refusesAnyChangedByte) {
  for (const auto& [format, ending] : kFormats) {
    const std::string good = exportedText({}, format);
    for (std::size_t at = 0; at < good.size(); at += 37) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ 4);
      EXPECT_FALSE(parsePreset(bad, "e")) << ending << " byte " << at;
    }
  }
}

/// The seal holds, so that only the value is wrong.
TEST(ReadExport, namesLineKeyExpectedAndFoundOfABadValue) {
  struct BadValue {
    ExportFormat format;
    const char *from, *to, *key, *expected, *found;
  };
  const BadValue bad[] = {
      {ExportFormat::ini, "lod.scale = 1\n", "lod.scale = 101\n", "lod.scale", "0.05 to 100", "101"},
      {ExportFormat::ini, "lod.scale = 1\n", "lod.scale = x\n", "lod.scale", "a number", "x"},
      {ExportFormat::ini, "culling.occlusion = auto", "culling.occlusion = best", "culling.occlusion",
       "one of", "best"},
      {ExportFormat::ini, "lod.scale = 1\n", "lod.scale\n", "", "key = value", "lod.scale"},
      {ExportFormat::ini, "lod.scale = 1\n", "lod.scale = 1\nlod.scale = 1\n", "lod.scale",
       "each parameter once", "second"},
      {ExportFormat::ini, "[seal]", "[sale]", "", "[seal]", "[sale]"},
      {ExportFormat::ini, "version = 3", "version = 99", "version", "a format version", "99"},
      {ExportFormat::xml, "<scale type=\"double\">1<", "<scale type=\"double\">101<", "lod.scale",
       "0.05 to 100", "101"},
      {ExportFormat::xml, "<scale type=\"double\">1<", "<scale type=\"double\">x<", "lod.scale", "a number",
       "x"},
      {ExportFormat::xml, "<scale type=\"double\">1</scale>", "<scale type=\"double\">1</scael>", "",
       "a well-formed XML document", ""},
      {ExportFormat::xml, "<low type=\"double\">0.1<", "<low type=\"double\">x<", "fuzzy.bands_px",
       "bands as low:WIDTHxHEIGHT", "x:320x240"},
  };
  for (const BadValue& row : bad) {
    const auto read = parsePreset(sealed(replaced(exportedText({}, row.format), row.from, row.to)), "file");
    EXPECT_FALSE(read && validate(read->parameters)) << row.to;
    ASSERT_FALSE(read.findings().empty()) << row.to;
    const Finding& f = read.findings()[0];
    EXPECT_THAT(f.where, testing::MatchesRegex("file:[0-9]+")) << row.to;
    EXPECT_NE(f.where, "file:1") << row.to;
    EXPECT_EQ(f.key, row.key) << row.to;
    EXPECT_THAT(f.expected, HasSubstr(row.expected)) << row.to;
    EXPECT_THAT(f.found, HasSubstr(row.found)) << row.to;
  }
}

TEST(ReadExport, keepsUnknownValuesInATextThatCanBeReadAgain) {
  for (const std::string value : {"8.", ".5", "nan", "inf", "007", "1e3", "-2"}) {
    const auto read = parsePreset(
        "[export]\nformat = trimtab-preset\nversion = 3\nname = n\n\n[parameters]\nlater.key = " + value +
            '\n',
        "e.ini");
    ASSERT_TRUE(read) << value << '\n' << toString(read.findings());
    const auto saved = presetText(*read);
    ASSERT_TRUE(saved) << value;
    EXPECT_THAT(*saved, HasSubstr(value));
    EXPECT_TRUE(parsePreset(*saved, "saved")) << *saved;
  }
}

// As bytes the first key sorts behind the second, as UTF-8 before it.
TEST(ReadExport, keepsUnknownKeysThatAreNoUtf8InATextThatIsSavedToItself) {
  const auto read = parsePreset(
      "[export]\nformat = trimtab-preset\nversion = 3\nname = n\n\n[parameters]\nlater\xfe.a = "
      "1\nlater\xc3.b = 2\n",
      "e.ini");
  ASSERT_TRUE(read) << toString(read.findings());
  const auto saved = presetText(*read);
  ASSERT_TRUE(saved);
  const auto again = parsePreset(*saved, "saved");
  ASSERT_TRUE(again) << *saved;
  EXPECT_EQ(*presetText(*again), *saved);
}

TEST(ReadExport, refusesWhatAnXmlReaderCouldBeAbusedWith) {
  const std::string good = exportedText({}, ExportFormat::xml);
  const std::string head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  std::string laughs = "<!DOCTYPE PropertyList [<!ENTITY a \"ha\">";
  for (char c = 'b'; c <= 'k'; ++c) {
    laughs += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 10; ++i) laughs += std::string("&") + static_cast<char>(c - 1) + ";";
    laughs += "\">";
  }
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += "<a>";
  std::string closedDeep = deep;
  for (int i = 0; i < 200000; ++i) closedDeep += "</a>";
  const std::pair<std::string, const char*> bad[] = {
      {replaced(good, head, head + laughs + "]>\n"), "no document type"},
      {replaced(good, head, head + "<!DOCTYPE x SYSTEM \"file:///etc/passwd\">\n"), "no document type"},
      {replaced(good, "encoding=\"UTF-8\"", "encoding=\"ISO-8859-1\""), "the encoding UTF-8"},
      {replaced(good, "<lod>", deep), "a well-formed XML document"},
      {replaced(good, "<lod>", closedDeep + "<lod>"), "elements inside each other"},
      {head + "<Something/>", "a PropertyList"},
      {std::string("\xff\xfe<\0?\0x\0m\0l\0", 12), ""},
  };
  for (const auto& [text, expected] : bad) {
    const auto read = parsePreset(sealed(text), "e.xml");
    ASSERT_FALSE(read) << expected;
    EXPECT_THAT(read.findings()[0].expected, HasSubstr(expected));
  }
}

}  // namespace
}  // namespace trimtab
