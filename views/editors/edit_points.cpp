// SPDX-License-Identifier: GPL-3.0-or-later
#include "edit_points.h"

#include <algorithm>
#include <cmath>

#include "views/model/rounded.h"

namespace trimtab::views {

bool PointSelection::has(int index) const {
  return std::ranges::find(chosen_, index) != chosen_.end();
}

bool PointSelection::choose(int index) {
  std::vector<int> alone;
  if (index >= 0) alone.push_back(index);
  if (alone == chosen_) return false;
  chosen_ = std::move(alone);
  return true;
}

void PointSelection::follow(int index) {
  std::erase(chosen_, index);
  chosen_.push_back(index);
}

void PointSelection::toggle(int index) {
  if (std::erase(chosen_, index) == 0) chosen_.push_back(index);
}

void PointSelection::addBeside(const std::vector<int>& indexes) {
  for (const int index : indexes)
    if (!has(index)) chosen_.insert(chosen_.begin(), index);
}

std::vector<std::size_t> PointSelection::group(std::size_t count) const {
  std::vector<std::size_t> rising;
  for (const int index : chosen_)
    if (static_cast<std::size_t>(index) < count) rising.push_back(static_cast<std::size_t>(index));
  std::ranges::sort(rising);
  return rising;
}

Range PointRow::freeRange(std::size_t index) const {
  Range free = limits;
  if (index > 0) free.low = std::max(free.low, withoutDust(x[index - 1] + gapAfter(index - 1)));
  if (index + 1 < x.size()) free.high = std::min(free.high, withoutDust(x[index + 1] - gapAfter(index)));
  return free;
}

double PointRow::step(const std::vector<std::size_t>& moved, double by) const {
  const auto isMoved = [&](std::size_t i) { return std::ranges::find(moved, i) != moved.end(); };
  for (const std::size_t i : moved) {
    if (!std::isfinite(x[i])) continue;
    Range free = freeRange(i);
    // A neighbour that moves too keeps its distance.
    if (i > 0 && isMoved(i - 1)) free.low = limits.low;
    if (i + 1 < x.size() && isMoved(i + 1)) free.high = limits.high;
    by = std::clamp(by, std::min(free.low - x[i], 0.0), std::max(free.high - x[i], 0.0));
  }
  return by;
}

double membershipStep(const std::vector<double>& y, double by) {
  for (const double from : y) by = std::clamp(by, std::min(-from, 0.0), std::max(1 - from, 0.0));
  return by;
}

}  // namespace trimtab::views
