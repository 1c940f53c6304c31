#pragma once

#include <array>
#include <charconv>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

#include "trimtab/frame/rule_firing.h"
#include "trimtab/hold/arbiter.h"
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

/// "0.5;0.25"
inline void print(std::string& text, const RuleFiring& firing) {
  for (std::size_t i = 0; i < firing.count; ++i) {
    if (i > 0) text += ';';
    print(text, firing.mu[i]);
  }
}

/// Visits the numbers of what an arbitration was given, in the order of its cell.
template <class Given, class Visit>
requires std::is_same_v<std::remove_const_t<Given>, HoldGiven>
void forEachNumber(Given& g, const Visit& visit) {
  for (auto* number : {&g.timeS, &g.budgetMs, &g.asked.errorPx, &g.asked.renderScale, &g.asked.particleShare,
                       &g.asked.blurShare, &g.unseenPx, &g.particles, &g.imageMpx, &g.groundMpx})
    visit(*number);
  visit(g.blurs);
  visit(g.moves);
  for (auto& triangles : g.triangles) visit(triangles);
  visit(g.meshesLeft);
  auto& c = g.cost;
  for (auto* number : {&c.fixed, &c.perTriangle, &c.perTriangleSide, &c.perGroundMpx, &c.perParticles,
                       &c.perWeatherMpx, &c.perBlurMpx, &c.other, &c.bandMs})
    visit(*number);
  visit(c.known);
  for (auto& variance : c.variance.ground) visit(variance);
  for (auto& variance : c.variance.weather) visit(variance);
  visit(c.variance.blur);
}
template <class Memory, class Visit>
requires std::is_same_v<std::remove_const_t<Memory>, HoldMemory>
void forEachNumber(Memory& m, const Visit& visit) {
  for (auto* step : {&m.steps.error, &m.steps.renderScale, &m.steps.particles, &m.steps.blur}) visit(*step);
  visit(m.timeS);
  visit(m.calmMs);
  visit(m.bandMs);
  visit(m.begun);
  visit(m.restoredMs);
  visit(m.patience);
  visit(m.wantedError);
  visit(m.waitedMs);
}

/// Several numbers with ; between.
template <class Numbers>
requires std::is_same_v<Numbers, HoldGiven> || std::is_same_v<Numbers, HoldMemory>
void print(std::string& text, const Numbers& numbers) {
  bool first = true;
  forEachNumber(numbers, [&](const auto& number) {
    if (!std::exchange(first, false)) text += ';';
    print(text, number);
  });
}

/// What a cell may hold, for findings.
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
inline bool parse(std::string_view cell, RuleFiring& firing, Expected& expected) {
  for (firing.count = 0; firing.count < RuleFiring{}.mu.size();) {
    const std::size_t end = cell.find(';');
    if (!parse(cell.substr(0, end), firing.mu[firing.count++], expected)) break;
    if (end == std::string_view::npos) return true;
    cell.remove_prefix(end + 1);
  }
  expected.what = "up to " + std::to_string(RuleList::kCapacity) + " numbers with ; between";
  return false;
}
template <class Numbers>
requires std::is_same_v<Numbers, HoldGiven> || std::is_same_v<Numbers, HoldMemory>
bool parse(std::string_view cell, Numbers& numbers, Expected& expected) {
  bool good = true;
  std::size_t count = 0;
  bool more = true;
  forEachNumber(numbers, [&](auto& number) {
    ++count;
    const std::size_t end = cell.find(';');
    good = good && more && parse(cell.substr(0, end), number, expected);
    more = end != std::string_view::npos;
    if (more) cell.remove_prefix(end + 1);
  });
  if (!good || more) expected.what = std::to_string(count) + " numbers with ; between";
  return good && !more;
}
template <class E>
requires std::is_enum_v<E>
bool parse(std::string_view cell, E& name, Expected& expected) {
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
