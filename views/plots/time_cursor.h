// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <qcustomplot.h>

#include <optional>
#include <vector>

namespace trimtab::views {

class Plot;

/// Shows one moment in several axis rects that share a time axis: a line in each, and a flag with a text at
/// the top of the first. The plot owns the items; call `attach` again after it has removed them.
class TimeCursor {
 public:
  /// Makes the lines and the flag on a layer of the plot. They are hidden unless a time was placed before.
  void attach(Plot& plot, const char* layer, const std::vector<QCPAxisRect*>& rects);
  /// Sets pens and font. The flag is shown only with `flagInk`, which is the colour of its text.
  void setLook(const QPen& line, const std::optional<QColor>& flagInk, const QFont& font);
  void setFlag(const QString& text);
  /// Shows a time; nothing, or a time that is no number, hides the cursor. The caller replots the layer.
  void place(std::optional<double> time);
  /// Places the cursor anew after the axes have moved.
  void place() { place(time_); }
  std::optional<double> time() const { return time_; }

 private:
  std::vector<QCPItemStraightLine*> lines_;
  QCPItemText* flag_ = nullptr;
  std::optional<double> time_;
  bool flagged_ = false;
};

}  // namespace trimtab::views
