#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "migration.h"
#include "trimtab/units/result.h"

namespace trimtab {

/// A preset file as its format writes it: nothing is interpreted, and every part knows its line.
struct PresetText {
  std::vector<RawParameter> members;     ///< format, version, name, ..., checksum; each value as JSON text
  std::vector<RawParameter> parameters;  ///< in the file's order, doubles included
};

/// Reports whether a file begins as an XML document (`<`), or as an INI file (`;`, `#` or `[`). No JSON
/// preset begins like either.
bool looksLikeXml(std::string_view text);
bool looksLikeIni(std::string_view text);

/// Reads an export that is a FlightGear property list. It refuses what our exports never have: a document
/// type (and with it every entity of its own), an encoding other than UTF-8, and elements nested deeper than
/// any key.
Result<PresetText> readXmlExport(std::string_view text, const std::string& where);
/// Reads an export that is an INI file. Comments begin with `;` or `#` at the start of a line.
Result<PresetText> readIniExport(std::string_view text, const std::string& where);

/// Returns a value that a format writes as plain text in the JSON text that a PresetText holds. The key
/// decides: a parameter of this version has its own form; anything else is a number or a string.
Result<std::string> jsonOf(const std::string& key, std::string_view plain);

/// Returns a key of a format that may hold any bytes as a preset can hold it: bytes that are not UTF-8 become
/// U+FFFD.
std::string keyOf(std::string_view plain);

/// Returns a line of TextLines so that ` | ` may stand between it and others.
std::string lineAsText(std::string_view line);

}  // namespace trimtab
