// SPDX-License-Identifier: GPL-3.0-or-later
#include "term_plot.h"

#include <algorithm>
#include <cmath>

#include "trimtab/preset/policy_lines.h"
#include "trimtab/units/not_finite.h"
#include "views/model/keys.h"
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
    : PointPlot(tr("Terms of a signal"), policy.draft(), key::kPolicyTerms, parent),
      policy_(policy),
      track_(track) {
  makeItems();
  readGhosts();
  fitView();
  restyle();
  connect(&policy_, &PolicyDraft::termsChanged, this, [this] {
    if (termAt(term_) == nullptr) selectTerm(-1);
    fitViewUnlessMoving();
  });
  connect(&draft(), &Draft::referencesChanged, this, [this] {
    readGhosts();
    redraw();
  });
}

void TermPlot::makeItems() {
  addLegendAbove();
  yAxis->setLabel(tr("Membership"));
  yAxis->setRange(kTrailLow, kTop);
  const QSharedPointer<QCPAxisTickerFixed> ticks(new QCPAxisTickerFixed);
  ticks->setTickStep(0.5);
  yAxis->setTicker(ticks);
  xAxis->setNumberFormat(QStringLiteral("gb"));
  xAxis->setNumberPrecision(6);
  Parts& p = parts_;
  for (QCPItemStraightLine*& limit : p.limits) limit = addLine("main", axisRect());
  p.trail = new QCPCurve(xAxis, yAxis);
  p.trail->setLayer(QStringLiteral("live"));
  p.live = addLine("live", axisRect());
  p.live->setVisible(false);
  p.empty = new QCPItemText(this);
  p.empty->position->setType(QCPItemPosition::ptAxisRectRatio);
  p.empty->position->setCoords(0.5, 0.4);
}

void TermPlot::restyle() {
  applyThemeWithLegendAbove();
  const QPalette& palette = this->palette();
  const QColor base = palette.color(QPalette::Base), ink = palette.color(QPalette::Text),
               live = liveColour(palette);
  Parts& p = parts_;
  p.trail->setPen(QPen(live, 1.6));
  p.live->setPen(QPen(live, 1.2, Qt::DashLine));
  for (QCPItemStraightLine* limit : p.limits) limit->setPen(QPen(blend(base, ink, 0.45), 1, Qt::DotLine));
  p.empty->setColor(quietColour(palette));
  p.empty->setFont(font());
  PointPlot::restyle();
}

void TermPlot::setSignal(Signal signal) {
  if (signal == signal_ && term_ >= 0) return redraw();
  signal_ = signal;
  term_ = -1;
  forgetSelection();
  drawnTrack_ = 0;
  const std::vector<std::size_t> terms = policy_.termsOf(signal);
  if (!terms.empty()) term_ = static_cast<int>(terms.front());
  value_ = std::numeric_limits<double>::quiet_NaN();
  fitView();
  emit selectedChanged(selected());
}

const PolicyTerm* TermPlot::termAt(int line) const {
  const auto& lines = policy_.terms();
  if (line < 0 || line >= static_cast<int>(lines.size())) return nullptr;
  const auto& term = lines[static_cast<std::size_t>(line)].term;
  return term && term->signal == signal_ ? &*term : nullptr;
}

std::vector<EditPoint> TermPlot::points() const {
  const PolicyTerm* term = termAt(term_);
  return term != nullptr ? handlesOf(*term, view()) : std::vector<EditPoint>{};
}

void TermPlot::redraw() {
  const SignalRow& row = rowOf(signal_);
  xAxis->setLabel(fromView(row.label) + inParentheses(row.unit));
  putVertical(*parts_.limits[0], row.range.low);
  putVertical(*parts_.limits[1], row.range.high);
  setAccessibleName(tr("Terms of %1").arg(fromView(row.label)));
  drawCurves();
  placeLive();
  drawTrail();
  const std::vector<std::size_t> lines = policy_.termsOf(signal_);
  const auto place = std::ranges::find(lines, static_cast<std::size_t>(std::max(term_, 0)));
  showPoints(colourOf(static_cast<std::size_t>(place - lines.begin()), palette()));
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
  const QColor base = palette().color(QPalette::Base);
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
      QVector<double> jumps;
      for (const EditPoint& point : handlesOf(term, view())) jumps << point.x;
      at = samples(jumps);
      for (const double x : at) y << membershipOf(term, x);
    }
    curve.setData(at, y, true);
  }
  drawGhosts(samples({}));
  parts_.empty->setVisible(lines.empty());
  parts_.empty->setText(tr("%1 has no terms. “Add” makes one.").arg(fromView(rowOf(signal_).label)));
  arrangeLegendAbove();
}

void TermPlot::readGhosts() {
  for (std::size_t i = 0; i < kGhosts.size(); ++i) {
    ghostTerms_[i].clear();
    const TuningParameters* values = draft().reference(kGhosts[i]);
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
    behind().show(kGhosts[i], drawn);
  }
}

QString TermPlot::describe() const {
  QString text;
  if (const PolicyTerm* term = termAt(term_)) {
    text = tr("%1, %2. ").arg(QString::fromStdString(term->name), QString::fromStdString(shapeText(*term)));
    if (selected() >= 0) {
      const EditPoint at = points()[static_cast<std::size_t>(selected())];
      text += tr("%1: %2, membership %3. ").arg(at.name, signalText(signal_, at.x), numberText(at.y, 3));
    }
    if (const std::size_t count = group().size(); count > 1)
      text += tr("%1 points are selected. ").arg(count);
  }
  return text +
         tr("Tab selects a point, Ctrl+A all of them, Page Up and Page Down a term; arrow keys move what is "
            "selected (Shift: ten times as far; Ctrl: to a point of another term), Enter types the numbers, "
            "Insert and Delete add and remove a point, A and Ctrl+Delete a term.");
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
  liveText()->setVisible(known);
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
  putLiveText(value_, signalText(signal_, value_),
              {xAxis->coordToPixel(std::clamp(counts, range.lower, range.upper)), axisRect()->top() - 6.0},
              false);
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
