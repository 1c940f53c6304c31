// SPDX-License-Identifier: GPL-3.0-or-later
#include "ghosts.h"

#include <limits>

#include "views/model/theme.h"

namespace trimtab::views {

QPen ghostPen(Reference which, const QPalette& palette) {
  return which == Reference::pinned ? QPen(seriesColour(3, palette), 1.6, Qt::DashDotLine)
                                    : QPen(quietColour(palette), 1.6, Qt::DotLine);
}

QString ghostName(Reference which, const Draft& draft) {
  return which == Reference::pinned ? draft.referenceName(which) : QObject::tr("file");
}

Ghosts::Ghosts(QCustomPlot& plot, const Draft& draft) : draft_(draft), names_(new QCPItemText(&plot)) {
  names_->position->setType(QCPItemPosition::ptAxisRectRatio);
  names_->position->setCoords(0.985, 0.02);
  names_->setPositionAlignment(Qt::AlignRight | Qt::AlignTop);
  names_->setTextAlignment(Qt::AlignRight);
  names_->setVisible(false);
  for (QCPCurve*& curve : curves_) {
    curve = new QCPCurve(plot.xAxis, plot.yAxis);
    curve->removeFromLegend();
    curve->setVisible(false);
  }
}

void Ghosts::restyle(const QPalette& palette) {
  for (const Reference which : kGhosts) of(which)->setPen(ghostPen(which, palette));
  names_->setColor(quietColour(palette));
  names_->setFont(names_->parentPlot()->font());
}

void Ghosts::showNames() {
  QStringList names;
  for (const Reference which : kGhosts)
    if (isShown(which))
      names << (which == Reference::pinned ? QObject::tr("dash-dotted: %1") : QObject::tr("dotted: %1"))
                   .arg(ghostName(which, draft_));
  names_->setText(names.join(QLatin1Char('\n')));
  names_->setVisible(named_ && !names.isEmpty());
}

void Ghosts::show(Reference which, const QVector<Line>& lines) {
  QCPCurve& curve = *of(which);
  // One curve holds all lines: a point that is no number parts them.
  constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
  QVector<QCPCurveData> points;
  for (const Line& line : lines) {
    for (const QPointF& point : line) points << QCPCurveData(double(points.size()), point.x(), point.y());
    points << QCPCurveData(double(points.size()), kGap, kGap);
  }
  curve.data()->set(points, true);
  curve.setVisible(!lines.isEmpty());
  showNames();
}

}  // namespace trimtab::views
