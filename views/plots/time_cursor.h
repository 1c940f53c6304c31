// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <qcustomplot.h>

#include <optional>
#include <vector>

namespace trimtab::views {

class Plot;

/// One moment across several axis rects that share a time axis: a line in each, and a flag with a text at the
/// top of the first. Lives as long as the plot's items; `attach` makes them anew.
class TimeCursor {
 public:
  /// Makes the lines and the flag on a layer of the plot. Hidden until it is placed.
  void attach(Plot& plot, const char* layer, const std::vector<QCPAxisRect*>& rects);
  /// With `flagInk`, which is the colour of the flag's text, the flag is shown.
  void setLook(const QPen& line, const std::optional<QColor>& flagInk, const QFont& font);
  void setFlag(const QString& text);
  /// Nothing, or a time that is no number, hides it. The caller replots the layer.
  void place(std::optional<double> time);
  /// Places it anew after the axes have moved.
  void place() { place(time_); }
  std::optional<double> time() const { return time_; }

 private:
  std::vector<QCPItemStraightLine*> lines_;
  QCPItemText* flag_ = nullptr;
  std::optional<double> time_;
  bool flagged_ = false;
};

}  // namespace trimtab::views
