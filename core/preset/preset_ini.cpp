#include <algorithm>

#include "preset_text.h"
#include "trimtab/preset/json_text.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {

namespace {

constexpr std::string_view kTextKeys[] = {"format",  "name",    "author",  "created",
                                          "program", "terrain", "comment", "checksum"};

/// Undoes what an export does to a text of several lines.
std::string unescaped(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char next = text[i] == '\\' && i + 1 < text.size() ? text[i + 1] : '\0';
    if (next == 'n' || next == 'r' || next == 't' || next == '\\') {
      result += next == 'n' ? '\n' : next == 'r' ? '\r' : next == 't' ? '\t' : '\\';
      ++i;
    } else {
      result += text[i];
    }
  }
  return result;
}

}  // namespace

bool looksLikeIni(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  return text.starts_with(';') || text.starts_with('#') || text.starts_with("[export]");
}

Result<std::string> jsonOf(const std::string& key, std::string_view plain) {
  if (const ParameterRow* const row = findRow(key)) {
    const Result<ParameterValue> value = parseValue(*row, plain);
    if (value) return json::valueText(*row, *value);
    // A choice of a former version may be one that migration replaces.
    if (row->kind == Kind::choice) return json::stringText(trimmed(plain));
    return value.findings();
  }
  const bool isText = std::find(std::begin(kTextKeys), std::end(kTextKeys), key) != std::end(kTextKeys);
  // A text that reads as a number but is none in JSON, such as "8." and "nan", stays a text.
  const bool isNumber = !isText && readNumber(plain) && json::checkSyntax(plain, key);
  return isNumber ? std::string(plain) : json::stringText(plain);
}

std::string keyOf(std::string_view plain) {
  return json::readString(json::stringText(plain)).value_or(std::string());
}

Result<PresetText> readIniExport(std::string_view text, const std::string& where) {
  PresetText file;
  FindingList findings;
  std::string_view section;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string place = where + ":" + std::to_string(number);
    const auto refuse = [&](std::string key, std::string expected) {
      findings.add(
          {Severity::error, place, std::move(key), std::move(expected), std::string(line.substr(0, 60))});
    };
    if (line.empty() || line.front() == ';' || line.front() == '#') continue;
    if (line.front() == '[') {
      section = line.back() == ']' ? line.substr(1, line.size() - 2) : std::string_view();
      if (section != "export" && section != "provenance" && section != "parameters" && section != "seal")
        refuse("", "[export], [provenance], [parameters] or [seal]");
      continue;
    }
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) {
      refuse("", "key = value");
      continue;
    }
    const std::string key = keyOf(trimmed(line.substr(0, equals)));
    const std::string_view value = trimmed(line.substr(equals + 1));
    if (section == "provenance") continue;
    const bool isParameter = section == "parameters";
    const Result<std::string> asJson = jsonOf(key, isParameter ? std::string(value) : unescaped(value));
    if (asJson) {
      (isParameter ? file.parameters : file.members).push_back({key, *asJson, place});
      continue;
    }
    for (Finding f : asJson.findings()) {
      f.where = place;
      findings.add(std::move(f));
    }
  }
  if (!findings.empty()) return findings.all(where);
  return file;
}

}  // namespace trimtab
