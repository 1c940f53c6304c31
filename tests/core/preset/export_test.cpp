#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <regex>

#include "random_parameters.h"
#include "tests/support.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/sealed.h"

namespace trimtab {
namespace {

using test::sameBits;
using ::testing::HasSubstr;

const Provenance kProvenance{"A. \"Author\" <a@b> & &lt; co", "2024-05-06T07:08:09Z", "test 1.0",
                             "/data/caf\xc3\xa9.db", "two\nlines; # sha256: \\ end"};
const std::string kName = "tuned = best";

std::string exported(const TuningParameters& parameters, ExportFormat format) {
  const auto validated = validate(parameters);
  EXPECT_TRUE(validated) << toString(validated.findings());
  return exportText(*validated, kName, kProvenance, format);
}

/// Random parameters that hold every rule, some with many digits and many points.
std::vector<TuningParameters> samples() {
  std::vector<TuningParameters> result{TuningParameters{}, loadPreset("as-printed")->parameters};
  test::RandomParameters random(5);
  while (result.size() < 30) {
    TuningParameters p = random();
    p.scheme.hysteresis = Membership{0};
    p.altitude.maximum = Feet{200000};
    if (validate(p)) result.push_back(p);
  }
  return result;
}

TEST(Export, isReadBackBitForBitFromJsonAlone) {
  for (const TuningParameters& parameters : samples()) {
    const test::ScratchDir dir;
    test::writeFile(dir / "e.json", exported(parameters, ExportFormat::json));
    const auto preset = loadPreset((dir / "e.json").string());
    ASSERT_TRUE(preset) << toString(preset.findings());
    EXPECT_TRUE(sameBits(preset->parameters, parameters));
    EXPECT_EQ(preset->name, kName);
    for (const Finding& f : preset.findings()) EXPECT_EQ(f.severity, Severity::warning) << toString(f);
  }
}

/// A value as the words that any format has to show, in order: a curve's x, y, x, y, ...; numbers exactly, by
/// printf.
std::vector<std::string> wordsOf(const ParameterRow& row, const ParameterValue& value) {
  std::vector<std::string> words;
  const auto number = [&words](double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%a", v);
    words.emplace_back(text);
  };
  if (const auto* v = std::get_if<double>(&value)) number(*v);
  if (const auto* v = std::get_if<bool>(&value)) words.emplace_back(*v ? "true" : "false");
  if (const auto* v = std::get_if<ChoiceIndex>(&value)) words.emplace_back(row.choices[v->index].name);
  if (const auto* v = std::get_if<CurvePoints>(&value))
    for (const CurvePoint& p : v->span()) number(p.x), number(p.y);
  if (const auto* v = std::get_if<BandList>(&value))
    for (const Band& b : v->span()) number(b.low), number(b.widthPx), number(b.heightPx);
  if (const auto* v = std::get_if<TextLines>(&value))
    for (const std::string& line : v->line) words.emplace_back(line);
  return words;
}

/// The same of a text found in a file; read by strtod, not by the reader that the library itself uses.
std::string wordOf(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') return text;
  char exact[32];
  std::snprintf(exact, sizeof exact, "%a", number);
  return exact;
}

void collect(const nlohmann::ordered_json& value, std::vector<std::string>& words) {
  if (value.is_structured()) {
    for (const auto& element : value) collect(element, words);
  } else {
    words.push_back(value.is_string() ? value.get<std::string>() : wordOf(value.dump()));
  }
}

TEST(Export, hasEveryKeyAndValueInJson) {
  for (const TuningParameters& parameters : samples()) {
    const auto json = nlohmann::ordered_json::parse(exported(parameters, ExportFormat::json));
    EXPECT_EQ(json.at("name"), kName);
    EXPECT_EQ(json.at("provenance").at("author"), kProvenance.author);
    EXPECT_EQ(json.at("provenance").at("created"), kProvenance.created);
    EXPECT_EQ(json.at("provenance").at("program"), kProvenance.program);
    EXPECT_EQ(json.at("provenance").at("terrain"), kProvenance.terrain);
    EXPECT_EQ(json.at("provenance").at("comment"), kProvenance.comment);
    EXPECT_EQ(json.at("parameters").size(), parameterRows().size());
    // One by hand, so that a row of the wrong field is seen too.
    EXPECT_EQ(json.at("parameters").at("view.near_m").get<double>(), parameters.view.nearDistance.value());
    for (const ParameterRow& row : parameterRows()) {
      std::vector<std::string> words;
      collect(json.at("parameters").at(std::string(row.key)), words);
      EXPECT_EQ(words, wordsOf(row, row.get(parameters))) << row.key;
    }
  }
}

/// The leaves of a property, which is a leaf itself or has numbered elements; `n` must count them.
std::vector<std::string> wordsOf(const pugi::xml_node& property) {
  std::vector<std::string> words;
  unsigned n = 0;
  for (const pugi::xml_node element : property.children()) {
    if (element.type() != pugi::node_element) return {wordOf(property.child_value())};
    EXPECT_EQ(element.attribute("n").as_uint(99), n++);
    for (const pugi::xml_node leaf : element.children()) words.push_back(wordOf(leaf.child_value()));
  }
  return words;
}

TEST(Export, hasEveryKeyAndValueInXml) {
  for (const TuningParameters& parameters : samples()) {
    pugi::xml_document document;
    ASSERT_TRUE(document.load_string(exported(parameters, ExportFormat::xml).c_str()));
    const pugi::xml_node root = document.child("PropertyList");
    const pugi::xml_node provenance = root.child("export").child("provenance");
    EXPECT_EQ(root.child("export").child_value("name"), kName);
    EXPECT_EQ(provenance.child_value("author"), kProvenance.author);
    EXPECT_EQ(provenance.child_value("created"), kProvenance.created);
    EXPECT_EQ(provenance.child_value("program"), kProvenance.program);
    EXPECT_EQ(provenance.child_value("terrain"), kProvenance.terrain);
    EXPECT_EQ(provenance.child_value("comment"), kProvenance.comment);
    for (const ParameterRow& row : parameterRows()) {
      pugi::xml_node node = root;
      std::istringstream path{std::string(row.key)};
      for (std::string part; std::getline(path, part, '.');) {
        const auto same = node.children(part.c_str());
        EXPECT_EQ(std::distance(same.begin(), same.end()), 1)
            << "two of one name are two properties: " << row.key;
        node = node.child(part.c_str());
      }
      EXPECT_EQ(wordsOf(node), wordsOf(row, row.get(parameters))) << row.key;
      const std::string type = node.attribute("type").value();
      if (row.kind == Kind::scalar) {
        EXPECT_EQ(type, row.whole ? "int" : "double") << row.key;
      }
    }
  }
}

/// Sections, keys and values of an INI file as awk sees it.
std::map<std::string, std::string> readIni(const std::string& text) {
  const test::ScratchDir dir;
  test::writeFile(dir / "e.ini", text);
  const test::Ran ran = test::run(
      R"(awk '/^[;#]/||/^$/{next} /^\[/{s=substr($0,2,length($0)-2);next} {i=index($0," = "); print s "|" substr($0,1,i-1) "|" substr($0,i+3)}' )" +
      (dir / "e.ini").string());
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  std::map<std::string, std::string> values;
  std::istringstream lines(ran.out);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t bar = line.find('|', line.find('|') + 1);
    EXPECT_TRUE(values.emplace(line.substr(0, bar), line.substr(bar + 1)).second) << line;
  }
  return values;
}

TEST(Export, hasEveryKeyAndValueInIni) {
  for (const TuningParameters& parameters : samples()) {
    const auto values = readIni(exported(parameters, ExportFormat::ini));
    EXPECT_EQ(values.at("export|name"), kName);
    EXPECT_EQ(values.at("provenance|author"), kProvenance.author);
    EXPECT_EQ(values.at("provenance|created"), kProvenance.created);
    EXPECT_EQ(values.at("provenance|program"), kProvenance.program);
    EXPECT_EQ(values.at("provenance|terrain"), kProvenance.terrain);
    EXPECT_EQ(values.at("provenance|comment"), "two\\nlines; # sha256: \\\\ end");
    EXPECT_EQ(values.size(), parameterRows().size() + 3 + 5 + 1);
    for (const ParameterRow& row : parameterRows()) {
      std::string text = values.at("parameters|" + std::string(row.key));
      if (row.kind == Kind::curve || row.kind == Kind::bands)
        std::replace_if(
            text.begin(), text.end(), [](char c) { return c == ':' || c == 'x'; }, ' ');
      if (row.kind == Kind::lines) {
        std::string lines;
        for (const std::string& line : wordsOf(row, row.get(parameters)))
          lines += (lines.empty() ? "" : " | ") + line;
        for (std::size_t at = 0; (at = lines.find('\\', at)) != std::string::npos; at += 2)
          lines.insert(at, 1, '\\');
        EXPECT_EQ(text, lines) << row.key;
        continue;
      }
      std::istringstream parts(text);
      std::vector<std::string> words;
      for (std::string part; parts >> part;) words.push_back(wordOf(part));
      EXPECT_EQ(words, wordsOf(row, row.get(parameters))) << row.key;
    }
  }
}

TEST(ExportChecksum, isTheSystemsSumOfEveryOtherByte) {
  if (test::run("sha256sum --version").exitCode != 0) GTEST_SKIP() << "needs sha256sum";
  for (const ExportFormat format : {ExportFormat::json, ExportFormat::xml, ExportFormat::ini}) {
    const std::string text = exported({}, format);
    std::smatch match;
    ASSERT_TRUE(std::regex_search(text, match, std::regex("sha256:([0-9a-f]{64})")));
    const test::ScratchDir dir;
    test::writeFile(dir / "rest", text.substr(0, static_cast<std::size_t>(match.position(1))) +
                                      text.substr(static_cast<std::size_t>(match.position(1)) + 64));
    EXPECT_EQ(test::run("sha256sum " + (dir / "rest").string()).out.substr(0, 64), match[1]);
    EXPECT_TRUE(checkSeal(text, "e"));
  }
}

TEST(ExportChecksum, refusesAChangeOfAnyBit) {
  std::string text = exported({}, ExportFormat::json);
  ASSERT_TRUE(parsePreset(text, "e"));
  for (char& c : text)
    for (int bit = 0; bit < 8; ++bit) {
      const char good = c;
      c = static_cast<char>(c ^ 1 << bit);
      ASSERT_FALSE(parsePreset(text, "e")) << &c - text.data() << " bit " << bit;
      c = good;
    }
  EXPECT_TRUE(parsePreset(text, "e"));
}

TEST(ExportChecksum, refusesCutsAndAdditions) {
  const std::string text = exported({}, ExportFormat::json);
  for (std::size_t length = 0; length < text.size(); length += 7)
    ASSERT_FALSE(parsePreset(text.substr(0, length), "e")) << length;
  EXPECT_FALSE(parsePreset(text.substr(0, text.size() - 1), "e")) << "the last line end counts";
  EXPECT_FALSE(parsePreset(text + "\n", "e"));
  EXPECT_FALSE(parsePreset(" " + text, "e"));
  EXPECT_FALSE(parsePreset(std::regex_replace(text, std::regex("\n"), "\r"), "e"));
}

TEST(ExportChecksum, holdsForXmlAndIniToo) {
  for (const ExportFormat format : {ExportFormat::xml, ExportFormat::ini}) {
    std::string text = exported({}, format);
    ASSERT_TRUE(checkSeal(text, "e"));
    for (char& c : text) {
      c = static_cast<char>(c ^ 1);
      ASSERT_FALSE(checkSeal(text, "e")) << &c - text.data();
      c = static_cast<char>(c ^ 1);
    }
  }
}

TEST(ExportChecksum, isWantedInItsOwnMember) {
  std::string text = exported({}, ExportFormat::json);
  text.replace(text.find("\"checksum\""), 10, "\"remark\"");
  text = sealed(text);
  EXPECT_TRUE(checkSeal(text, "e"));
  EXPECT_FALSE(parsePreset(text, "e")) << "a true sum in another place";
}

TEST(ExportChecksum, saysThatTheFileWasChanged) {
  std::string text = exported({}, ExportFormat::json);
  text.replace(text.find("16.7"), 4, "17.7");
  const auto preset = parsePreset(text, "e.json");
  ASSERT_FALSE(preset);
  EXPECT_EQ(preset.findings()[0].where, "e.json");
  EXPECT_EQ(preset.findings()[0].key, "checksum");
  EXPECT_THAT(preset.findings()[0].found, HasSubstr("changed after its export"));
}

TEST(Export, ofAnOlderProgramIsFilledUpAndSaysSo) {
  std::string text = exported({}, ExportFormat::json);
  const std::size_t at = text.find("    \"lod.scale\"");
  text.erase(at, text.find('\n', at) + 1 - at);
  const auto preset = parsePreset(sealed(text), "e.json");
  ASSERT_TRUE(preset) << toString(preset.findings());
  ASSERT_EQ(preset.findings().size(), 1u);
  EXPECT_EQ(preset.findings()[0].key, "lod.scale");
  EXPECT_EQ(preset.findings()[0].severity, Severity::warning);
}

}  // namespace
}  // namespace trimtab
