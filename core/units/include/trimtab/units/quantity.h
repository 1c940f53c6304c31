#pragma once

#include <compare>
#include <numbers>
#include <string_view>
#include <type_traits>

/// Numbers with their unit in the type: `Feet{4000}`. The unit is named again on the way out:
/// `h.in<Metres>()`.
namespace trimtab {

namespace unit {
struct Length {};
struct Angle {};
struct Time {};
struct Speed {};
struct Turn {};
struct Screen {};
struct Storage {};
struct Dimensionless {};

/// A unit has a dimension, its size in the dimension's base unit, a symbol for people and a suffix for
/// parameter keys.
struct Metre {
  using Dimension = Length;
  static constexpr double size = 1.0;
  static constexpr std::string_view symbol = "m", suffix = "_m";
};
struct Foot {
  using Dimension = Length;
  static constexpr double size = 0.3048;
  static constexpr std::string_view symbol = "ft", suffix = "_ft";
};
struct Degree {
  using Dimension = Angle;
  static constexpr double size = std::numbers::pi / 180;
  static constexpr std::string_view symbol = "°", suffix = "_deg";
};
struct Radian {
  using Dimension = Angle;
  static constexpr double size = 1.0;
  static constexpr std::string_view symbol = "rad", suffix = "_rad";
};
struct Second {
  using Dimension = Time;
  static constexpr double size = 1.0;
  static constexpr std::string_view symbol = "s", suffix = "_s";
};
struct Millisecond {
  using Dimension = Time;
  static constexpr double size = 1e-3;
  static constexpr std::string_view symbol = "ms", suffix = "_ms";
};
struct MetrePerSecond {
  using Dimension = Speed;
  static constexpr double size = 1.0;
  static constexpr std::string_view symbol = "m/s", suffix = "_mps";
};
struct Knot {
  using Dimension = Speed;
  static constexpr double size = 1852.0 / 3600;
  static constexpr std::string_view symbol = "kt", suffix = "_kt";
};
struct DegreePerSecond {
  using Dimension = Turn;
  static constexpr double size = 1.0;
  static constexpr std::string_view symbol = "°/s", suffix = "_degps";
};
struct Pixel {
  using Dimension = Screen;
  static constexpr double size = 1.0;
  static constexpr std::string_view symbol = "px", suffix = "_px";
};
/// A million bytes.
struct Megabyte {
  using Dimension = Storage;
  static constexpr double size = 1e6;
  static constexpr std::string_view symbol = "MB", suffix = "_mb";
};
struct Ratio {
  using Dimension = Dimensionless;
  static constexpr double size = 1.0;
  static constexpr std::string_view symbol = "", suffix = "";
};
/// A fuzzy degree of membership: 0..1 for one input, 0..2 for the sum of two.
struct Degree01 {
  using Dimension = Dimensionless;
  static constexpr double size = 1.0;
  static constexpr std::string_view symbol = "", suffix = "";
};
}  // namespace unit

template <class U>
class Quantity {
 public:
  using Unit = U;

  constexpr Quantity() = default;
  explicit constexpr Quantity(double value) : value_(value) {}

  /// Returns the bare number, in this quantity's own unit.
  constexpr double value() const { return value_; }

  /// Returns the amount as a number in the unit of `To` (in), or as a `To` (as). `To` must have the same
  /// dimension.
  template <class To>
  constexpr double in() const {
    return as<To>().value();
  }
  template <class To>
  constexpr To as() const {
    using V = typename To::Unit;
    static_assert(std::is_same_v<typename U::Dimension, typename V::Dimension>, "not the same dimension");
    if constexpr (std::is_same_v<U, V>)
      return To{value_};
    else
      return To{value_ * (U::size / V::size)};
  }

  friend constexpr auto operator<=>(const Quantity&, const Quantity&) = default;
  friend constexpr Quantity operator+(Quantity a, Quantity b) { return Quantity{a.value_ + b.value_}; }
  friend constexpr Quantity operator-(Quantity a, Quantity b) { return Quantity{a.value_ - b.value_}; }
  friend constexpr Quantity operator-(Quantity a) { return Quantity{-a.value_}; }
  friend constexpr Quantity operator*(Quantity a, double k) { return Quantity{a.value_ * k}; }
  friend constexpr Quantity operator*(double k, Quantity a) { return Quantity{a.value_ * k}; }
  friend constexpr Quantity operator/(Quantity a, double k) { return Quantity{a.value_ / k}; }
  friend constexpr double operator/(Quantity a, Quantity b) { return a.value_ / b.value_; }

 private:
  double value_ = 0;
};

using Metres = Quantity<unit::Metre>;
using Feet = Quantity<unit::Foot>;
using Degrees = Quantity<unit::Degree>;
using Radians = Quantity<unit::Radian>;
using Seconds = Quantity<unit::Second>;
using Milliseconds = Quantity<unit::Millisecond>;
using MetresPerSecond = Quantity<unit::MetrePerSecond>;
using Knots = Quantity<unit::Knot>;
using DegreesPerSecond = Quantity<unit::DegreePerSecond>;
using Pixels = Quantity<unit::Pixel>;
using Megabytes = Quantity<unit::Megabyte>;
using Ratio = Quantity<unit::Ratio>;
using Membership = Quantity<unit::Degree01>;

}  // namespace trimtab
