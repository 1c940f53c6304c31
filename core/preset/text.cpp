#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "preset_text.h"
#include "trimtab/preset/table.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {

namespace {

/// Returns the text up to the next blank, which is removed from `rest`; empty at the end.
std::string_view nextWord(std::string_view& rest) {
  rest = trimmed(rest);
  const std::string_view word = rest.substr(0, rest.find_first_of(" \t\r\n"));
  rest.remove_prefix(word.size());
  return word;
}

struct TypedUnit {
  std::string_view symbol;
  char dimension;
  double size;
};
template <class U>
constexpr TypedUnit typed(char dimension, std::string_view symbol = U::symbol) {
  return {symbol, dimension, U::size};
}
constexpr std::array kTypedUnits{typed<unit::Metre>('l'),
                                 typed<unit::Foot>('l'),
                                 typed<unit::Degree>('a'),
                                 typed<unit::Radian>('a'),
                                 typed<unit::Degree>('a', "deg"),
                                 typed<unit::Second>('t'),
                                 typed<unit::Millisecond>('t'),
                                 typed<unit::MetrePerSecond>('v'),
                                 typed<unit::Knot>('v'),
                                 typed<unit::DegreePerSecond>('w'),
                                 typed<unit::DegreePerSecond>('w', "deg/s"),
                                 typed<unit::Pixel>('p'),
                                 typed<unit::Megabyte>('s')};

const TypedUnit* typedUnit(std::string_view symbol) {
  const auto at = std::find_if(kTypedUnits.begin(), kTypedUnits.end(),
                               [&](const TypedUnit& u) { return u.symbol == symbol; });
  return at == kTypedUnits.end() ? nullptr : &*at;
}

Finding refused(const ParameterRow& row, std::string expected, std::string_view found) {
  constexpr std::size_t kShown = 80;
  const std::string shown = std::string(found.substr(0, kShown)) + (found.size() > kShown ? "..." : "");
  return {Severity::error, "", std::string(row.key), std::move(expected), "\"" + shown + "\""};
}

Result<ParameterValue> parseScalar(const ParameterRow& row, std::string_view text) {
  const std::string_view word = trimmed(text);
  const std::size_t digits = word.find_last_of("0123456789.");
  const std::string expected = row.unit.empty() ? "a number" : "a number in " + std::string(row.unit);
  if (digits == std::string_view::npos) return refused(row, expected, text);
  const std::optional<double> number = readNumber(trimmed(word.substr(0, digits + 1)));
  if (!number || !std::isfinite(*number)) return refused(row, expected, text);
  const std::string_view symbol = trimmed(word.substr(digits + 1));
  if (symbol.empty() || symbol == row.unit) return ParameterValue{*number};
  const TypedUnit* const from = typedUnit(symbol);
  const TypedUnit* const to = typedUnit(row.unit);
  if (!from || !to || from->dimension != to->dimension) return refused(row, expected, text);
  const double converted = from->size == to->size ? *number : *number * (from->size / to->size);
  if (!std::isfinite(converted)) return refused(row, expected, text);
  return ParameterValue{converted};
}

Result<ParameterValue> parseFlag(const ParameterRow& row, std::string_view text) {
  const std::string_view word = trimmed(text);
  for (std::string_view yes : {"true", "on", "yes", "1"})
    if (word == yes) return ParameterValue{true};
  for (std::string_view no : {"false", "off", "no", "0"})
    if (word == no) return ParameterValue{false};
  return refused(row, "true or false", text);
}

Result<ParameterValue> parseChoice(const ParameterRow& row, std::string_view text) {
  std::string names;
  for (std::size_t i = 0; i < row.choices.size(); ++i) {
    if (row.choices[i].name == trimmed(text)) return ParameterValue{ChoiceIndex{i}};
    names += (i == 0 ? "" : ", ") + std::string(row.choices[i].name);
  }
  return refused(row, "one of " + names, text);
}

Result<ParameterValue> parseCurve(const ParameterRow& row, std::string_view text) {
  CurvePoints curve;
  std::string_view rest = text;
  for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) {
    const std::size_t colon = word.find(':');
    if (colon == std::string_view::npos) return refused(row, "points as x:y, blanks between", word);
    const auto x = readNumber(word.substr(0, colon)), y = readNumber(word.substr(colon + 1));
    if (!x || !y || !std::isfinite(*x) || !std::isfinite(*y))
      return refused(row, "points as x:y, blanks between", word);
    if (curve.size == CurvePoints::kCapacity)
      return refused(row, "at most " + std::to_string(CurvePoints::kCapacity) + " points", text);
    curve.point[curve.size++] = {*x, *y};
  }
  return ParameterValue{curve};
}

