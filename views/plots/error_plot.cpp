// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "trimtab/measure/paired_ratio.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/units/not_finite.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr double kMarkerPx = 10, kLiveMarkerPx = 15;
constexpr double kRoom = 0.08;
constexpr int kRoomForHintPx = 170;

QCPScatterStyle::ScatterShape shapeOf(const QString& method) {
  return method == QLatin1String("none")           ? QCPScatterStyle::ssCircle
         : method == QLatin1String("view_frustum") ? QCPScatterStyle::ssSquare
                                                   : QCPScatterStyle::ssTriangle;
}

}  // namespace

/// Draws the live point and the places where it has been, which are the paler the longer ago they were.
class ErrorPlot::Tail : public QCPAbstractItem {
 public:
  explicit Tail(ErrorPlot& plot) : QCPAbstractItem(&plot), plot_(plot) { setClipToAxisRect(true); }
  double selectTest(const QPointF&, bool, QVariant*) const override { return -1; }

 protected:
  void draw(QCPPainter* painter) override {
    const QColor base = plot_.palette().color(QPalette::Base), live = liveColour(plot_.palette());
    QPointF before;
    for (std::size_t i = 0; i < plot_.tail_.size(); ++i) {
      const QPointF at = plot_.placeLive(plot_.tail_[i]);
      if (!std::isfinite(at.x()) || !std::isfinite(at.y())) continue;
      const bool newest = i + 1 == plot_.tail_.size();
      QColor colour = live;
      colour.setAlphaF(newest ? 1.f : 0.1f + 0.6f * float(i + 1) / float(plot_.tail_.size()));
      painter->setPen(QPen(colour, 1.4));
      if (!before.isNull()) painter->drawLine(before, at);
      before = at;
      const bool hollow = newest && !plot_.liveCompares();
      const QPen edge = hollow ? QPen(live, 2) : newest ? QPen(base, 1) : QPen(Qt::NoPen);
      const QCPScatterStyle style(QCPScatterStyle::ssDiamond, edge, hollow ? QBrush(base) : QBrush(colour),
                                  newest ? kLiveMarkerPx : kLiveMarkerPx / 3);
      style.applyTo(painter, QPen(colour));
      style.drawShape(painter, at);
    }
  }

 private:
  ErrorPlot& plot_;
};

ErrorPlot::ErrorPlot(QWidget* parent) : Plot(tr("Frame time against error"), Keyboard::used, parent) {
  setInteractions(QCP::iRangeDrag | QCP::iRangeZoom);
  axisRect()->setupFullAxesBox();
  axisRect()->setRangeZoomFactor(kWheelZoom);
  connect(this, &QCustomPlot::mouseWheel, this, [this] { fitted_ = false; });
  yAxis->setLabel(tr("Frame time (ms)"));
  yAxis->setNumberFormat(QStringLiteral("g"));
  xAxis->setNumberFormat(QStringLiteral("g"));
  xAxis->setNumberPrecision(3);
  yAxis->setNumberPrecision(4);

  addLegendAbove();

  addLayer(QStringLiteral("live"), nullptr, QCustomPlot::limAbove);
  addLayer(QStringLiteral("numbers"), nullptr, QCustomPlot::limAbove);
  liveItem_ = new Tail(*this);
  liveItem_->setLayer(QStringLiteral("live"));
  budgetLine_ = addLine("main", axisRect());
  budgetText_ = new QCPItemText(this);
  budgetText_->position->setTypeX(QCPItemPosition::ptAxisRectRatio);
  budgetText_->setPositionAlignment(Qt::AlignRight | Qt::AlignBottom);
  hint_ = new QCPItemText(this);
  hint_->position->setType(QCPItemPosition::ptAxisRectRatio);
  hint_->position->setCoords(0.5, 0.5);
  hint_->setPositionAlignment(Qt::AlignCenter);
  numbers_ = addReadout("numbers", QMargins(6, 4, 6, 4));
  redraw();
}

const ErrorRun::Error* ErrorPlot::error() const {
  return error_ >= 0 && error_ < run_.errors.size() ? &run_.errors[error_] : nullptr;
}

