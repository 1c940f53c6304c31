// SPDX-License-Identifier: GPL-3.0-or-later
#include "term_plot.h"

#include <algorithm>
#include <cmath>

#include "trimtab/preset/policy_lines.h"
#include "trimtab/units/not_finite.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr double kTop = 1.1, kTrailLow = -0.24, kTrailHigh = -0.05, kTrailS = 10;

}  // namespace

QColor TermPlot::colourOf(std::size_t place, const QPalette& palette) {
  // Orange is the live value's.
  static constexpr int kSeries[] = {0, 2, 3, 5, 4, 6};
  return seriesColour(kSeries[place % std::size(kSeries)], palette);
}

TermPlot::TermPlot(PolicyDraft& policy, const PolicyTrack& track, QWidget* parent)
    : Plot(tr("Terms of a signal"), Keyboard::used, parent),
      policy_(policy),
      track_(track),
      hand_(policy.draft()) {
  makeItems();
  readGhosts();
  restyle();
  connect(&policy_, &PolicyDraft::termsChanged, this, [this] {
    if (termAt(term_) == nullptr) select(-1);
    if (fitted_ && !hand_.moving())
      fitView();
    else
      redraw();
  });
  connect(&policy_.draft(), &Draft::findingsChanged, this, [this] { drawPoints(); });
  connect(&policy_.draft(), &Draft::loaded, this, &TermPlot::fitView);
  connect(&policy_.draft(), &Draft::referencesChanged, this, [this] {
    readGhosts();
    redraw();
  });
}

void TermPlot::makeItems() {
  addOverlays({"live", "hover"});
  addLegendAbove();
  ghosts_.emplace(*this, policy_.draft());
  yAxis->setLabel(tr("Membership"));
  yAxis->setRange(kTrailLow, kTop);
  const QSharedPointer<QCPAxisTickerFixed> ticks(new QCPAxisTickerFixed);
  ticks->setTickStep(0.5);
  yAxis->setTicker(ticks);
  xAxis->setNumberFormat(QStringLiteral("gb"));
  xAxis->setNumberPrecision(6);
  axisRect()->setRangeZoom(Qt::Horizontal);
  axisRect()->setRangeZoomFactor(kWheelZoom);
  setInteraction(QCP::iRangeZoom);
  axisRect()->setupFullAxesBox();
  connect(this, &QCustomPlot::mouseWheel, this, [this] { fitted_ = false; });
  connect(xAxis, qOverload<const QCPRange&>(&QCPAxis::rangeChanged), this, [this] {
    if (!fitted_) redraw();
  });
  Parts& p = parts_;
  p.points = addGraph();
  p.chosen = addGraph();
  for (QCPGraph* g : {p.points, p.chosen}) {
    g->setLineStyle(QCPGraph::lsNone);
    g->setAdaptiveSampling(false);
  }
  for (QCPItemStraightLine*& limit : p.limits) limit = addLine("main", axisRect());
  p.trail = new QCPCurve(xAxis, yAxis);
  p.trail->setLayer(QStringLiteral("live"));
  p.live = addLine("live", axisRect());
  p.live->setVisible(false);
  p.liveText = addReadout("live", QMargins(4, 1, 4, 1));
  p.readout = addReadout("hover", QMargins(5, 3, 5, 3));
  p.empty = new QCPItemText(this);
  p.empty->position->setType(QCPItemPosition::ptAxisRectRatio);
  p.empty->position->setCoords(0.5, 0.4);
}

void TermPlot::restyle() {
  applyThemeWithLegendAbove();
  ghosts_->restyle(this->palette());
  const QPalette& palette = this->palette();
  const QColor base = palette.color(QPalette::Base), ink = palette.color(QPalette::Text),
               live = liveColour(palette);
  Parts& p = parts_;
  p.trail->setPen(QPen(live, 1.6));
  p.live->setPen(QPen(live, 1.2, Qt::DashLine));
  for (QCPItemStraightLine* limit : p.limits) limit->setPen(QPen(blend(base, ink, 0.45), 1, Qt::DotLine));
  p.liveText->setColor(live);
  p.liveText->setPen(QPen(live));
  p.liveText->setBrush(base);
  p.liveText->setFont(font());
  p.empty->setColor(quietColour(palette));
  p.empty->setFont(font());
  redraw();
}

void TermPlot::setSignal(Signal signal) {
  if (signal == signal_ && term_ >= 0) return redraw();
  signal_ = signal;
  term_ = -1;
  hand_.select(-1, 0);
  hand_.endDrag();
  hand_.endNudge();
  drawnTrack_ = 0;
  const std::vector<std::size_t> terms = policy_.termsOf(signal);
  if (!terms.empty()) term_ = static_cast<int>(terms.front());
  value_ = std::numeric_limits<double>::quiet_NaN();
  fitView();
  emit selectedChanged(term_, handle());
}

void TermPlot::fitView() {
  fitted_ = true;
  const Range view = viewOf(signal_, policy_.policy().terms);
  xAxis->setRange(view.low, view.high);
  redraw();
}

