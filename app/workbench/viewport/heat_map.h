// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QWidget>
#include <span>

namespace trimtab::workbench {

/// Makes an image of errors in the colours of the report's images. Row 0 of the errors is the lowest.
QImage heatImage(std::span<const float> errors, int width, int height);

/// Shows a map of errors with its legend.
class HeatMap : public QWidget {
  Q_OBJECT

 public:
  explicit HeatMap(QWidget* parent = nullptr);

  /// An empty image means that nothing has been compared yet.
  void show(const QImage& map, double mean, double largest);
  const QImage& map() const { return map_; }
  double largest() const { return largest_; }

  QSize sizeHint() const override { return {420, 300}; }
  QSize minimumSizeHint() const override { return {160, 120}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QImage map_;
  double largest_ = 0;
};

}  // namespace trimtab::workbench
