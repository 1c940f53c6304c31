// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QWidget>
#include <vector>

namespace trimtab::views {

/// Shows the ground's horizon all round the eye as a profile: elevation over bearing, with north in the
/// middle of the width and the view's share of it marked. If there is no horizon, it shows the reason.
class HorizonInset : public QWidget {
  Q_OBJECT
 public:
  explicit HorizonInset(QWidget* parent = nullptr);

  /// Shows a profile. The bearings of `elevationDeg` are evenly spaced from south by west, north and east; an
  /// elevation is NaN where no ground bounds the sky.
  void setProfile(std::vector<float> elevationDeg, double headingDeg, double fovDeg);
  void setReason(const QString& why);

  QSize sizeHint() const override { return {320, 130}; }
  QSize minimumSizeHint() const override { return {160, 90}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintProfile(class QPainter& painter, const QRect& area) const;

  std::vector<float> elevation_;
  double heading_ = 0, fov_ = 0;
  QString why_;
};

}  // namespace trimtab::views
