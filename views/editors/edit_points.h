// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <functional>
#include <vector>

#include "trimtab/units/range.h"

/// What editors of points know about them; no widgets here.
namespace trimtab::views {

/// A point that a person can take hold of.
struct EditPoint {
  double x = 0, y = 0;
  bool movesX = true, movesY = false;
  /// Reports a foot at infinity, which is drawn where the view ends. Moving it makes it finite.
  bool open = false;
  QString name;  ///< such as "left foot"
};

/// Which of a row of points are selected. Tables and descriptions follow the last one that was chosen; the
/// others move and go with it.
class PointSelection {
 public:
  /// Returns the one that is followed; -1 if none is selected.
  int followed() const { return chosen_.empty() ? -1 : chosen_.back(); }
  bool has(int index) const;
  /// Selects one alone, or none for -1, and returns whether the selection was another before.
  bool choose(int index);
  /// Adds one and follows it.
  void follow(int index);
  /// Adds one, or takes it out.
  void toggle(int index);
  /// Adds these without following them, unless nothing was selected.
  void addBeside(const std::vector<int>& indexes);
  /// Returns those of the first `count` that are selected, in rising order.
  std::vector<std::size_t> group(std::size_t count) const;

 private:
  std::vector<int> chosen_;
};

/// The x of points in rising order, and the room that they have.
struct PointRow {
  std::vector<double> x;
  Range limits;  ///< of every x
  /// Returns the distance that stays between a point and the next one.
  std::function<double(std::size_t)> gapAfter;

  /// Returns the range into which one point may be moved. It is empty if its neighbours are too close.
  Range freeRange(std::size_t index) const;
  /// Returns how far several points may be moved together: by `by`, or as far as the first that meets a
  /// neighbour or a limit. Points at infinity do not count.
  double step(const std::vector<std::size_t>& moved, double by) const;
};

/// Returns how far memberships may be moved together: by `by`, or as far as the first that meets 0 or 1.
double membershipStep(const std::vector<double>& y, double by);

}  // namespace trimtab::views