void ErrorPlot::show(const ErrorRun& run) {
  run_ = run;
  if (!run_.flights().contains(flight_)) flight_ = run_.flights().value(0);
  selected_ = -1;
  fitted_ = true;
  compute();
  redraw();
}

void ErrorPlot::showFlight(const QString& flight) {
  flight_ = run_.flights().contains(flight) ? flight : run_.flights().value(0);
  selected_ = -1;
  compute();
  fitView();
}

void ErrorPlot::showError(int error) {
  error_ = error;
  compute();
  fitView();
}

void ErrorPlot::setLogarithmic(bool on) {
  if (on == logarithmic()) return;
  yAxis->setScaleType(on ? QCPAxis::stLogarithmic : QCPAxis::stLinear);
  yAxis->setTicker(on ? QSharedPointer<QCPAxisTicker>(new QCPAxisTickerLog)
                      : QSharedPointer<QCPAxisTicker>(new QCPAxisTicker));
  fitView();
  emit logarithmicChanged(on);
}

void ErrorPlot::setBudget(double ms) {
  budget_ = std::isfinite(ms) ? ms : 0;
  redraw();
}

void ErrorPlot::showLive(const LiveError& live) {
  tail_.push_back(live);
  if (tail_.size() > kTail) tail_.pop_front();
  redraw();
}

void ErrorPlot::clearLive() {
  if (tail_.empty()) return;
  tail_.clear();
  if (selected_ == int(points_.size())) selected_ = -1;
  redraw();
}

void ErrorPlot::compute() {
  points_.clear();
  const ErrorRun::Error* shown = error();
  if (shown == nullptr) return;
  for (int i = 0; i < run_.series.size(); ++i) {
    const ErrorRun::Series& s = run_.series[i];
    if (s.flight != flight_ || error_ >= s.errors.size() || s.ms.isEmpty()) continue;
    SampleWindow ms(std::size_t(s.ms.size())), errors(std::size_t(s.ms.size()));
    for (const double value : s.ms) ms.add(value);
    for (const double value : s.errors[error_]) errors.add(placeOf(*shown, value));
    if (ms.size() == 0 || errors.size() == 0) continue;
    points_.push_back({i, errors.median(), ms.median(), errors.quantile(0.05), errors.quantile(0.95),
                       ms.quantile(0.05), ms.quantile(0.95)});
  }
  findFront(*shown);
  if (selected_ > int(points_.size())) selected_ = -1;
}

/// Noise puts no point on the front: those are on it that no other surely beats, frame by frame, in one of
/// the two without losing in the other. Too few frames make none.
void ErrorPlot::findFront(const ErrorRun::Error& shown) {
  const double sign = shown.largerIsWorse ? 1 : -1;
  std::vector<double> x, y;
  std::vector<std::vector<double>> errors;
  for (const Point& p : points_) {
    x.push_back(sign * p.error);
    y.push_back(p.ms);
    errors.emplace_back();
    for (const double value : run_.series.at(p.series).errors.at(error_))
      errors.back().push_back(sign * placeOf(shown, value));
    if (medianIntervalRank(errors.back().size()) == 0) return;
  }
  const auto msOf = [&](std::size_t point) {
    return std::span<const double>(run_.series.at(points_[point].series).ms);
  };
  for (const std::size_t i : frontOf(x, y, [&](std::size_t p, std::size_t q) {
         return isBetterInBoth(differenceOf(pairedRatio(msOf(p), msOf(q))),
                               errorDifference(errors[p], errors[q]));
       }))
    points_[i].onFront = true;
}

bool ErrorPlot::liveCompares() const {
  if (tail_.empty() || run_.widthPx == 0 || tail_.back().widthPx == 0) return true;
  return tail_.back().widthPx == run_.widthPx && tail_.back().heightPx == run_.heightPx;
}

QString ErrorPlot::liveName() const {
  if (liveCompares()) return tr("live");
  return tr("live, at %1 × %2 px instead of %3 × %4")
      .arg(tail_.back().widthPx)
      .arg(tail_.back().heightPx)
      .arg(run_.widthPx)
      .arg(run_.heightPx);
}

