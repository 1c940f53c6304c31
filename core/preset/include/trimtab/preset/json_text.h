#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trimtab/preset/table.h"

/// Reads JSON as text, so that findings have lines, unknown values are kept to the byte and numbers are read
/// bit for bit.
namespace trimtab::json {

/// Checks that the text is one JSON value. The finding has the place and the reason.
Result<Done> checkSyntax(std::string_view text, const std::string& where);

struct Member {
  std::string key;
  std::string_view value;  ///< its text, without surrounding blanks
  std::size_t at = 0;      ///< offset of the key in the text that checkSyntax saw
};

/// Returns the members of an object, in the file's order, repeated keys included. `object` is a part of
/// `whole`, which must have passed checkSyntax. Returns nothing if it is no object.
std::vector<Member> members(std::string_view object, std::string_view whole);

/// Returns the elements of an array that passed checkSyntax.
std::vector<std::string_view> elements(std::string_view array);

bool isObject(std::string_view value);
/// Returns the string that a JSON string stands for; nothing if the value is no string.
std::optional<std::string> readString(std::string_view value);
/// Returns a string as JSON text. Bytes that are not UTF-8 become U+FFFD.
std::string stringText(std::string_view text);

/// Returns the value of a parameter as JSON text on one line: number, true, "choice", [[x, y], ...], [[low,
/// width, height], ...], ["line", ...].
std::string valueText(const ParameterRow& row, const ParameterValue& value);
/// Is the inverse, from text that passed checkSyntax. Its finding has neither place nor key.
Result<ParameterValue> readValue(const ParameterRow& row, std::string_view value);

/// Returns "file:12" for an offset in line 12. Reads the text up to there.
std::string place(const std::string& where, std::string_view whole, std::size_t offset);

/// Returns the same for many offsets, and reads the text once if they rise.
class Places {
 public:
  /// Both must outlive it.
  Places(const std::string& where, std::string_view whole) : where_(where), whole_(whole) {}
  std::string at(std::size_t offset);

 private:
  const std::string& where_;
  std::string_view whole_;
  std::size_t read_ = 0, line_ = 1;
};

}  // namespace trimtab::json
