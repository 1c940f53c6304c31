// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve_plot.h"

#include <cmath>

#include "trimtab/fuzzy/membership.h"
#include "views/model/theme.h"

namespace trimtab::views {

CurvePlot::CurvePlot(Draft& draft, CurveSpec spec, QWidget* parent)
    : PointPlot(tr("%1 membership curve").arg(spec.quantity), draft, spec.key, parent),
      spec_(std::move(spec)),
      liveThrottle_(this,
                    [this] {
                      placeLive();
                      layer(QStringLiteral("live"))->replot();
                    }),
      lines_(addGraph()),
      effective_(addGraph()),
      operating_(addGraph()) {
  xAxis->setLabel(tr("%1 (%2)").arg(spec_.quantity, spec_.unit));
  yAxis->setLabel(tr("Membership"));
  yAxis->setRange(-0.06, 1.1);
  xAxis->setNumberFormat(QStringLiteral("f"));
  xAxis->setNumberPrecision(0);
  operating_->setLineStyle(QCPGraph::lsNone);
  operating_->setLayer(QStringLiteral("live"));
  for (QCPGraph* graph : {effective_, operating_}) graph->setAdaptiveSampling(false);
  fitView();
  restyle();
  connect(&draft, &Draft::valueChanged, this, [this](const QString& changed) {
    // Readings and offsets of the same quantity bend the computed curve too.
    const qsizetype dot = static_cast<qsizetype>(spec_.key.rfind('.'));
    if (!changed.startsWith(QString::fromUtf8(spec_.key.data(), dot))) return;
    const int last = static_cast<int>(curve().size) - 1;
    selected() > last ? select(last) : redraw();
  });
  connect(&draft, &Draft::referencesChanged, this, &CurvePlot::redraw);
}

void CurvePlot::restyle() {
  applyTheme(*this);
  const QColor base = palette().color(QPalette::Base);
  lines_->setPen(QPen(blend(base, palette().color(QPalette::Text), 0.6), 1, Qt::DashLine));
  effective_->setPen(QPen(seriesColour(0, palette()), 2.2));
  operating_->setScatterStyle({QCPScatterStyle::ssDiamond, QPen(base, 1), QBrush(liveColour(palette())), 13});
  PointPlot::restyle();
}

std::vector<EditPoint> CurvePlot::points() const {
  std::vector<EditPoint> points;
  for (const CurvePoint& point : curve().span()) points.push_back({point.x, point.y, true, true, false, {}});
  return points;
}

void CurvePlot::moveHeld(const std::vector<std::size_t>& moved, QPointF by, MergeToken token) {
  commit(withMoved(std::get<CurvePoints>(held()), moved, {by.x(), by.y()}, spec_), token);
}

void CurvePlot::insertAt(double x, double y) {
  if (!editable()) return emit refused(tr("This reading does not use the points."));
  const std::optional<Inserted> inserted = withInserted(curve(), {x, y}, spec_);
  if (!inserted)
    return emit refused(
        tr("There is no room for another point here (at most %1 points).").arg(CurvePoints::kCapacity));
  commit(inserted->curve, 0);
  select(static_cast<int>(inserted->index));
}

bool CurvePlot::removePoints(const std::vector<std::size_t>& gone) {
  const std::optional<CurvePoints> left = withRemoved(curve(), gone);
  left ? commit(*left, 0) : emit refused(tr("A curve keeps at least two points."));
  return left.has_value();
}

Range CurvePlot::wholeView() const {
  QCPRange range(spec_.view.low, spec_.view.high);
  for (const CurvePoint& p : curve().span()) range.expand(p.x);
  const double margin = 0.06 * range.size();
  return {range.lower - margin, range.upper + margin};
}

QString CurvePlot::describe() const {
  QString text;
  const CurvePoints shown = curve();
  if (selected() >= 0) {
    const CurvePoint& p = shown.point[static_cast<std::size_t>(selected())];
    text = tr("Breakpoint %1 of %2: %3 %4, membership %5. ")
               .arg(selected() + 1)
               .arg(shown.size)
               .arg(numberText(p.x, 3), spec_.unit, numberText(p.y, 4));
  }
  return text + tr("Tab selects a breakpoint, arrow keys move it (Shift: ten times as far), Enter types "
                   "its values, Insert adds one, Delete removes it. Ctrl+A, Ctrl and a click, or a rectangle "
                   "drawn over empty space select several, which move and go together.");
}

void CurvePlot::redraw() {
  const CurvePoints shown = curve();
  // The straight lines between the points are constant beyond the ends. They are shown only if the reading
  // computes another curve.
  const QCPRange range = xAxis->range();
  const double beyond = range.size() + std::abs(range.center()) + 1;
  QVector<double> x, y;
  for (const CurvePoint& p : shown.span()) x << p.x, y << p.y;
  if (!x.isEmpty()) {
    x.prepend(x.first() - beyond);
    y.prepend(y.first());
    x.append(x.last() + beyond);
    y.append(y.last());
  }
  lines_->setData(x, y);
  redrawEffective(shown);
  placeLive();
  showPoints(seriesColour(0, palette()));
}

void CurvePlot::redrawEffective(const CurvePoints& shown) {
  const TuningParameters& parameters = draft().parameters();
  QVector<double> jumps{0, parameters.altitude.maximum.value(), parameters.pitch.limit.value(),
                        -parameters.pitch.limit.value()};
  for (const CurvePoint& p : shown.span()) jumps.append(p.x);
  const QVector<double> at = samples(jumps);
  QVector<double> y;
  double apart = 0;
  for (const double x : at) {
    y.append(spec_.evaluate(parameters, x));
    apart = std::max(apart, std::abs(y.last() - curveValue(shown, x)));
  }
  effective_->setData(at, y, true);
  lines_->setVisible(apart > 1e-6);
  redrawGhosts(at, y);
}

void CurvePlot::redrawGhosts(const QVector<double>& at, const QVector<double>& now) {
  for (const Reference which : kGhosts) {
    QVector<Ghosts::Line> lines;
    if (const TuningParameters* values = draft().reference(which)) {
      Ghosts::Line line;
      double apart = 0;
      for (qsizetype i = 0; i < at.size(); ++i) {
        line << QPointF(at[i], spec_.evaluate(*values, at[i]));
        apart = std::max(apart, std::abs(line.back().y() - now[i]));
      }
      if (apart > 1e-6) lines << line;
    }
    behind().show(which, lines);
  }
}

void CurvePlot::showFrame(const LiveFrame& frame) {
  live_ = CurvePoint{spec_.liveX(frame.decision), spec_.liveY(frame.decision)};
  liveThrottle_.request();
}

void CurvePlot::placeLive() {
  const bool shown = live_ && std::isfinite(live_->x) && std::isfinite(live_->y);
  liveText()->setVisible(shown);
  operating_->data()->clear();
  if (!shown) return;
  const double x = std::clamp(live_->x, view().low, view().high);
  operating_->addData(x, live_->y);
  const QPointF pixel = pixelOf(x, live_->y);
  putLiveText(live_->x,
              tr("%1 %2: %3").arg(numberText(live_->x, spec_.decimals), spec_.unit, numberText(live_->y, 3)),
              pixel, pixel.y() >= axisRect()->top() + 30);
}

QString CurvePlot::readoutOf(double x, int) const {
  return tr("%1 %2: %3")
      .arg(numberText(x, spec_.decimals), spec_.unit, numberText(spec_.evaluate(draft().parameters(), x), 4));
}

}  // namespace trimtab::views
