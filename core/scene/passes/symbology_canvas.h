#pragma once

#include <string_view>

#include "trimtab/scene/symbology_geometry.h"

namespace trimtab::scene {

/// A flat sheet in the eye's axes (x right, y up, looking along -z) to draw on: its point (a, b) lies in the
/// direction origin + a right + b up.
struct Sheet {
  Vec3 origin, right, up;

  Vec3 at(double a, double b) const { return origin + right * a + up * b; }
};

struct Extent {
  double left, bottom, right, top;
};

/// Draws lines of sheets into the image: projects them, clips them to the image, and keeps each symbol's
/// box.
class Canvas {
 public:
  Canvas(const ViewShape& view, double marginPx, SymbologyDrawing& drawing);

  /// Makes what is drawn next belong to `symbol` and moves it by fractions of half the image.
  void begin(Symbol symbol, double moveX = 0, double moveY = 0);
  void line(const Sheet& sheet, double a0, double b0, double a1, double b1);
  void circle(const Sheet& sheet, double a, double b, double radius);
  void rectangle(const Sheet& sheet, const Extent& e);
  /// Draws text whose middle is at (a, b). `height` is that of a capital, in units of the sheet.
  void text(const Sheet& sheet, double a, double b, double height, std::string_view text);
  static double widthOf(std::string_view text, double height);

  /// Returns a sheet in the image's plane: unit 1 is half the image's height; x and y place its origin by
  /// fractions (-1 to 1) of the image.
  Sheet picture(double x, double y) const;
  /// Returns half the image's height as a tangent.
  double tangentPerUnit() const { return 0.5 * (view_.top - view_.bottom); }
  /// Computes the pixels of a direction; returns false if it is behind the eye.
  bool project(Vec3 direction, double& x, double& y) const;
  /// Reports whether a direction, moved as the symbol is, lies within `reach` (in half heights) of the
  /// image's middle.
  bool isCentral(Vec3 direction, double reach) const;

 private:
  void add(double x0, double y0, double x1, double y1);

  ViewShape view_;
  double margin_, moveX_ = 0, moveY_ = 0;
  Symbol symbol_ = Symbol::pitch_ladder;
  SymbologyDrawing& drawing_;
};

}  // namespace trimtab::scene
