#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// The symbols that a host defines and controls (CIGI 3.3 ICD, 4.1.29 to 4.1.35), as plain values. Whoever
/// fills them in has checked every number: all are finite and within the limits below.
namespace trimtab {

/// A part of the image that symbols are drawn on, attached to the view. Left, right, bottom and top are
/// fractions of the image's width and height from its lower left corner; u and v are the coordinates on it.
struct HostSurface {
  std::uint16_t id = 0;
  float left = 0, right = 1, bottom = 0, top = 1;
  float minU = 0, maxU = 1, minV = 0, maxV = 1;

  friend bool operator==(const HostSurface&, const HostSurface&) = default;
};

enum class HostShapeKind : std::uint8_t { lines, circles, text };
/// Says how the points of lines are joined, by their CIGI numbers.
enum class HostPrimitive : std::uint8_t {
  points,
  lines,
  line_strip,
  line_loop,
  triangles,
  triangle_strip,
  triangle_fan
};

/// A point of lines in the symbol's own coordinates.
struct HostPoint {
  float u = 0, v = 0;
  friend bool operator==(const HostPoint&, const HostPoint&) = default;
};

/// A circle or an arc, counter-clockwise from `startDeg` to `endDeg` off the positive u axis; a whole circle
/// if both are equal modulo 360. `innerRadius` counts only if the shape is filled.
struct HostArc {
  float u = 0, v = 0, radius = 0, innerRadius = 0, startDeg = 0, endDeg = 0;
  friend bool operator==(const HostArc&, const HostArc&) = default;
};

/// Says what a symbol looks like. Only the members of its kind are used.
struct HostShape {
  HostShapeKind kind = HostShapeKind::lines;
  HostPrimitive primitive = HostPrimitive::line_strip;  ///< of lines
  bool filled = false;                                  ///< of circles
  std::uint8_t alignment = 0;    ///< of text: 0 top left, 1 top centre, .. 8 bottom right
  std::uint8_t orientation = 0;  ///< of text: 0 to the right, 1 down, 2 to the left, 3 up
  float lineWidth = 0;           ///< of lines and circles; 0 is the thinnest line
  float fontSize = 0;            ///< of text: the height of a line; a capital is 0.7 of it
  std::vector<HostPoint> points;
  std::vector<HostArc> arcs;
  std::string text;

  friend bool operator==(const HostShape&, const HostShape&) = default;
};

/// A symbol: its shape, and what Symbol Control said last. A new symbol is hidden.
struct HostSymbol {
  std::uint16_t id = 0, parent = 0, surface = 0;
  bool visible = false;
  bool attached = false;  ///< to `parent`, whose position, rotation, scale, surface and flashing it shares
  bool inheritsColour = false;  ///< if attached
  std::uint8_t layer = 0;
  std::uint8_t dutyPercent = 100;  ///< share of the flash period that the symbol is visible
  float flashPeriodS = 0;          ///< 0: it does not flash
  float u = 0, v = 0;              ///< on the surface, or in the parent's coordinates
  float rotationDeg = 0;           ///< counter-clockwise
  float scaleU = 1, scaleV = 1;
  std::array<std::uint8_t, 4> rgba{255, 255, 255, 255};
  std::shared_ptr<const HostShape> shape;  ///< never null in a store

  /// Compares shapes by what they hold.
  friend bool operator==(const HostSymbol& a, const HostSymbol& b);
};

/// Holds all surfaces and symbols of a host, each sorted by its id.
struct HostSymbols {
  static constexpr std::size_t kMostSymbols = 1024, kMostSurfaces = 64;
  /// A child has at most so many ancestors; beyond, it is not drawn.
  static constexpr int kMostAncestors = 16;

  std::vector<HostSurface> surfaces;
  std::vector<HostSymbol> symbols;

  /// These return null if there is none.
  const HostSurface* surface(std::uint16_t id) const;
  const HostSymbol* symbol(std::uint16_t id) const;

  friend bool operator==(const HostSymbols&, const HostSymbols&) = default;
};

/// Returns the ids, ascending, of visible symbols that are in the dark part of their flash at `timeS` on the
/// host's clock. All flashes begin at multiples of their periods on that clock.
std::vector<std::uint16_t> darkSymbols(const HostSymbols& symbols, double timeS);

}  // namespace trimtab
