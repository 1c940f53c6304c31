#pragma once

#include <string>
#include <vector>

namespace trimtab::plot {

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
  bool overlaps(const Box& o) const {
    return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
  }
};

struct Label {
  std::string text;
  double x = 0, y = 0;  ///< of the point it belongs to
};

struct PlacedLabel {
  std::string text;
  Box box;  ///< empty text: no place was free
  double pointX = 0, pointY = 0;
  bool leader = false;  ///< so far from its point that a line should lead there
};

/// Places labels in order, each beside its point and over no other label, no box of `taken` and no edge of
/// `area`; `lines` (thin boxes) are avoided where another place is near.
std::vector<PlacedLabel> placeLabels(const std::vector<Label>& labels, const std::vector<Box>& taken,
                                     const std::vector<Box>& lines, const Box& area, double textPx);

}  // namespace trimtab::plot
