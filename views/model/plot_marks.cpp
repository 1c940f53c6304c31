// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot_marks.h"

#include <algorithm>
#include <cmath>

namespace trimtab::views {

void PlotMarks::set(Kind kind, bool on, double time) {
  if (on == lasts(kind)) return;
  if (on) {
    if (spans_.size() == kMost) spans_.pop_front();
    return spans_.push_back({kind, time, {}});
  }
  for (Span& span : spans_)
    if (span.kind == kind && !span.to) span.to = std::max(time, span.from);
}

bool PlotMarks::lasts(Kind kind) const {
  return std::ranges::any_of(spans_, [&](const Span& span) { return span.kind == kind && !span.to; });
}

void PlotMarks::addChange(double time, const QString& text) {
  if (changes_.size() == kMost) changes_.pop_front();
  changes_.push_back({time, text});
}

void PlotMarks::clear() {
  changes_.clear();
  // What still lasts goes on.
  std::erase_if(spans_, [](const Span& span) { return span.to.has_value(); });
}

const PlotMarks::Change* PlotMarks::changeNear(double time, double reach) const {
  const Change* nearest = nullptr;
  const auto first = std::ranges::lower_bound(changes_, time - reach, {}, &Change::time);
  for (auto it = first; it != changes_.end() && it->time <= time + reach; ++it)
    if (!nearest || std::abs(it->time - time) < std::abs(nearest->time - time)) nearest = &*it;
  return nearest;
}

}  // namespace trimtab::views
