// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QColor>
#include <QImage>
#include <QWidget>
#include <span>

namespace trimtab::workbench {

/// Colours of an error of 0..1, from black over blue and orange to pale yellow: the lightness rises all the
/// way, so that the colour-blind and a grey print read it too. Small errors are what there is to see, so that
/// the place in the scale is the error's square root.
QColor heatColour(double error);
/// Row 0 of the errors is the lowest.
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
