#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "trimtab/units/range.h"

/// The outputs of a policy: what the rules of a preset may set in each image.
namespace trimtab {

enum class Lever : std::uint8_t {
  occlusion,
  screen_space_error,
  lod_scale,
  far_distance,
  particle_density,
  blur_strength,
  render_scale,
  object_error,
  small_feature,
  object_distance
};

/// Says what a larger value does to the time of a frame.
enum class CostOf : std::int8_t { falls = -1, either = 0, rises = 1 };

struct LeverRow {
  Lever lever;
  std::string_view key;    ///< as files spell it
  std::string_view label;  ///< as people read it, without the unit
  std::string_view unit;
  double neutral;  ///< the value that changes nothing; NaN: the preset's own, see `means`
  Range hard;      ///< rules may ask for nothing else
  Range usual;     ///< what leverage is measured between, and where a slider ends
  CostOf larger;   ///< what a larger value costs
  /// True if the lever is felt by ratios: `ratePerS` and `deadBand` are octaves then, else units.
  bool logarithmic;
  double ratePerS;  ///< the largest change a second
  double deadBand;  ///< a target nearer than this does not move a lever at rest
  std::string_view means;
};

namespace detail {
inline constexpr double kPresetsOwn = std::numeric_limits<double>::quiet_NaN();
}

// Rates: a lever crosses its usual range in about half a second, so that no image shows a jump; the blur,
// which lives for tenths of a second, is faster. Dead bands are a twentieth of an octave or less, which is
// below the difference in triangles that a still picture shows. Occlusion has neither: the bands that it
// chooses have a hysteresis, and no size of a depth map is seen.
inline constexpr std::array kLeverRows{
    LeverRow{Lever::occlusion,
             "occlusion",
             "Occlusion",
             "",
             detail::kPresetsOwn,
             {0, 2},
             {0, 2},
             CostOf::either,
             false,
             std::numeric_limits<double>::infinity(),
             0,
             "the total on the scale of the bands, which choose the scheme and the resolution of occlusion"},
    LeverRow{Lever::screen_space_error,
             "screen_space_error",
             "Allowed error",
             "px",
             detail::kPresetsOwn,
             {0.1, 64},
             {1, 16},
             CostOf::falls,
             true,
             8,
             0.05,
             "takes the place of lod.screen_space_error_px; static_lod.error_px follows in proportion"},
    LeverRow{Lever::lod_scale,
             "lod_scale",
             "LOD scale",
             "",
             detail::kPresetsOwn,
             {0.1, 16},
             {1, 4},
             CostOf::falls,
             true,
             4,
             0.05,
             "takes the place of lod.scale; head motion still multiplies it"},
    LeverRow{Lever::far_distance,
             "far_distance",
             "Far distance",
             "x visible distance",
             1,
             {0.1, 4},
             {0.5, 1},
             CostOf::rises,
             true,
             2,
             0.02,
             "multiplies the weather's far cut"},
    LeverRow{Lever::particle_density,
             "particle_density",
             "Particle share",
             "",
             1,
             {0, 1},
             {0, 1},
             CostOf::rises,
             false,
             2,
             0.01,
             "multiplies the number of drops and flakes"},
    LeverRow{Lever::blur_strength,
             "blur_strength",
             "Blur strength",
             "",
             1,
             {0, 1},
             {0, 1},
             CostOf::rises,
             false,
             8,
             0.01,
             "multiplies the strength of the blur that head motion asks for"},
    LeverRow{Lever::render_scale,
             "render_scale",
             "Render scale",
             "",
             1,
             {0.5, 1},
             {0.5, 1},
             CostOf::rises,
             false,
             2,
             0.02,
             "the part of the image's width and height at which the scene is drawn; symbols stay sharp"},
    LeverRow{Lever::object_error,
             "object_error",
             "Allowed error of objects",
             "px",
             detail::kPresetsOwn,
             {0.1, 256},
             {1, 16},
             CostOf::falls,
             true,
             8,
             0.05,
             "takes the place of objects.error_px"},
    LeverRow{Lever::small_feature,
             "small_feature",
             "Smallest object",
             "px",
             detail::kPresetsOwn,
             {0, 32},
             {0, 8},
             CostOf::falls,
             false,
             16,
             0.1,
             "takes the place of objects.small_feature_px"},
    LeverRow{Lever::object_distance,
             "object_distance",
             "Farthest object",
             "m",
             detail::kPresetsOwn,
             {10, 1e6},
             {2000, 50000},
             CostOf::rises,
             true,
             8,
             0.05,
             "takes the place of objects.far_m"},
};
inline constexpr std::size_t kLevers = kLeverRows.size();

constexpr std::size_t indexOf(Lever lever) {
  return static_cast<std::size_t>(lever);
}
/// Returns the row of a lever.
constexpr const LeverRow& rowOf(Lever lever) {
  return kLeverRows[static_cast<std::size_t>(lever)];
}
/// Returns the lever with this key; nothing if there is none.
constexpr std::optional<Lever> leverNamed(std::string_view key) {
  for (const LeverRow& row : kLeverRows)
    if (row.key == key) return row.lever;
  return std::nullopt;
}

/// One value of each lever, in the units of its row. NaN says that no rule moves it.
struct LeverValues {
  std::array<double, kLevers> value;

  constexpr LeverValues() { value.fill(std::numeric_limits<double>::quiet_NaN()); }
  static constexpr LeverValues all(double number) {
    LeverValues values;
    values.value.fill(number);
    return values;
  }
  constexpr double& operator[](Lever l) { return value[static_cast<std::size_t>(l)]; }
  constexpr double operator[](Lever l) const { return value[static_cast<std::size_t>(l)]; }
  friend bool operator==(const LeverValues&, const LeverValues&) = default;
};

namespace detail {
constexpr bool leverRowsAreInOrder() {
  for (std::size_t i = 0; i < kLevers; ++i) {
    const LeverRow& row = kLeverRows[i];
    if (static_cast<std::size_t>(row.lever) != i || leverNamed(row.key) != row.lever) return false;
    if (!(row.hard.low <= row.usual.low && row.usual.low < row.usual.high && row.usual.high <= row.hard.high))
      return false;
    if (row.neutral < row.hard.low || row.neutral > row.hard.high) return false;
    if (!(row.ratePerS > 0) || !(row.deadBand >= 0) || (row.logarithmic && !(row.hard.low > 0))) return false;
  }
  return true;
}
static_assert(leverRowsAreInOrder() && static_cast<std::size_t>(Lever::object_distance) + 1 == kLevers);
}  // namespace detail

}  // namespace trimtab
