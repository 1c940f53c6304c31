#include "trimtab/preset/json_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "trimtab/units/number.h"

namespace trimtab::json {

namespace {

using Json = nlohmann::json;

/// Takes every event and keeps only the error, so that checking a file builds nothing.
struct SyntaxCheck : nlohmann::json_sax<Json> {
  std::size_t offset = 0;
  std::string reason;

  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(string_t&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    offset = position;
    reason = error.what();
    return false;
  }
};

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

void skipBlanks(std::string_view text, std::size_t& at) {
  while (at < text.size() && isBlank(text[at])) ++at;
}

/// Moves from an opening quote to behind the closing one.
void skipString(std::string_view text, std::size_t& at) {
  for (++at; at < text.size() && text[at] != '"'; ++at)
    if (text[at] == '\\') ++at;
  at = std::min(at + 1, text.size());
}

/// Moves from the first character of a value to behind its last. Counts brackets instead of recursing: files
/// nest as they like.
void skipValue(std::string_view text, std::size_t& at) {
  std::size_t depth = 0;
  while (at < text.size()) {
    const char c = text[at];
    if (c == '"') {
      skipString(text, at);
    } else {
      if (depth == 0 && (c == ',' || c == '}' || c == ']' || isBlank(c))) return;
      if (c == '{' || c == '[') ++depth;
      if (c == '}' || c == ']') --depth;
      ++at;
    }
    if (depth == 0 && (c == '"' || c == '}' || c == ']')) return;
  }
}

std::optional<double> readFinite(std::string_view value) {
  const std::optional<double> number = readNumber(value);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

Finding unlike(std::string expected, std::string_view found) {
  constexpr std::size_t kShown = 60;
  std::string text(found.substr(0, kShown));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  if (found.size() > kShown) text += "...";
  return {Severity::error, "", "", std::move(expected), std::move(text)};
}

/// Each element of an array of `width` numbers; none where the text is anything else.
std::optional<std::vector<double>> readTuple(std::string_view value, std::size_t width) {
  const auto parts = elements(value);
  if (parts.size() != width) return std::nullopt;
  std::vector<double> numbers;
  for (const std::string_view part : parts) {
    const auto number = readFinite(part);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

Result<ParameterValue> readCurve(std::string_view value) {
  if (value.empty() || value.front() != '[') return unlike("a list of points [x, y]", value);
  const auto parts = elements(value);
  if (parts.size() > CurvePoints::kCapacity)
    return unlike("at most " + std::to_string(CurvePoints::kCapacity) + " points",
                  std::to_string(parts.size()));
  CurvePoints curve;
  for (const std::string_view part : parts) {
    const auto point = readTuple(part, 2);
    if (!point) return unlike("a point [x, y]", part);
    curve.point[curve.size++] = {(*point)[0], (*point)[1]};
  }
  return ParameterValue{curve};
}

Result<ParameterValue> readBands(std::string_view value) {
  if (value.empty() || value.front() != '[') return unlike("a list of bands [low, width, height]", value);
  const auto parts = elements(value);
  if (parts.size() > BandList::kCapacity)
    return unlike("at most " + std::to_string(BandList::kCapacity) + " bands", std::to_string(parts.size()));
  BandList bands;
  for (const std::string_view part : parts) {
    const auto band = readTuple(part, 3);
    if (!band) return unlike("a band [low, width, height]", part);
    for (const double px : {(*band)[1], (*band)[2]})
      if (px != std::floor(px) || std::abs(px) > std::numeric_limits<int>::max())
        return unlike("whole numbers as width and height", part);
    bands.band[bands.size++] = {(*band)[0], static_cast<int>((*band)[1]), static_cast<int>((*band)[2])};
  }
  return ParameterValue{bands};
}

Result<ParameterValue> readLines(std::string_view value) {
  if (value.empty() || value.front() != '[') return unlike("a list of lines", value);
  TextLines lines;
  for (const std::string_view part : elements(value)) {
    const auto line = readString(part);
    if (!line) return unlike("a string as line " + std::to_string(lines.line.size() + 1), part);
    const std::size_t begin = std::min(line->find_first_not_of(' '), line->size());
    lines.line.push_back(line->substr(begin, line->find_last_not_of(' ') + 1 - begin));
  }
  return ParameterValue{std::move(lines)};
}

std::string choiceNames(const ParameterRow& row) {
  std::string names;
  for (const ChoiceOption& option : row.choices)
    names += (names.empty() ? "\"" : ", \"") + std::string(option.name) + '"';
  return names;
}

}  // namespace

Result<Done> checkSyntax(std::string_view text, const std::string& where) {
  SyntaxCheck check;
  if (Json::sax_parse(text.begin(), text.end(), &check)) return Done{};
  // "[json.exception.parse_error.101] parse error at line 3, column 7: what happened"
  std::string reason = check.reason;
  // A text without its closing quote is quoted whole.
  constexpr std::size_t kLongestReason = 300;
  if (reason.size() > kLongestReason) reason.replace(kLongestReason, std::string::npos, " ...");
  if (const std::size_t end = reason.find("] "); end != std::string::npos) reason.erase(0, end + 2);
  if (const std::size_t end = reason.find(": ");
      end != std::string::npos && reason.starts_with("parse error"))
    reason.erase(0, end + 2);
  for (char& c : reason)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  const std::size_t offset = check.offset == 0 ? 0 : std::min(check.offset, text.size()) - 1;
  return Finding{Severity::error, place(where, text, text.empty() ? 0 : offset), "", "JSON",
                 stringText(reason)};
}

std::vector<Member> members(std::string_view object, std::string_view whole) {
  std::vector<Member> found;
  if (!isObject(object)) return found;
  const std::size_t base = static_cast<std::size_t>(object.data() - whole.data());
  for (std::size_t at = 1; at < object.size();) {
    skipBlanks(object, at);
    if (at >= object.size() || object[at] != '"') break;
    const std::size_t keyAt = at;
    skipString(object, at);
    std::string key = readString(object.substr(keyAt, at - keyAt)).value_or("");
    skipBlanks(object, at);
    ++at;  // the colon
    skipBlanks(object, at);
    const std::size_t begin = at;
    skipValue(object, at);
    found.push_back({std::move(key), object.substr(begin, at - begin), base + keyAt});
    skipBlanks(object, at);
    if (at < object.size() && object[at] == ',') ++at;
  }
  return found;
}

std::vector<std::string_view> elements(std::string_view array) {
  std::vector<std::string_view> found;
  if (array.empty() || array.front() != '[') return found;
  for (std::size_t at = 1; at < array.size();) {
    skipBlanks(array, at);
    if (at >= array.size() || array[at] == ']') break;
    const std::size_t begin = at;
    skipValue(array, at);
    found.push_back(array.substr(begin, at - begin));
    skipBlanks(array, at);
    if (at < array.size() && array[at] == ',') ++at;
  }
  return found;
}

bool isObject(std::string_view value) {
  return !value.empty() && value.front() == '{';
}

std::optional<std::string> readString(std::string_view value) {
  if (value.empty() || value.front() != '"') return std::nullopt;
  const Json string = Json::parse(value.begin(), value.end(), nullptr, false);
  if (!string.is_string()) return std::nullopt;
  return string.get<std::string>();
}

std::string stringText(std::string_view text) {
  return Json(std::string(text)).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string valueText(const ParameterRow& row, const ParameterValue& value) {
  std::string text;
  const auto append = [&text](const std::string& tuple) {
    text += (text.empty() ? "[" : ", [") + tuple + "]";
  };
  switch (row.kind) {
    case Kind::scalar:
    case Kind::flag:
      return toText(row, value);
    case Kind::choice:
      return stringText(toText(row, value));
    case Kind::curve:
      for (const CurvePoint& p : std::get<CurvePoints>(value).span())
        append(numberText(p.x) + ", " + numberText(p.y));
      break;
    case Kind::bands:
      for (const Band& b : std::get<BandList>(value).span())
        append(numberText(b.low) + ", " + std::to_string(b.widthPx) + ", " + std::to_string(b.heightPx));
      break;
    case Kind::lines:
      for (const std::string& line : std::get<TextLines>(value).line)
        text += (text.empty() ? "" : ", ") + stringText(line);
      break;
  }
  return "[" + text + "]";
}

Result<ParameterValue> readValue(const ParameterRow& row, std::string_view value) {
  switch (row.kind) {
    case Kind::scalar: {
      const auto number = readFinite(value);
      if (number) return ParameterValue{*number};
      return unlike(row.unit.empty() ? "a number" : "a number in " + std::string(row.unit), value);
    }
    case Kind::flag:
      if (value == "true" || value == "false") return ParameterValue{value == "true"};
      return unlike("true or false", value);
    case Kind::choice: {
      const auto name = readString(value);
      for (std::size_t i = 0; name && i < row.choices.size(); ++i)
        if (row.choices[i].name == *name) return ParameterValue{ChoiceIndex{i}};
      return unlike("one of " + choiceNames(row), value);
    }
    case Kind::curve:
      return readCurve(value);
    case Kind::bands:
      return readBands(value);
    case Kind::lines:
      return readLines(value);
  }
  return unlike("a value", value);
}

std::string place(const std::string& where, std::string_view whole, std::size_t offset) {
  return Places(where, whole).at(offset);
}

std::string Places::at(std::size_t offset) {
  if (offset < read_) read_ = 0, line_ = 1;
  const std::string_view next = whole_.substr(read_, offset - read_);
  line_ += static_cast<std::size_t>(std::count(next.begin(), next.end(), '\n'));
  read_ += next.size();
  return where_ + ":" + std::to_string(line_);
}

}  // namespace trimtab::json
