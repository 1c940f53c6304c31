// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QWidget>
#include <vector>

namespace trimtab::views {

/// The ground's horizon all round the eye as a profile: elevation over bearing, north in the middle of the
/// width, with the view's share of it marked. Or the reason why there is none.
class HorizonInset : public QWidget {
  Q_OBJECT
 public:
  explicit HorizonInset(QWidget* parent = nullptr);

  /// `elevationDeg`: evenly round from south by west, north and east; NaN where nothing bounds the sky.
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
