// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QImage>
#include <QWidget>
#include <span>

namespace trimtab::workbench {

/// In the colours of the report's pictures. Row 0 of the errors is the lowest.
QImage heatImage(std::span<const float> errors, int width, int height);

/// A map of errors with its legend.
class HeatMap : public QWidget {
  Q_OBJECT

 public:
  explicit HeatMap(QWidget* parent = nullptr);

  /// An empty image: nothing is known yet.
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