double ErrorPlot::liveError(const LiveError& live) const {
  const ErrorRun::Error* shown = error();
  return shown != nullptr && error_ < live.errors.size() ? placeOf(*shown, live.errors[error_])
                                                         : std::numeric_limits<double>::quiet_NaN();
}

QPointF ErrorPlot::placeLive(const LiveError& live) const {
  return {xAxis->coordToPixel(liveError(live)), yAxis->coordToPixel(live.ms)};
}

QPointF ErrorPlot::pixelOf(const Point& point) const {
  return {xAxis->coordToPixel(point.error), yAxis->coordToPixel(point.ms)};
}

QPointF ErrorPlot::livePixel() const {
  return tail_.empty() ? QPointF(kNan, kNan) : placeLive(tail_.back());
}

void ErrorPlot::drawPoints() {
  const QColor base = palette().color(QPalette::Base);
  const QStringList presets = run_.presets();
  for (const Point& p : points_) {
    const ErrorRun::Series& s = run_.series[p.series];
    const QColor colour = presetColour(int(presets.indexOf(s.preset)), palette());
    QCPGraph* graph = addGraph();
    graph->setLineStyle(QCPGraph::lsNone);
    graph->setScatterStyle({shapeOf(s.method), QPen(base, 1), QBrush(colour), kMarkerPx});
    graph->setData({p.error}, {p.ms});
    for (const bool vertical : {true, false}) {
      const double at = vertical ? p.ms : p.error;
      const double low = vertical ? p.msLow : p.errorLow, high = vertical ? p.msHigh : p.errorHigh;
      if (std::isnan(low)) continue;
      auto* whisker = new QCPErrorBars(xAxis, yAxis);
      whisker->setErrorType(vertical ? QCPErrorBars::etValueError : QCPErrorBars::etKeyError);
      whisker->setDataPlottable(graph);
      whisker->setData({at - low}, {high - at});
      whisker->setPen(QPen(blend(base, colour, 0.6), 1.2));
      whisker->setWhiskerWidth(5);
      whisker->setSymbolGap(kMarkerPx);
      whisker->removeFromLegend();
    }
  }
}

void ErrorPlot::drawFront() {
  // Points that do not differ share the front, and its line leads along the lower ones.
  const bool worse = error() == nullptr || error()->largerIsWorse;
  QVector<double> x, y;
  for (const Point& p : points_) {
    const bool low = std::none_of(points_.begin(), points_.end(), [&](const Point& q) {
      return q.onFront && (worse ? q.error <= p.error : q.error >= p.error) && q.ms < p.ms;
    });
    if (!p.onFront || !low) continue;
    x << p.error;
    y << p.ms;
  }
  QCPGraph* front = addGraph();
  front->setData(x, y);
  front->setLineStyle(worse ? QCPGraph::lsStepLeft : QCPGraph::lsStepRight);
  front->setPen(
      QPen(blend(palette().color(QPalette::Base), palette().color(QPalette::Text), 0.5), 1.2, Qt::DotLine));
}

/// Names presets by colour and cases by shape, which takes fewer entries than one for each point.
void ErrorPlot::makeLegend() {
  const QColor ink = palette().color(QPalette::Text), base = palette().color(QPalette::Base);
  const auto add = [this](const QString& name, const QCPScatterStyle& style, const QPen& line) {
    QCPGraph* sample = addGraph();
    sample->setName(name);
    sample->setLineStyle(line.style() == Qt::NoPen ? QCPGraph::lsNone : QCPGraph::lsLine);
    sample->setPen(line);
    sample->setScatterStyle(style);
    sample->addToLegend();
  };
  const QStringList presets = run_.presets();
  for (int i = 0; i < presets.size(); ++i)
    add(presets[i], QCPScatterStyle(QCPScatterStyle::ssNone), QPen(presetColour(i, palette()), 5));
  for (const QString& method : run_.methods())
    add(methodText(method), {shapeOf(method), QPen(ink, 1.2), Qt::NoBrush, kMarkerPx}, Qt::NoPen);
  if (!points_.empty())
    add(tr("front"), QCPScatterStyle(QCPScatterStyle::ssNone), QPen(blend(base, ink, 0.5), 1.2, Qt::DotLine));
  if (!tail_.empty())
    add(liveName(),
        liveCompares() ? QCPScatterStyle(QCPScatterStyle::ssDiamond, QPen(base, 1),
                                         QBrush(liveColour(palette())), kMarkerPx)
                       : QCPScatterStyle(QCPScatterStyle::ssDiamond, QPen(liveColour(palette()), 2),
                                         QBrush(base), kMarkerPx),
        Qt::NoPen);
  arrangeLegendAbove();
}

