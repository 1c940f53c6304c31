// SPDX-License-Identifier: GPL-3.0-or-later
#include "horizon_inset.h"

#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

/// A flat horizon would fill the height with noise otherwise.
constexpr double kLeastSpanDeg = 4;

}  // namespace

HorizonInset::HorizonInset(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAccessibleName(tr("Horizon of the ground about the eye"));
  setReason(tr("No horizon yet"));
}

void HorizonInset::setProfile(std::vector<float> elevationDeg, double headingDeg, double fovDeg) {
  elevation_ = std::move(elevationDeg);
  heading_ = headingDeg;
  fov_ = fovDeg;
  why_.clear();
  setAccessibleDescription(tr("Elevation of the ground's horizon over bearing"));
  update();
}

void HorizonInset::setReason(const QString& why) {
  if (elevation_.empty() && why_ == why) return;
  elevation_.clear();
  why_ = why;
  setAccessibleDescription(why);
  update();
}

void HorizonInset::paintProfile(QPainter& painter, const QRect& area) const {
  const QColor base = palette().color(QPalette::Base);
  double low = 1e9, high = -1e9;
  for (const float e : elevation_)
    if (std::isfinite(e)) {
      low = std::min(low, double{e});
      high = std::max(high, double{e});
    }
  if (!(low <= high)) low = high = 0;
  const double middle = (low + high) / 2, span = std::max(kLeastSpanDeg, (high - low) * 1.15);
  low = middle - span / 2;
  high = middle + span / 2;
  const auto x = [&](double share) { return area.left() + share * area.width(); };
  const auto y = [&](double elevation) {
    return area.bottom() - (elevation - low) / (high - low) * area.height();
  };

  // The view's share, in two pieces where it reaches over south.
  painter.save();
  painter.setClipRect(area);
  const QColor share = blend(base, liveColour(palette()), 0.25);
  for (const double turn : {-1.0, 0.0, 1.0}) {
    const double centre = (heading_ + 180) / 360 + turn;
    painter.fillRect(QRectF(x(centre - fov_ / 720), area.top(), fov_ / 360 * area.width(), area.height()),
                     share);
  }
  QPainterPath ground;
  ground.moveTo(area.bottomLeft());
  for (std::size_t i = 0; i < elevation_.size(); ++i) {
    const double e = std::isfinite(elevation_[i]) ? double{elevation_[i]} : low;
    ground.lineTo(x((double(i) + 0.5) / double(elevation_.size())), y(std::max(e, low)));
  }
  ground.lineTo(area.bottomRight() + QPoint(1, 0));
  ground.closeSubpath();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(seriesColour(0, palette()));
  painter.setBrush(blend(base, seriesColour(2, palette()), 0.45));
  painter.drawPath(ground);
  painter.restore();

  painter.setPen(quietColour(palette()));
  const int line = fontMetrics().height();
  const QString bearings[] = {tr("S"), tr("W"), tr("N"), tr("E"), tr("S")};
  for (int i = 0; i < 5; ++i) {
    const double at = x(i / 4.0);
    painter.drawLine(QPointF(at, area.bottom()), QPointF(at, area.bottom() + 3));
    const int width = fontMetrics().horizontalAdvance(bearings[i]);
    painter.drawText(QPointF(std::clamp(at - width / 2.0, 2.0, double(this->width() - width - 2)),
                             area.bottom() + 2 + line * 0.9),
                     bearings[i]);
  }
  const double step = roundStep((high - low) / 2.5);
  for (double e = std::ceil(low / step) * step; e <= high; e += step) {
    painter.drawLine(QPointF(area.left() - 3, y(e)), QPointF(area.left(), y(e)));
    const QString text = QStringLiteral("%1°").arg(numberText(std::abs(e) < 1e-9 ? 0 : e, 2));
    painter.drawText(QPointF(area.left() - 5 - fontMetrics().horizontalAdvance(text), y(e) + line * 0.35),
                     text);
  }
}

void HorizonInset::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::Text);
  painter.fillRect(rect(), base);
  if (elevation_.empty()) {
    painter.setPen(quietColour(palette()));
    painter.drawText(rect().adjusted(8, 8, -8, -8), Qt::AlignCenter | Qt::TextWordWrap, why_);
  } else {
    const int left = fontMetrics().horizontalAdvance(QStringLiteral("-88.5°")) + 10;
    paintProfile(painter, rect().adjusted(left, 6, -8, -fontMetrics().height() - 6));
  }
  painter.setPen(blend(base, ink, 0.3));
  painter.drawRect(rect().adjusted(0, 0, -1, -1));
}

}  // namespace trimtab::views
