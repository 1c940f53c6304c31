#pragma once

#include <array>
#include <cstddef>
#include <type_traits>

#include "trimtab/preset/choices.h"
#include "trimtab/preset/table.h"

/// Declares how one field becomes one row, and what the compiler checks of the table. Only rows.cpp and tests
/// need it.
namespace trimtab::table {

/// Says what a row says beyond what its field's type says.
struct RowText {
  std::string_view key{}, label{}, help{}, source{};
  Range hard{}, usual{};
  double step = 1;
  int decimals = 0;
  Tier tier = Tier::basic;
  Effect effect = Effect::next_frame;
  bool logarithmic = false;
  bool whole = false;
};

/// A row and which field it is for, so that the table can be checked for completeness.
struct CheckedRow {
  ParameterRow row;
  const void* field = nullptr;
  const void* group = nullptr;
  std::size_t fieldsInGroup = 0;
};

/// Converts to anything: as many of them as an aggregate takes is its number of fields.
struct Anything {
  template <class T>
  constexpr operator T() const;
};

template <class T, class... Filled>
consteval std::size_t fieldCount() {
  if constexpr (requires { T{Filled{}..., Anything{}}; })
    return fieldCount<T, Filled..., Anything>();
  else
    return sizeof...(Filled);
}

template <class T>
inline constexpr bool kIsQuantity = false;
template <class U>
inline constexpr bool kIsQuantity<Quantity<U>> = true;

template <class T>
struct FieldKind;
template <class U>
struct FieldKind<Quantity<U>> {
  using Unit = U;
  static constexpr Kind kind = Kind::scalar;
};
template <>
struct FieldKind<bool> {
  using Unit = unit::Ratio;
  static constexpr Kind kind = Kind::flag;
};
template <class X>
struct FieldKind<Curve<X>> {
  using Unit = typename X::Unit;
  static constexpr Kind kind = Kind::curve;
};
template <>
struct FieldKind<BandList> {
  using Unit = unit::Pixel;
  static constexpr Kind kind = Kind::bands;
};
template <>
struct FieldKind<TextLines> {
  using Unit = unit::Ratio;
  static constexpr Kind kind = Kind::lines;
};
template <class E>
requires std::is_enum_v<E>
struct FieldKind<E> {
  using Unit = unit::Ratio;
  static constexpr Kind kind = Kind::choice;
};

inline constexpr TuningParameters kDefaults{};

template <class T>
constexpr ParameterValue toValue(const T& field) {
  if constexpr (kIsQuantity<T>)
    return field.value();
  else if constexpr (std::is_enum_v<T>)
    return ChoiceIndex{static_cast<std::size_t>(field)};
  else if constexpr (FieldKind<T>::kind == Kind::curve)
    return static_cast<const CurvePoints&>(field);
  else
    return field;
}

template <auto Group, auto Field>
ParameterValue getField(const TuningParameters& parameters) {
  return toValue(parameters.*Group.*Field);
}

template <auto Group, auto Field>
void setField(TuningParameters& parameters, const ParameterValue& value) {
  auto& field = parameters.*Group.*Field;
  using T = std::remove_reference_t<decltype(field)>;
  if constexpr (kIsQuantity<T>)
    field = T{std::get<double>(value)};
  else if constexpr (std::is_enum_v<T>)
    field = static_cast<T>(std::get<ChoiceIndex>(value).index);
  else if constexpr (FieldKind<T>::kind == Kind::curve)
    static_cast<CurvePoints&>(field) = std::get<CurvePoints>(value);
  else
    field = std::get<T>(value);
}

/// Text that a key is put together from.
template <std::size_t N>
struct Literal {
  char text[N]{};
  consteval Literal(const char (&from)[N]) {
    for (std::size_t i = 0; i < N; ++i) text[i] = from[i];
  }
};

template <Literal A, Literal B>
struct Concatenated {
  static constexpr std::size_t kSize = sizeof(A.text) + sizeof(B.text) - 2;
  static constexpr auto kText = [] {
    std::array<char, kSize> all{};
    std::size_t next = 0;
    for (std::size_t i = 0; i + 1 < sizeof(A.text); ++i) all[next++] = A.text[i];
    for (std::size_t i = 0; i + 1 < sizeof(B.text); ++i) all[next++] = B.text[i];
    return all;
  }();
  static constexpr std::string_view kView{kText.data(), kSize};
};

constexpr bool endsInSomeUnit(std::string_view key) {
  for (std::string_view suffix :
       {unit::Metre::suffix, unit::Foot::suffix, unit::Degree::suffix, unit::Radian::suffix,
        unit::Second::suffix, unit::Millisecond::suffix, unit::MetrePerSecond::suffix, unit::Knot::suffix,
        unit::DegreePerSecond::suffix, unit::Pixel::suffix, unit::Megabyte::suffix})
    if (key.ends_with(suffix)) return true;
  return false;
}

constexpr bool within(double value, Range range) {
  return value >= range.low && value <= range.high;
}

/// Makes the row of one field. A row that contradicts its field does not compile; the throw that the compiler
/// quotes says why.
template <auto Group, auto Field>
consteval CheckedRow row(const RowText& text) {
  constexpr const auto& group = kDefaults.*Group;
  constexpr const auto& field = group.*Field;
  using T = std::remove_cvref_t<decltype(field)>;
  using Unit = typename FieldKind<T>::Unit;
  constexpr Kind kind = FieldKind<T>::kind;

  if (text.key.empty() || text.label.empty() || text.help.empty()) throw "key, label and help are needed";
  if (Unit::suffix.empty() ? endsInSomeUnit(text.key) : !text.key.ends_with(Unit::suffix))
    throw "the key's suffix is not the unit of the field's type";
  if (kind == Kind::scalar || kind == Kind::curve || kind == Kind::bands) {
    if (!(text.hard.low < text.hard.high) || !(text.usual.low < text.usual.high) || !(text.step > 0))
      throw "hard and usual need low < high, step > 0";
    if (text.usual.low < text.hard.low || text.usual.high > text.hard.high) throw "usual reaches beyond hard";
    if (text.logarithmic && !(text.usual.low > 0)) throw "a logarithmic slider needs a usual range above 0";
  }
  if constexpr (kind == Kind::scalar)
    if (!within(field.value(), text.usual)) throw "the default is outside the usual range";
  if constexpr (kind == Kind::curve)
    for (const CurvePoint& p : field.span())
      if (!within(p.x, text.usual)) throw "a default point is outside the usual range";
  if constexpr (kind == Kind::bands)
    for (const Band& b : field.span())
      if (!within(b.widthPx, text.usual) || !within(b.heightPx, text.usual))
        throw "a default size is outside the usual range";

  ParameterRow r{.key = text.key,
                 .label = text.label,
                 .help = text.help,
                 .source = text.source,
                 .hard = text.hard,
                 .usual = text.usual,
                 .step = text.step,
                 .decimals = text.decimals,
                 .tier = text.tier,
                 .effect = text.effect,
                 .logarithmic = text.logarithmic,
                 .whole = text.whole,
                 .kind = kind,
                 .unit = Unit::symbol,
                 .choices = {},
                 .get = &getField<Group, Field>,
                 .set = &setField<Group, Field>};
  if constexpr (kind == Kind::choice) {
    r.choices = ChoicesOf<T>::options;
    if (static_cast<std::size_t>(field) >= r.choices.size()) throw "the default is no option";
  }
  return {r, &field, &group, fieldCount<std::remove_cvref_t<decltype(group)>>()};
}

/// Several lists of rows as one.
template <std::size_t... Sizes>
constexpr auto joined(const std::array<CheckedRow, Sizes>&... lists) {
  std::array<CheckedRow, (Sizes + ...)> all{};
  std::size_t next = 0;
  const auto append = [&](const auto& list) {
    for (const CheckedRow& row : list) all[next++] = row;
  };
  (append(lists), ...);
  return all;
}

/// Returns the part of a key that makes its group: "fuzzy.altitude" of "fuzzy.altitude.reading".
constexpr std::string_view prefixOf(std::string_view key) {
  const std::size_t dot = key.rfind('.');
  return dot == std::string_view::npos ? std::string_view{} : key.substr(0, dot);
}

/// Keys differ, none is another's prefix, and keys of one prefix stand together (nested formats open a group
/// once).
template <std::size_t N>
consteval bool keysAreOrderly(const std::array<CheckedRow, N>& rows) {
  for (std::size_t i = 0; i < N; ++i) {
    const std::string_view key = rows[i].row.key;
    bool left = false;
    for (std::size_t j = i + 1; j < N; ++j) {
      const std::string_view other = rows[j].row.key;
      if (other == key || prefixOf(other) == key) return false;
      const bool inside = other.starts_with(prefixOf(key));
      if (inside && left) return false;
      left = left || !inside;
    }
  }
  return true;
}

/// Reports whether every field has exactly one row: no field has two, no group is missing, and there are as
/// many rows as fields.
template <std::size_t N>
consteval bool everyFieldHasOneRow(const std::array<CheckedRow, N>& rows) {
  std::size_t groups = 0, fields = 0;
  for (std::size_t i = 0; i < N; ++i) {
    bool firstOfGroup = true;
    for (std::size_t j = 0; j < i; ++j) {
      if (rows[j].field == rows[i].field) return false;
      if (rows[j].group == rows[i].group) firstOfGroup = false;
    }
    if (firstOfGroup) ++groups, fields += rows[i].fieldsInGroup;
  }
  return groups == fieldCount<TuningParameters>() && fields == N;
}

}  // namespace trimtab::table