Result<ParameterValue> parseBands(const ParameterRow& row, std::string_view text) {
  BandList bands;
  std::string_view rest = text;
  for (std::string_view word = nextWord(rest); !word.empty(); word = nextWord(rest)) {
    const char* const expected = "bands as low:WIDTHxHEIGHT, blanks between";
    const std::size_t colon = word.find(':'), cross = word.find('x');
    if (colon == std::string_view::npos || cross == std::string_view::npos || cross < colon)
      return refused(row, expected, word);
    const auto low = readNumber(word.substr(0, colon));
    const auto width = readNumber(word.substr(colon + 1, cross - colon - 1)),
               height = readNumber(word.substr(cross + 1));
    const auto isSize = [](const std::optional<double>& px) {
      return px && *px >= 0 && *px <= std::numeric_limits<int>::max() && *px == std::floor(*px);
    };
    if (!low || !std::isfinite(*low) || !isSize(width) || !isSize(height))
      return refused(row, expected, word);
    if (bands.size == BandList::kCapacity)
      return refused(row, "at most " + std::to_string(BandList::kCapacity) + " bands", text);
    bands.band[bands.size++] = {*low, static_cast<int>(*width), static_cast<int>(*height)};
  }
  return ParameterValue{bands};
}

/// Between lines is a | or the end of a line; \| and \\ are those characters. Empty lines mean nothing.
ParameterValue parseLines(std::string_view text) {
  TextLines lines;
  std::string line;
  const auto add = [&] {
    if (const std::string_view content = trimmed(line); !content.empty()) lines.line.emplace_back(content);
    line.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool escape = text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == '|' || text[i + 1] == '\\');
    if (escape)
      line += text[++i];
    else if (text[i] == '|' || text[i] == '\n')
      add();
    else
      line += text[i];
  }
  add();
  return lines;
}

}  // namespace

std::string lineAsText(std::string_view line) {
  std::string text;
  for (const char c : line) text += (c == '|' || c == '\\' ? "\\" : "") + std::string(1, c);
  return text;
}

std::string toText(const ParameterRow& row, const ParameterValue& value) {
  switch (row.kind) {
    case Kind::scalar:
      return numberText(std::get<double>(value));
    case Kind::flag:
      return std::get<bool>(value) ? "true" : "false";
    case Kind::choice: {
      const std::size_t index = std::get<ChoiceIndex>(value).index;
      return index < row.choices.size() ? std::string(row.choices[index].name) : "#" + std::to_string(index);
    }
    case Kind::curve: {
      std::string text;
      for (const CurvePoint& p : std::get<CurvePoints>(value).span())
        text += (text.empty() ? "" : " ") + numberText(p.x) + ":" + numberText(p.y);
      return text;
    }
    case Kind::bands: {
      std::string text;
      for (const Band& b : std::get<BandList>(value).span())
        text += (text.empty() ? "" : " ") + numberText(b.low) + ":" + std::to_string(b.widthPx) + "x" +
                std::to_string(b.heightPx);
      return text;
    }
    case Kind::lines: {
      std::string text;
      for (const std::string& line : std::get<TextLines>(value).line)
        text += (text.empty() ? "" : " | ") + lineAsText(line);
      return text;
    }
  }
  return {};
}

Result<ParameterValue> parseValue(const ParameterRow& row, std::string_view text) {
  switch (row.kind) {
    case Kind::scalar:
      return parseScalar(row, text);
    case Kind::flag:
      return parseFlag(row, text);
    case Kind::choice:
      return parseChoice(row, text);
    case Kind::curve:
      return parseCurve(row, text);
    case Kind::bands:
      return parseBands(row, text);
    case Kind::lines:
      return parseLines(text);
  }
  return refused(row, "a value", text);
}

}  // namespace trimtab
