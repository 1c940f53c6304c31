#include <algorithm>
#include <cmath>

#include "membership_at.h"
#include "trimtab/units/number.h"

namespace trimtab {
namespace {

/// Beyond this no signal has a meaning, and differences of two numbers could lose everything.
constexpr double kLargestNumber = 1e12;

double onPoints(std::span<const double> xy, double x) {
  const std::size_t points = xy.size() / 2;
  std::size_t above = 0;  // the first point beyond x, so that at a step the later point counts
  while (above < points && xy[2 * above] <= x) ++above;
  if (above == 0) return xy[1];
  if (above == points) return xy[2 * points - 1];
  const double x0 = xy[2 * above - 2], y0 = xy[2 * above - 1], x1 = xy[2 * above], y1 = xy[2 * above + 1];
  return std::lerp(y0, y1, (x - x0) / (x1 - x0));
}

double onTrapezoid(double a, double b, double c, double d, double x) {
  if (x < a || x > d) return 0;
  if (x < b) return std::isinf(a) ? 1 : (x - a) / (b - a);
  if (x <= c) return 1;
  return std::isinf(d) ? 1 : (d - x) / (d - c);
}

bool rising(std::span<const double> numbers) {
  return std::is_sorted(numbers.begin(), numbers.end());
}

std::string listed(std::span<const double> numbers) {
  std::string text;
  for (const double number : numbers.first(std::min<std::size_t>(numbers.size(), 8)))
    text += (text.empty() ? "" : " ") + numberText(number);
  return numbers.size() > 8 ? text + " ..." : text;
}

std::optional<TermFlaw> pointsFlaw(std::span<const double> xy) {
  if (xy.size() < 4 || xy.size() % 2 != 0 || xy.size() > kMostTermNumbers)
    return TermFlaw{"2 to " + std::to_string(kMostTermNumbers / 2) + " points, each x and membership",
                    std::to_string(xy.size()) + " numbers"};
  for (std::size_t i = 0; i < xy.size(); i += 2) {
    if (!(xy[i + 1] >= 0 && xy[i + 1] <= 1))
      return TermFlaw{"memberships from 0 to 1", numberText(xy[i + 1])};
    if (i >= 2 && xy[i] < xy[i - 2])
      return TermFlaw{"points from left to right", numberText(xy[i - 2]) + " before " + numberText(xy[i])};
    if (i >= 4 && xy[i] == xy[i - 4])
      return TermFlaw{"at most two points at one x", "three at " + numberText(xy[i])};
  }
  return std::nullopt;
}

}  // namespace

double membershipAt(TermShape shape, std::span<const double> n, double x) {
  switch (shape) {
    case TermShape::points:
      return onPoints(n, x);
    case TermShape::triangle:
      return onTrapezoid(n[0], n[1], n[1], n[2], x);
    case TermShape::trapezoid:
      return onTrapezoid(n[0], n[1], n[2], n[3], x);
    case TermShape::ramp:
      return std::clamp((x - n[0]) / (n[1] - n[0]), 0.0, 1.0);
    case TermShape::gaussian: {
      const double away = (x - n[0]) / n[1];
      return std::exp(-0.5 * away * away);
    }
    case TermShape::bell:
      return 1 / (1 + std::pow(std::abs((x - n[0]) / n[1]), 2 * n[2]));
    case TermShape::sigmoid:
      return 1 / (1 + std::exp(-n[1] * (x - n[0])));
  }
  return 0;
}

double membershipOf(const PolicyTerm& term, double x) {
  return std::isnan(x) ? x : membershipAt(term.shape, term.numbers, x);
}

std::optional<TermFlaw> flawOf(const PolicyTerm& term) {
  const std::span<const double> n(term.numbers);
  const bool open = term.shape == TermShape::trapezoid && n.size() == 4;
  for (std::size_t i = 0; i < n.size(); ++i)
    if (!(std::abs(n[i]) <= kLargestNumber) &&
        !(open && ((i == 0 && n[i] < -kLargestNumber) || (i == 3 && n[i] > kLargestNumber))))
      return TermFlaw{"numbers from -1e12 to 1e12", numberText(n[i])};
  const auto of = [&](std::size_t count, const char* names) -> std::optional<TermFlaw> {
    if (n.size() == count) return std::nullopt;
    return TermFlaw{names, std::to_string(n.size()) + " numbers"};
  };
  const auto require = [&](bool holds, const char* expected) -> std::optional<TermFlaw> {
    if (holds) return std::nullopt;
    return TermFlaw{expected, listed(n)};
  };
  switch (term.shape) {
    case TermShape::points:
      return pointsFlaw(n);
    case TermShape::triangle:
      if (auto flaw = of(3, "three numbers: left foot, top, right foot")) return flaw;
      return require(rising(n) && n[0] < n[2],
                     "a left foot, a top and a right foot that rise and have a width");
    case TermShape::trapezoid:
      if (auto flaw = of(4, "four numbers: left foot, left top, right top, right foot")) return flaw;
      return require(rising(n) && n[0] < n[3] && std::isfinite(n[1]) && std::isfinite(n[2]),
                     "a left foot, two tops and a right foot that rise and have a width");
    case TermShape::ramp:
      if (auto flaw = of(2, "two numbers: where it is 0, where it is 1")) return flaw;
      return require(n[0] != n[1], "two different numbers");
    case TermShape::gaussian:
      if (auto flaw = of(2, "two numbers: mean, deviation")) return flaw;
      return require(n[1] > 0, "a deviation above 0");
    case TermShape::bell:
      if (auto flaw = of(3, "three numbers: centre, width, slope")) return flaw;
      return require(n[1] > 0 && n[2] > 0, "a width and a slope above 0");
    case TermShape::sigmoid:
      if (auto flaw = of(2, "two numbers: middle, slope")) return flaw;
      return require(n[1] != 0, "a slope that is not 0");
  }
  return TermFlaw{"a shape", "none"};
}

}  // namespace trimtab
