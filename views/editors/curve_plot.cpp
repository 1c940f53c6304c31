// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve_plot.h"

#include <cmath>

#include "trimtab/fuzzy/membership.h"
#include "trimtab/units/not_finite.h"
#include "views/model/theme.h"

namespace trimtab::views {

CurvePlot::CurvePlot(Draft& draft, CurveSpec spec, QWidget* parent)
    : Plot(tr("%1 membership curve").arg(spec.quantity), Keyboard::used, parent),
      draft_(draft),
      spec_(std::move(spec)),
      hand_(draft),
      liveThrottle_(this, [this] { redrawLive(); }) {
  makeItems();
  fitView();
  restyle();
  connect(&draft_, &Draft::valueChanged, this, [this](const QString& key) {
    // Readings and offsets of the same quantity bend the computed curve too.
    const qsizetype dot = static_cast<qsizetype>(spec_.key.rfind('.'));
    if (!key.startsWith(QString::fromUtf8(spec_.key.data(), dot))) return;
    if (selected() >= static_cast<int>(curve().size)) select(static_cast<int>(curve().size) - 1);
    redraw();
  });
  connect(&draft_, &Draft::loaded, this, &CurvePlot::fitView);
  connect(&draft_, &Draft::referencesChanged, this, &CurvePlot::redraw);
  connect(&draft_, &Draft::findingsChanged, this, [this] {
    if (isAtFault() != shownAtFault_) redraw();
  });
}

void CurvePlot::makeItems() {
  // The operating point and the hover value move on layers of their own, without a replot of the rest.
  addOverlays({"live", "hover"});
  ghosts_.emplace(*this, draft_);
  xAxis->setLabel(tr("%1 (%2)").arg(spec_.quantity, spec_.unit));
  yAxis->setLabel(tr("Membership"));
  yAxis->setRange(-0.06, 1.1);
  xAxis->setNumberFormat(QStringLiteral("f"));
  xAxis->setNumberPrecision(0);
  axisRect()->setRangeZoom(Qt::Horizontal);
  axisRect()->setRangeZoomFactor(kWheelZoom);
  setInteraction(QCP::iRangeZoom);
  axisRect()->setupFullAxesBox();
  connect(this, &QCustomPlot::mouseWheel, this, [this] { fitted_ = false; });
  connect(xAxis, qOverload<const QCPRange&>(&QCPAxis::rangeChanged), this, [this] {
    if (!fitted_) redraw();
  });

  points_ = addGraph();
  effective_ = addGraph();
  effective_->setAdaptiveSampling(false);
  handles_ = addGraph();
  chosen_ = addGraph();
  for (QCPGraph* g : {handles_, chosen_}) g->setLineStyle(QCPGraph::lsNone);
  hover_ = addGraph();
  hover_->setLineStyle(QCPGraph::lsNone);
  hover_->setLayer(QStringLiteral("hover"));
  operating_ = addGraph();
  operating_->setLineStyle(QCPGraph::lsNone);
  operating_->setLayer(QStringLiteral("live"));
  for (QCPGraph* g : {handles_, chosen_, operating_, hover_}) g->setAdaptiveSampling(false);
  operatingText_ = addReadout("live", QMargins(4, 2, 4, 2));
  hoverText_ = addReadout("hover", QMargins(4, 2, 4, 2));
}

void CurvePlot::restyle() {
  applyTheme(*this);
  const QPalette& p = palette();
  ghosts_->restyle(p);
  const QColor base = p.color(QPalette::Base), curve = seriesColour(0, p), live = liveColour(p);
  points_->setPen(QPen(blend(base, p.color(QPalette::Text), 0.6), 1, Qt::DashLine));
  effective_->setPen(QPen(curve, 2.2));
  handles_->setScatterStyle({QCPScatterStyle::ssSquare, QPen(curve, 1.6), QBrush(base), 9});
  chosen_->setScatterStyle({QCPScatterStyle::ssSquare, QPen(curve, 1.6), QBrush(curve), 12});
  operating_->setScatterStyle({QCPScatterStyle::ssDiamond, QPen(base, 1), QBrush(live), 13});
  hover_->setScatterStyle({QCPScatterStyle::ssCircle, QPen(p.color(QPalette::Text), 1), Qt::NoBrush, 7});
  QColor back = base;
  back.setAlpha(225);
  for (QCPItemText* item : {operatingText_, hoverText_}) {
    item->setBrush(back);
    item->setFont(font());
  }
  operatingText_->setColor(live);
  operatingText_->setPen(QPen(live));
  hoverText_->setColor(p.color(QPalette::Text));
  hoverText_->setPen(QPen(blend(base, p.color(QPalette::Text), 0.4)));
  redraw();
}

CurvePoints CurvePlot::curve() const {
  return std::get<CurvePoints>(draft_.value(spec_.key));
}
bool CurvePlot::editable() const {
  return spec_.usesPoints(draft_.parameters());
}

void CurvePlot::fitView() {
  fitted_ = true;
  QCPRange range(spec_.view.low, spec_.view.high);
  for (const CurvePoint& p : curve().span()) range.expand(p.x);
  const double margin = 0.06 * range.size();
  xAxis->setRange(range.lower - margin, range.upper + margin);
  redraw();
}

bool CurvePlot::isAtFault() const {
  return draft_.isBroken() && !draft_.findingsOf(spec_.key).empty();
}

void CurvePlot::describe(const CurvePoints& shown) {
  QString text;
  if (selected() >= 0 && selected() < static_cast<int>(shown.size)) {
    const CurvePoint& p = shown.point[static_cast<std::size_t>(selected())];
    text = tr("Breakpoint %1 of %2: %3 %4, membership %5. ")
               .arg(selected() + 1)
               .arg(shown.size)
               .arg(numberText(p.x, 3), spec_.unit, numberText(p.y, 4));
  }
  setAccessibleDescription(
      text +
      tr("Tab selects a breakpoint, arrow keys move it (Shift: ten times as far), Enter types "
         "its values, Insert adds one, Delete removes it. Ctrl+A, Ctrl and a click, or a rectangle drawn "
         "over empty space select several, which move and go together."));
}

void CurvePlot::redraw() {
  const CurvePoints shown = curve();
  QVector<double> px, py;
  for (const CurvePoint& p : shown.span()) {
    px.append(p.x);
    py.append(p.y);
  }
  handles_->setData(px, py);
  shownAtFault_ = isAtFault();
  const QColor edge = shownAtFault_ ? errorColour(palette()) : seriesColour(0, palette());
  QCPScatterStyle style = handles_->scatterStyle();
  style.setPen(QPen(editable() ? edge : blend(palette().color(QPalette::Base), edge, 0.4), 1.6));
  handles_->setScatterStyle(style);
  chosen_->data()->clear();
  if (editable())
    for (const std::size_t i : group()) chosen_->addData(px[qsizetype(i)], py[qsizetype(i)]);
  describe(shown);

  // The straight lines between the points are constant beyond the ends. redrawEffective() shows them only if
  // the reading computes another curve.
  const QCPRange range = xAxis->range();
  const double beyond = range.size() + std::abs(range.center()) + 1;
  if (!px.isEmpty()) {
    px.prepend(px.first() - beyond);
    py.prepend(py.first());
    px.append(px.last() + beyond);
    py.append(py.last());
  }
  points_->setData(px, py);

  redrawEffective(shown);
  placeLive();
  replot(QCustomPlot::rpQueuedReplot);
}

void CurvePlot::redrawEffective(const CurvePoints& shown) {
  const TuningParameters& parameters = draft_.parameters();
  const QCPRange range = xAxis->range();
  const int labelWidth = fontMetrics().horizontalAdvance(QStringLiteral("-00000 "));
  xAxis->ticker()->setTickCount(std::clamp(axisRect()->width() / labelWidth, 2, 8));
  // The curve is sampled at each pixel, and on both sides of every place where a reading may jump.
  QVector<double> at;
  const int steps = std::max(200, axisRect()->width());
  for (int i = 0; i <= steps; ++i) at.append(range.lower + range.size() * i / steps);
  QVector<double> jumps{0, parameters.altitude.maximum.value(), parameters.pitch.limit.value(),
                        -parameters.pitch.limit.value()};
  for (const CurvePoint& p : shown.span()) jumps.append(p.x);
  for (const double x : jumps)
    if (range.contains(x)) at << std::nextafter(x, -kInfinity) << x << std::nextafter(x, kInfinity);
  std::sort(at.begin(), at.end());
  QVector<double> y;
  double apart = 0;
  for (const double x : at) {
    y.append(spec_.evaluate(parameters, x));
    apart = std::max(apart, std::abs(y.last() - curveValue(shown, x)));
  }
  effective_->setData(at, y, true);
  points_->setVisible(apart > 1e-6);
  redrawGhosts(at, y);
}

void CurvePlot::redrawGhosts(const QVector<double>& at, const QVector<double>& now) {
  for (const Reference which : kGhosts) {
    QVector<Ghosts::Line> lines;
    if (const TuningParameters* values = draft_.reference(which)) {
      Ghosts::Line line;
      double apart = 0;
      for (qsizetype i = 0; i < at.size(); ++i) {
        line << QPointF(at[i], spec_.evaluate(*values, at[i]));
        apart = std::max(apart, std::abs(line.back().y() - now[i]));
      }
      if (apart > 1e-6) lines << line;
    }
    ghosts_->show(which, lines);
  }
}

void CurvePlot::showFrame(const LiveFrame& frame) {
  live_ = CurvePoint{spec_.liveX(frame.decision), spec_.liveY(frame.decision)};
  liveThrottle_.request();
}

void CurvePlot::placeLive() {
  const bool shown = live_ && std::isfinite(live_->x) && std::isfinite(live_->y);
  operatingText_->setVisible(shown);
  operating_->data()->clear();
  if (!shown) return;
  const QCPRange range = xAxis->range();
  const double x = std::clamp(live_->x, range.lower, range.upper);
  operating_->addData(x, live_->y);
  QString text =
      tr("%1 %2: %3").arg(numberText(live_->x, spec_.decimals), spec_.unit, numberText(live_->y, 3));
  if (live_->x > range.upper) text += QStringLiteral(" →");
  if (live_->x < range.lower) text.prepend(QStringLiteral("← "));
  operatingText_->setText(text);
  // The label keeps to the side with more room, above the point or below it near the top.
  const QPointF pixel = pixelOf({x, live_->y});
  const bool left = pixel.x() > axisRect()->center().x(), below = pixel.y() < axisRect()->top() + 30;
  operatingText_->setPositionAlignment((left ? Qt::AlignRight : Qt::AlignLeft) |
                                       (below ? Qt::AlignTop : Qt::AlignBottom));
  operatingText_->position->setCoords(pixel + QPointF(left ? -9 : 9, below ? 9 : -9));
}

void CurvePlot::redrawLive() {
  placeLive();
  layer(QStringLiteral("live"))->replot();
}

void CurvePlot::drawHover(const std::optional<QPointF>& at) {
  const bool shown = at && axisRect()->rect().contains(at->toPoint());
  if (!shown && !hoverText_->visible()) return;
  hoverText_->setVisible(shown);
  hover_->data()->clear();
  if (shown) {
    const int point = pointAt(*at);
    const CurvePoints points = curve();
    const double x =
        point >= 0 ? points.point[static_cast<std::size_t>(point)].x : xAxis->pixelToCoord(at->x());
    const double y = spec_.evaluate(draft_.parameters(), x);
    if (std::isfinite(y)) hover_->addData(x, y);
    hoverText_->setText(tr("%1 %2: %3").arg(numberText(x, spec_.decimals), spec_.unit, numberText(y, 4)));
    const bool left = at->x() > axisRect()->center().x();
    hoverText_->setPositionAlignment((left ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignBottom);
    hoverText_->position->setCoords(at->x() + (left ? -12 : 12), axisRect()->bottom() - 4);
  }
  layer(QStringLiteral("hover"))->replot();
}

QPointF CurvePlot::pixelOf(CurvePoint point) const {
  return {xAxis->coordToPixel(point.x), yAxis->coordToPixel(point.y)};
}

}  // namespace trimtab::views
