#pragma once

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "trimtab/units/quantity.h"

/// One cell of a trace as text and back. Numbers are written in the shortest form that reads back to the same
/// bits; an enumeration by its toText(), which is empty past the last name.
namespace trimtab::trace {

template <class T>
requires std::is_arithmetic_v<T>
void print(std::string& text, T number) {
  if constexpr (std::is_same_v<T, bool>) {
    text += number ? '1' : '0';
  } else {
    std::array<char, 32> cell;
    const auto end = std::to_chars(cell.data(), cell.data() + cell.size(), number).ptr;
    text.append(cell.data(), end);
  }
}
template <class U>
void print(std::string& text, Quantity<U> quantity) {
  print(text, quantity.value());
}
template <class E>
requires std::is_enum_v<E>
void print(std::string& text, E name) {
  text += toText(name);
}

/// A fixed count of numbers, as "2;2;2;4;5.6".
template <std::size_t N>
void print(std::string& text, const std::array<double, N>& numbers) {
  for (std::size_t i = 0; i < N; ++i) {
    if (i > 0) text += ';';
    print(text, numbers[i]);
  }
}

/// Says what a cell may hold, for findings.
struct Expected {
  std::string what;
};

template <class T>
requires std::is_arithmetic_v<T>
bool parse(std::string_view cell, T& number, Expected& expected) {
  if constexpr (std::is_same_v<T, bool>) {
    expected.what = "0 or 1";
    number = cell == "1";
    return cell == "1" || cell == "0";
  } else {
    expected.what = std::is_floating_point_v<T> ? "a number" : "a whole number";
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    return error == std::errc{} && end == cell.data() + cell.size();
  }
}
template <class U>
bool parse(std::string_view cell, Quantity<U>& quantity, Expected& expected) {
  double number = 0;
  if (!parse(cell, number, expected)) return false;
  quantity = Quantity<U>{number};
  return true;
}
template <std::size_t N>
bool parse(std::string_view cell, std::array<double, N>& numbers, Expected& expected) {
  for (std::size_t i = 0; i < N; ++i) {
    const std::size_t end = cell.find(';');
    if (!parse(cell.substr(0, end), numbers[i], expected) ||
        (end == std::string_view::npos) != (i + 1 == N)) {
      expected.what = std::to_string(N) + " numbers with ; between";
      return false;
    }
    if (i + 1 < N) cell.remove_prefix(end + 1);
  }
  return true;
}
/// The reason of former traces whose rule base did not fire: the total was 0.
constexpr std::string_view kFormerReason = "no_rule_fires";
template <class E>
requires std::is_enum_v<E>
bool parse(std::string_view cell, E& name, Expected& expected) {
  if constexpr (std::is_same_v<E, SchemeReason>)
    if (cell == kFormerReason) cell = "below_first_band";
  for (int i = 0;; ++i) {
    const std::string_view candidate = toText(static_cast<E>(i));
    if (candidate.empty()) break;
    if (candidate == cell) {
      name = static_cast<E>(i);
      return true;
    }
  }
  for (int i = 0; !toText(static_cast<E>(i)).empty(); ++i) {
    if (i > 0) expected.what += ", ";
    expected.what += toText(static_cast<E>(i));
  }
  return false;
}

}  // namespace trimtab::trace
