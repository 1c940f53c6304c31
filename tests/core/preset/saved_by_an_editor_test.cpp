#include <gmock/gmock.h>

#include <string>

#include "tests/support.h"
#include "trimtab/preset/preset.h"

/// What editors do to a file that they only save.
namespace trimtab {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kMark = "\xef\xbb\xbf";

std::string withWindowsLineEnds(const std::string& text) {
  std::string changed;
  for (const char c : text) changed += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return changed;
}

std::string asUtf16(const std::string& text, bool bigEndian) {
  std::string wide;
  for (const char c : text) wide += bigEndian ? std::string{'\0', c} : std::string{c, '\0'};
  return wide;
}

const ExportFormat kEveryFormat[] = {ExportFormat::json, ExportFormat::xml, ExportFormat::ini};

std::string anExport(ExportFormat format) {
  TuningParameters parameters;
  parameters.lod.scale = Ratio{1.5};
  return exportText(*validate(parameters), "an export",
                    {"A", "2024-05-06T07:08:09Z", "test", "T", "one\ntwo"}, format);
}

TEST(SavedByAnEditor, aPresetIsReadWithItsByteOrderMarkAndLineEnds) {
  const std::string presets[] = {
      "{\n\"format\": \"trimtab-preset\",\n\"version\": 3,\n\"parameters\": {\"lod.scale\": 1.5}\n}\n",
      "<?xml "
      "version=\"1.0\"?>\n<PropertyList>\n<export><format>trimtab-preset</format><version>3</version></"
      "export>\n"
      "<lod><scale>1.5</scale></lod>\n</PropertyList>\n",
      "[export]\nformat = trimtab-preset\nversion = 3\n[parameters]\nlod.scale = 1.5\n",
      "; a comment\n[export]\nformat = trimtab-preset\nversion = 3\n[parameters]\nlod.scale = 1.5\n"};
  for (const std::string& preset : presets)
    for (const std::string& text :
         {kMark + preset, withWindowsLineEnds(preset), kMark + withWindowsLineEnds(preset)}) {
      const auto read = parsePreset(text, "p");
      ASSERT_TRUE(read) << toString(read.findings()) << '\n' << preset;
      EXPECT_TRUE(read.findings().empty()) << toString(read.findings());
      EXPECT_EQ(read->parameters.lod.scale.value(), 1.5);
    }
}

TEST(SavedByAnEditor, anExportIsReadAndWhatWasUndoneIsSaid) {
  for (const ExportFormat format : kEveryFormat) {
    const std::string good = anExport(format);
    const std::pair<std::string, const char*> saved[] = {
        {kMark + good, "found a byte order mark, which"},
        {withWindowsLineEnds(good), "found Windows line ends (CR LF), which"},
        {kMark + withWindowsLineEnds(good), "found a byte order mark and Windows line ends (CR LF), which"}};
    for (const auto& [text, says] : saved) {
      const auto read = parsePreset(text, "e");
      ASSERT_TRUE(read) << toString(read.findings());
      ASSERT_EQ(read.findings().size(), 1u) << toString(read.findings());
      EXPECT_EQ(read.findings()[0].severity, Severity::warning);
      EXPECT_THAT(toString(read.findings()), HasSubstr(says));
      EXPECT_EQ(read->parameters.lod.scale.value(), 1.5);
      EXPECT_EQ(read->name, "an export");
    }
  }
}

TEST(SavedByAnEditor, anExportThatWasChangedAsWellIsRefusedWithBoth) {
  for (const ExportFormat format : kEveryFormat) {
    std::string changed = anExport(format);
    changed.replace(changed.find("1.5"), 3, "1.6");
    EXPECT_THAT(toString(parsePreset(changed, "e").findings()), HasSubstr("changed after its export"));
    EXPECT_THAT(toString(parsePreset(changed, "e").findings()), Not(HasSubstr("Windows")));
    const auto both = parsePreset(kMark + withWindowsLineEnds(changed), "e");
    ASSERT_FALSE(both);
    EXPECT_THAT(
        toString(both.findings()),
        HasSubstr("changed after its export, and not only by a byte order mark and Windows line ends"));
  }
}

TEST(SavedByAnEditor, utf16IsNamed) {
  for (const ExportFormat format : kEveryFormat)
    for (const bool bigEndian : {false, true})
      for (const bool marked : {false, true}) {
        const std::string mark = !marked ? "" : bigEndian ? "\xfe\xff" : "\xff\xfe";
        const auto read = parsePreset(mark + asUtf16(anExport(format), bigEndian), "e");
        ASSERT_FALSE(read);
        EXPECT_EQ(toString(read.findings()),
                  "e: expected text in UTF-8, found UTF-16; save it again as UTF-8");
      }
}

}  // namespace
}  // namespace trimtab