bool TermPlot::zoomByKey(double factor) {
  fitted_ = false;
  xAxis->scaleRange(factor);
  redraw();
  return true;
}

const PolicyTerm* TermPlot::termAt(int line) const {
  const auto& lines = policy_.terms();
  if (line < 0 || line >= static_cast<int>(lines.size())) return nullptr;
  const auto& term = lines[static_cast<std::size_t>(line)].term;
  return term && term->signal == signal_ ? &*term : nullptr;
}

std::vector<TermHandle> TermPlot::handles() const {
  const PolicyTerm* term = termAt(term_);
  return term != nullptr ? handlesOf(*term, view()) : std::vector<TermHandle>{};
}

QPointF TermPlot::pixelOf(double x, double y) const {
  return {xAxis->coordToPixel(x), yAxis->coordToPixel(y)};
}

void TermPlot::redraw() {
  const SignalRow& row = rowOf(signal_);
  xAxis->setLabel(fromView(row.label) + inParentheses(row.unit));
  const int label = fontMetrics().horizontalAdvance(QStringLiteral("-000000 "));
  xAxis->ticker()->setTickCount(std::clamp(axisRect()->width() / label, 2, 8));
  putVertical(*parts_.limits[0], row.range.low);
  putVertical(*parts_.limits[1], row.range.high);
  setAccessibleName(tr("Terms of %1").arg(fromView(row.label)));
  drawCurves();
  drawPoints();
  placeLive();
  drawTrail();
  emit picturedTermsChanged();
}

void TermPlot::drawCurves() {
  const std::vector<std::size_t> lines = policy_.termsOf(signal_);
  Parts& p = parts_;
  while (p.curves.size() > qsizetype(lines.size())) {
    removeGraph(p.curves.takeLast());
    removeGraph(p.marks.takeLast());
  }
  while (p.curves.size() < qsizetype(lines.size())) {
    p.curves << addGraph();
    p.curves.back()->setAdaptiveSampling(false);
    p.curves.back()->addToLegend();
    p.marks << addGraph();
    p.marks.back()->setLineStyle(QCPGraph::lsNone);
    p.marks.back()->setLayer(QStringLiteral("live"));
  }
  const QCPRange range = xAxis->range();
  const int steps = std::max(200, axisRect()->width());
  const QColor base = palette().color(QPalette::Base);
  QVector<double> even;
  for (int s = 0; s <= steps; ++s) even << range.lower + range.size() * s / steps;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    QCPGraph& curve = *p.curves[qsizetype(i)];
    const PolicyDraft::TermLine& line = policy_.terms()[lines[i]];
    const PolicyTerm& term = *line.term;
    const bool selected = static_cast<int>(lines[i]) == term_;
    const QColor colour = colourOf(i, palette());
    static constexpr Qt::PenStyle kDashes[] = {Qt::SolidLine, Qt::DashLine, Qt::DashDotLine};
    curve.setPen(QPen(colour, selected ? 2.8 : 1.6, kDashes[i / 6 % 3]));
    curve.setName(QString::fromStdString(term.name));
    p.marks[qsizetype(i)]->setScatterStyle({QCPScatterStyle::ssDiamond, QPen(base, 1), QBrush(colour), 12});
    QVector<double> at, y;
    if (line.sound) {
      at = even;
      for (const TermHandle& handle : handlesOf(term, {range.lower, range.upper}))
        if (range.contains(handle.x))
          at << std::nextafter(handle.x, -kInfinity) << handle.x << std::nextafter(handle.x, kInfinity);
      std::sort(at.begin(), at.end());
      for (const double x : at) y << membershipOf(term, x);
    }
    curve.setData(at, y, true);
  }
  drawGhosts(even);
  parts_.empty->setVisible(lines.empty());
  parts_.empty->setText(tr("%1 has no terms. “Add” makes one.").arg(fromView(rowOf(signal_).label)));
  arrangeLegendAbove();
}

void TermPlot::readGhosts() {
  for (std::size_t i = 0; i < kGhosts.size(); ++i) {
    ghostTerms_[i].clear();
    const TuningParameters* values = policy_.draft().reference(kGhosts[i]);
    if (!values) continue;
    if (const auto policy = policyOf(values->policy)) ghostTerms_[i] = policy->terms;
    std::erase_if(ghostTerms_[i], [](const PolicyTerm& term) { return !isSound(term); });
  }
}

/// A term is a ghost unless the draft has the very same one.
void TermPlot::drawGhosts(const QVector<double>& at) {
  const std::vector<std::size_t> lines = policy_.termsOf(signal_);
  for (std::size_t i = 0; i < kGhosts.size(); ++i) {
    QVector<Ghosts::Line> drawn;
    for (const PolicyTerm& term : ghostTerms_[i]) {
      const bool same =
          std::ranges::any_of(lines, [&](std::size_t line) { return *policy_.terms()[line].term == term; });
      if (term.signal != signal_ || same) continue;
      Ghosts::Line line;
      for (const double x : at) line << QPointF(x, membershipOf(term, x));
      drawn << line;
    }
    ghosts_->show(kGhosts[i], drawn);
  }
}