void ErrorPlot::fit() {
  const ErrorRun::Error* shown = error();
  double left = kInfinity, right = -kInfinity, low = kInfinity, high = -kInfinity;
  const auto hold = [&](double x, double y) {
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    left = std::min(left, x);
    right = std::max(right, x);
    if (y > 0) low = std::min(low, y);
    high = std::max(high, y);
  };
  for (const Point& p : points_) {
    hold(p.error, p.ms);
    hold(p.errorLow, p.msLow);
    hold(p.errorHigh, p.msHigh);
  }
  if (points_.empty() || liveCompares())
    for (const LiveError& live : tail_) hold(liveError(live), live.ms);
  if (budget_ > 0) {
    low = std::min(low, budget_);
    high = std::max(high, budget_);
  }
  const bool worse = shown == nullptr || shown->largerIsWorse;
  if (!(left <= right)) {
    left = 0;
    right = worse ? 1 : 100;
  }
  if (worse) left = std::min(left, 0.0);
  const double width = right > left ? right - left : std::max(std::abs(right), 1e-3);
  xAxis->setRange(left - width * kRoom, right + width * kRoom);
  xAxis->setRangeReversed(!worse);
  if (!(low <= high)) low = high = 1;
  if (logarithmic())
    yAxis->setRange(low / 1.5, high * 1.5);
  else
    yAxis->setRange(0, high * (1 + 2 * kRoom));
}

void ErrorPlot::fitView() {
  fitted_ = true;
  redraw();
}

void ErrorPlot::redraw() {
  clearPlottables();
  const ErrorRun::Error* shown = error();
  xAxis->setLabel(shown == nullptr       ? tr("Error")
                  : shown->largerIsWorse ? titleOf(*shown)
                                         : tr("%1, larger is better").arg(titleOf(*shown)));
  drawFront();
  drawPoints();
  makeLegend();
  if (fitted_) fit();
  applyThemeWithLegendAbove();

  const QColor over = errorColour(palette());
  const bool hasBudget = budget_ > 0;
  budgetLine_->setVisible(hasBudget);
  budgetText_->setVisible(hasBudget);
  if (hasBudget) {
    putHorizontal(*budgetLine_, budget_);
    budgetLine_->setPen(QPen(over, 1.4, Qt::DashLine));
    budgetText_->position->setCoords(0.99, budget_);
    budgetText_->setText(tr("budget %1").arg(msText(budget_)));
    budgetText_->setColor(over);
    budgetText_->setFont(font());
  }
  hint_->setVisible(points_.empty() && tail_.empty() && height() > kRoomForHintPx / 2);
  hint_->setText(
      tr("Nothing measured yet.\nMeasure presets or open results;\nMeasure live shows this session."));
  hint_->setColor(quietColour(palette()));
  hint_->setFont(font());
  const QFontMetrics metrics(font());
  xAxis->ticker()->setTickCount(
      std::clamp(axisRect()->width() / metrics.horizontalAdvance(QStringLiteral("0.00000   ")), 2, 7));
  if (!logarithmic()) yAxis->ticker()->setTickCount(std::clamp(height() / (3 * metrics.height()), 2, 6));
  placeText();
  replot(QCustomPlot::rpQueuedReplot);
}

}  // namespace trimtab::views
