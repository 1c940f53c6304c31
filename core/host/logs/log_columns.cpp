#include "log_columns.h"

#include <algorithm>
#include <charconv>

#include "trimtab/units/text.h"

namespace trimtab {
namespace {

struct UnitWord {
  std::string_view word;
  Unit unit;
};
constexpr UnitWord kUnitWords[] = {
    {"deg", Unit::degrees},
    {"degs", Unit::degrees},
    {"degree", Unit::degrees},
    {"degrees", Unit::degrees},
    {"\xc2\xb0", Unit::degrees},
    {"rad", Unit::radians},
    {"rads", Unit::radians},
    {"radian", Unit::radians},
    {"radians", Unit::radians},
    {"s", Unit::seconds},
    {"sec", Unit::seconds},
    {"secs", Unit::seconds},
    {"second", Unit::seconds},
    {"seconds", Unit::seconds},
    {"ms", Unit::milliseconds},
    {"msec", Unit::milliseconds},
    {"millis", Unit::milliseconds},
    {"millisecond", Unit::milliseconds},
    {"us", Unit::microseconds},
    {"usec", Unit::microseconds},
    {"micros", Unit::microseconds},
    {"ns", Unit::nanoseconds},
    {"nsec", Unit::nanoseconds},
    {"milliseconds", Unit::milliseconds},
    {"nanos", Unit::nanoseconds},
    {"ft", Unit::feet},
    {"microseconds", Unit::microseconds},
    {"feet", Unit::feet},
    {"foot", Unit::feet},
    {"nanoseconds", Unit::nanoseconds},
    {"m", Unit::metres},
    {"metre", Unit::metres},
    {"metres", Unit::metres},
    {"meter", Unit::metres},
    {"meters", Unit::metres},
    {"microsecond", Unit::microseconds},
    {"nanosecond", Unit::nanoseconds},
};

Unit unitOf(std::string_view word) {
  for (const UnitWord& row : kUnitWords)
    if (row.word == word) return row.unit;
  return Unit::none;
}

/// "Lcl Time" and "lcl-time" are lcl_time.
std::string normalised(std::string_view text) {
  std::string name;
  for (char c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const bool letter = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || (c & 0x80) != 0;
    if (letter)
      name += c;
    else if (!name.empty() && name.back() != '_')
      name += '_';
  }
  while (name.ends_with('_')) name.pop_back();
  return name;
}

}  // namespace

ColumnName columnName(std::string_view text) {
  text = trimmed(text);
  Unit unit = Unit::none;
  if (text.ends_with(')') || text.ends_with(']'))
    if (const std::size_t open = text.find_last_of("(["); open != std::string_view::npos) {
      unit = unitOf(normalised(text.substr(open)));
      if (unit != Unit::none) text = text.substr(0, open);
    }
  if (const std::size_t path = text.rfind('/'); path != std::string_view::npos && path + 1 < text.size())
    text.remove_prefix(path + 1);
  std::string base = normalised(text);
  const std::size_t last = base.rfind('_');
  if (unit == Unit::none && last != std::string::npos) {
    unit = unitOf(std::string_view(base).substr(last + 1));
    if (unit != Unit::none) base.resize(last);
  }
  return {std::move(base), unit};
}

std::string_view LogColumn::cell(const std::vector<std::string_view>& cells) const {
  const std::string_view whole = cells[place];
  const std::size_t comma = part == 0 ? std::string_view::npos : whole.find(',');
  if (part == 0) return whole;
  if (comma == std::string_view::npos) return {};
  return trimmed(part == 1 ? whole.substr(0, comma) : whole.substr(comma + 1));
}

LogColumns::LogColumns(const std::vector<std::string>& header) : header_(header) {
  for (const std::string& cell : header) names_.push_back(columnName(cell));
}

std::optional<LogColumn> LogColumns::find(std::span<const std::string_view> bases,
                                          std::span<const Unit> units, bool& twice) const {
  for (const std::string_view base : bases)
    for (const Unit unit : units) {
      std::optional<LogColumn> found;
      for (std::size_t i = 0; i < names_.size(); ++i) {
        if (names_[i].unit != unit || names_[i].base != base) continue;
        twice |= found.has_value();
        // A column "seconds" is named after its unit alone.
        if (!found) found = LogColumn{i, 0, header_[i], unit == Unit::none ? unitOf(base) : unit};
      }
      if (found) return found;
    }
  return std::nullopt;
}

std::optional<std::size_t> LogColumns::placeOf(std::string_view name, bool toTheLetter) const {
  std::size_t number = 0;
  if (name.starts_with('#')) {
    const auto [end, error] = std::from_chars(name.data() + 1, name.data() + name.size(), number);
    if (error == std::errc{} && end == name.data() + name.size() && number >= 1 && number <= header_.size())
      return number - 1;
  }
  const auto only = [this](const auto& matches) -> std::optional<std::size_t> {
    const auto at = std::find_if(header_.begin(), header_.end(), matches);
    if (at == header_.end() || std::find_if(at + 1, header_.end(), matches) != header_.end())
      return std::nullopt;
    return static_cast<std::size_t>(at - header_.begin());
  };
  if (const auto exact = only([&](const std::string& cell) { return trimmed(cell) == trimmed(name); });
      exact || toTheLetter)
    return exact;
  return only([wanted = normalised(name)](const std::string& cell) {
    return !wanted.empty() && normalised(cell) == wanted;
  });
}

std::optional<LogColumn> LogColumns::find(const ColumnSource& source) const {
  const auto column = [&](std::size_t place) { return LogColumn{place, 0, header_[place]}; };
  if (const auto place = placeOf(source.written, true)) return column(*place);
  std::string_view name = source.column;
  auto place = placeOf(name);
  std::size_t part = 0;
  if (!place && (name.ends_with("[1]") || name.ends_with("[2]"))) {
    part = name.ends_with("[1]") ? 1 : 2;
    place = placeOf(name.substr(0, name.size() - 3));
  }
  if (!place) return std::nullopt;
  LogColumn found = column(*place);
  found.part = part;
  found.scale = source.scale;
  found.offset = source.offset;
  return found;
}

}  // namespace trimtab