void TermPlot::drawPoints() {
  const std::vector<std::size_t> lines = policy_.termsOf(signal_);
  const auto place = std::find(lines.begin(), lines.end(), static_cast<std::size_t>(std::max(term_, 0)));
  const bool broken = policy_.draft().isBroken() && !policy_.draft().findingsOf("policy.terms").empty();
  const QColor base = palette().color(QPalette::Base);
  const QColor colour =
      broken ? errorColour(palette()) : colourOf(static_cast<std::size_t>(place - lines.begin()), palette());
  parts_.points->setScatterStyle({QCPScatterStyle::ssSquare, QPen(colour, 1.6), QBrush(base), 9});
  parts_.chosen->setScatterStyle({QCPScatterStyle::ssSquare, QPen(colour, 1.6), QBrush(colour), 12});
  const std::vector<TermHandle> points = handles();
  QVector<double> x, y;
  for (const TermHandle& handle : points) x << handle.x, y << handle.y;
  parts_.points->setData(x, y);
  if (handle() >= static_cast<int>(points.size())) hand_.select(-1, 0);
  parts_.chosen->data()->clear();
  for (const std::size_t i : group()) parts_.chosen->addData(points[i].x, points[i].y);
  describe();
  replot(rpQueuedReplot);
}

void TermPlot::describe() {
  QString text;
  if (const PolicyTerm* term = termAt(term_)) {
    text = tr("%1, %2. ").arg(QString::fromStdString(term->name), QString::fromStdString(shapeText(*term)));
    const std::vector<TermHandle> points = handles();
    if (handle() >= 0 && handle() < static_cast<int>(points.size())) {
      const TermHandle& at = points[static_cast<std::size_t>(handle())];
      text += tr("%1: %2, membership %3. ").arg(at.name, signalText(signal_, at.x), numberText(at.y, 3));
    }
    if (const std::size_t count = group().size(); count > 1)
      text += tr("%1 points are selected. ").arg(count);
  }
  setAccessibleDescription(
      text +
      tr("Tab selects a point, Ctrl+A all of them, Page Up and Page Down a term; arrow keys move what is "
         "selected (Shift: ten times as far; Ctrl: to a point of another term), Enter types the numbers, "
         "Insert and Delete add and remove a point, A and Ctrl+Delete a term."));
}

void TermPlot::showLive(const PolicyLive& live) {
  const double now = live.seen ? live.flight[signal_] : std::numeric_limits<double>::quiet_NaN();
  const bool same = now == value_ || (std::isnan(now) && std::isnan(value_));
  if (same && drawnTrack_ == track_.revision()) return;
  value_ = now;
  placeLive();
  drawTrail();
  layer(QStringLiteral("live"))->replot();
}

void TermPlot::placeLive() {
  const bool known = std::isfinite(value_);
  const QCPRange range = xAxis->range();
  const SignalRow& row = rowOf(signal_);
  const double counts = std::clamp(value_, row.range.low, row.range.high);
  parts_.live->setVisible(known && range.contains(counts));
  parts_.liveText->setVisible(known);
  const std::vector<std::size_t> lines = policy_.termsOf(signal_);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    QCPGraph& mark = *parts_.marks[qsizetype(i)];
    const PolicyTerm& term = *policy_.terms()[lines[i]].term;
    if (known && range.contains(counts) && !parts_.curves[qsizetype(i)]->data()->isEmpty())
      mark.setData({counts}, {membershipOf(term, counts)});
    else
      mark.data()->clear();
  }
  if (!known) return;
  putVertical(*parts_.live, counts);
  QString text = signalText(signal_, value_);
  if (value_ > range.upper) text += QStringLiteral(" →");
  if (value_ < range.lower) text.prepend(QStringLiteral("← "));
  parts_.liveText->setText(text);
  const double x = xAxis->coordToPixel(std::clamp(counts, range.lower, range.upper));
  const bool left = x > axisRect()->center().x();
  parts_.liveText->setPositionAlignment((left ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignTop);
  parts_.liveText->position->setCoords(x + (left ? -5 : 5), axisRect()->top() + 3);
}

void TermPlot::drawTrail() {
  drawnTrack_ = track_.revision();
  QVector<QCPCurveData> points;
  if (!track_.samples().empty() && std::isfinite(value_)) {
    const auto& samples = track_.samples();
    for (auto sample = samples.rbegin(); sample != samples.rend(); ++sample) {
      const double age = samples.back().time - sample->time;
      if (age > kTrailS) break;
      points << QCPCurveData(double(points.size()), sample->flight[signal_],
                             kTrailHigh + (kTrailLow - kTrailHigh) * age / kTrailS);
    }
  }
  parts_.trail->data()->set(points, true);
}

}  // namespace trimtab::views
