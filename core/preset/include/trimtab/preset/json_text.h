#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/preset/table.h"

/// JSON seen as text, so that findings have lines, unknown values are kept to the byte and numbers are read
/// bit for bit.
namespace trimtab::json {

/// Whether the text is one JSON value, with the place and reason where it is not.
Result<Done> checkSyntax(std::string_view text, const std::string& where);

struct Member {
  std::string key;
  std::string_view value;  ///< its text, without surrounding blanks
  std::size_t at = 0;      ///< offset of the key in the text that checkSyntax saw
};

/// Members of an object whose text (a part of `whole`) passed checkSyntax, in the file's order, doubles
/// included. Empty where the text is no object.
std::vector<Member> members(std::string_view object, std::string_view whole);

bool isObject(std::string_view value);
/// The string that a JSON string's text stands for; none where the value is no string.
std::optional<std::string> readString(std::string_view value);
/// The JSON text of a string; bytes that are no UTF-8 become U+FFFD.
std::string stringText(std::string_view text);

/// The value of a parameter as JSON text, on one line: number, true, "choice", [[x, y], ...], [[low, width,
/// height], ...], [{"altitude": "low", ...}, ...].
std::string valueText(const ParameterRow& row, const ParameterValue& value);
/// Its inverse, from text that passed checkSyntax. The finding has neither place nor key.
Result<ParameterValue> readValue(const ParameterRow& row, std::string_view value);

/// "file:12", by the line of an offset.
std::string place(const std::string& where, std::string_view whole, std::size_t offset);

}  // namespace trimtab::json
