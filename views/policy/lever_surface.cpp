// SPDX-License-Identifier: GPL-3.0-or-later
#include "lever_surface.h"

#include <QAction>
#include <QBoxLayout>
#include <QComboBox>
#include <QLabel>
#include <QStandardItemModel>
#include <algorithm>
#include <cmath>
#include <limits>

#include "term_edit.h"
#include "trimtab/units/not_finite.h"
#include "views/model/ig_words.h"
#include "views/model/theme.h"
#include "views/plots/cividis.h"

namespace trimtab::views {
namespace {

// So many take some four milliseconds to compute for 40 rules, and the colour map interpolates between them.
constexpr int kColumns = 121, kRows = 81, kSurfaceMs = 200;
/// Another signal that moves by less than this part of its range leaves the surface as it is.
constexpr double kSteady = 0.01;

double at(const QCPRange& range, int i, int count) {
  return range.lower + range.size() * i / (count - 1);
}

QString axisText(Signal signal) {
  return fromView(rowOf(signal).label) + inParentheses(rowOf(signal).unit);
}

}  // namespace

LeverSurface::LeverSurface(PolicyDraft& policy, const PolicyTrack& track, QWidget* parent)
    : Plot(tr("A lever over two signals"), Keyboard::used, parent),
      policy_(policy),
      track_(track),
      throttle_(
          this, [this] { compute(); }, kSurfaceMs) {
  makePlottables();
  restyle();
  connect(&policy_.draft(), &Draft::activeChanged, this, [this] {
    const Policy runs = policy_.active();
    if (runs == drawn_) return;
    if (fitted_ && runs.terms != drawn_.terms) fitView();
    throttle_.request();
  });
  connect(&policy_.draft(), &Draft::loaded, this, &LeverSurface::fitView);
  for (QCPAxis* const axis : {xAxis, yAxis})
    connect(axis, qOverload<const QCPRange&>(&QCPAxis::rangeChanged), this, [this] { throttle_.request(); });
  connect(this, &QCustomPlot::mouseWheel, this, [this] { fitted_ = false; });
  connect(this, &QCustomPlot::mousePress, this, [this] { fitted_ = false; });
  connect(this, &QCustomPlot::mouseDoubleClick, this, &LeverSurface::fitView);
  auto* fit = new QAction(tr("Fit"), this);
  fit->setShortcut(Qt::Key_F);
  fit->setShortcutContext(Qt::WidgetShortcut);
  connect(fit, &QAction::triggered, this, &LeverSurface::fitView);
  addAction(fit);
  setContextMenuPolicy(Qt::ActionsContextMenu);
  fitView();
}

void LeverSurface::makePlottables() {
  addOverlays({"live", "hover"});
  for (QCPAxis* const axis : {xAxis, yAxis}) {
    axis->setNumberFormat(QStringLiteral("gb"));
    axis->setNumberPrecision(6);
    axis->ticker()->setTickCount(4);
  }
  setInteractions(QCP::iRangeDrag | QCP::iRangeZoom);
  axisRect()->setupFullAxesBox();
  map_ = new QCPColorMap(xAxis, yAxis);
  map_->setTightBoundary(true);
  QCPColorGradient gradient = cividis();
  gradient.setNanHandling(QCPColorGradient::nhTransparent);
  map_->setGradient(gradient);
  scale_ = addColourScale(gradient);
  const auto curve = [this](const QColor& ink, double width) {
    auto* made = new QCPCurve(xAxis, yAxis);
    made->setLayer(QStringLiteral("live"));
    made->setPen(QPen(ink, width, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    return made;
  };
  trackHalo_ = curve(Qt::white, 4);
  trackLine_ = curve(QColor(213, 94, 0), 2);
  live_ = addGraph();
  live_->setLayer(QStringLiteral("live"));
  live_->setLineStyle(QCPGraph::lsNone);
  live_->setScatterStyle({QCPScatterStyle::ssCircle, QPen(Qt::black, 2), QBrush(Qt::white), 11});
  hover_ = addReadout("hover", QMargins(5, 3, 5, 3));
  empty_ = new QCPItemText(this);
  empty_->position->setType(QCPItemPosition::ptAxisRectRatio);
  empty_->position->setCoords(0.5, 0.5);
  empty_->setTextAlignment(Qt::AlignCenter);
}

void LeverSurface::restyle() {
  applyTheme(*this);
  applyThemeTo(*scale_);
  empty_->setColor(quietColour(palette()));
  empty_->setFont(font());
  replot(rpQueuedReplot);
}

void LeverSurface::choose(Lever lever, Signal x, Signal y) {
  lever_ = lever;
  x_ = x;
  y_ = y;
  drawnTrack_ = 0;
  fitView();
}

void LeverSurface::fitView() {
  fitted_ = true;
  const std::vector<PolicyTerm> terms = policy_.active().terms;
  const Range x = viewOf(x_, terms), y = viewOf(y_, terms);
  xAxis->setRange(x.low, x.high);
  yAxis->setRange(y.low, y.high);
  throttle_.request();
}

bool LeverSurface::zoomByKey(double factor) {
  fitted_ = false;
  xAxis->scaleRange(factor);
  yAxis->scaleRange(factor);
  return true;
}

void LeverSurface::compute() {
  ++computed_;
  drawn_ = policy_.active();
  if (const auto compiled = compile(drawn_, "")) compiled_ = *compiled;
  around_ = flight_;
  for (const SignalRow& row : kSignalRows)
    if (std::isnan(around_[row.signal])) {
      const Range view = viewOf(row.signal, drawn_.terms);
      around_[row.signal] = (view.low + view.high) / 2;
    }
  xAxis->setLabel(axisText(x_));
  yAxis->setLabel(axisText(y_));
  // The combo box above names the lever.
  scale_->axis()->setLabel(fromView(rowOf(lever_).unit));
  const QCPRange x = xAxis->range(), y = yAxis->range();
  QCPColorMapData& cells = *map_->data();
  if (cells.keySize() != kColumns || cells.valueSize() != kRows) cells.setSize(kColumns, kRows);
  cells.setRange(x, y);
  double least = std::numeric_limits<double>::infinity(), most = -least;
  PolicyDecision decision;
  SignalValues place = around_;
  for (int r = 0; r < kRows; ++r) {
    place[y_] = at(y, r, kRows);
    for (int c = 0; c < kColumns; ++c) {
      place[x_] = at(x, c, kColumns);
      compiled_.decide(place, decision);
      const double target = decision.target[lever_];
      cells.setCell(c, r, target);
      if (std::isnan(target)) continue;
      least = std::min(least, target);
      most = std::max(most, target);
    }
  }
  const Range usual = rowOf(lever_).usual;
  const bool any = least <= most;
  // The usual range, so that two surfaces compare; wider where the rules are.
  const QCPRange values(any ? std::min(least, usual.low) : usual.low,
                        any ? std::max(most, usual.high) : usual.high);
  map_->setDataRange(values);
  scale_->setDataRange(values);
  empty_->setVisible(!any);
  empty_->setText(compiled_.moves(lever_) ? tr("No rule for this lever fires here.")
                                          : tr("No rule sets %1.").arg(fromView(rowOf(lever_).label)));
  drawLive();
  replot(rpQueuedReplot);
}

double LeverSurface::targetAt(double x, double y) const {
  if (!xAxis->range().contains(x) || !yAxis->range().contains(y)) return kNan;
  SignalValues place = around_;
  place[y_] = y;
  place[x_] = x;
  PolicyDecision decision;
  compiled_.decide(place, decision);
  return decision.target[lever_];
}

void LeverSurface::showLive(const PolicyLive& live) {
  if (live.seen) flight_ = live.flight;
  const bool moved = std::any_of(kSignalRows.begin(), kSignalRows.end(), [&](const SignalRow& row) {
    if (row.signal == x_ || row.signal == y_ || !compiled_.asks(row.signal)) return false;
    const Range view = viewOf(row.signal, drawn_.terms);
    return std::abs(flight_[row.signal] - around_[row.signal]) > kSteady * (view.high - view.low);
  });
  if (moved) throttle_.request();
  if (!isVisible() || drawnTrack_ == track_.revision()) return;
  drawLive();
  layer(QStringLiteral("live"))->replot();
}

void LeverSurface::drawLive() {
  drawnTrack_ = track_.revision();
  QVector<QCPCurveData> points;
  for (const PolicyTrack::Sample& sample : track_.samples())
    points << QCPCurveData(double(points.size()), sample.flight[x_], sample.flight[y_]);
  for (QCPCurve* curve : {trackHalo_, trackLine_}) curve->data()->set(points, true);
  if (std::isfinite(flight_[x_]) && std::isfinite(flight_[y_]))
    live_->setData({flight_[x_]}, {flight_[y_]});
  else
    live_->data()->clear();
}

void LeverSurface::mouseMoveEvent(QMouseEvent* event) {
  Plot::mouseMoveEvent(event);
  const double x = xAxis->pixelToCoord(event->position().x()), y = yAxis->pixelToCoord(event->position().y());
  const bool shown = axisRect()->rect().contains(event->position().toPoint());
  hover_->setVisible(shown);
  if (shown) {
    const double target = targetAt(x, y);
    placeReadout(*hover_,
                 QStringLiteral("%1, %2\n%3")
                     .arg(signalText(x_, x), signalText(y_, y),
                          std::isnan(target) ? tr("no rule fires: neutral")
                                             : fromView(rowOf(lever_).label) + QStringLiteral(" ") +
                                                   leverText(lever_, target)),
                 event->position());
  }
  layer(QStringLiteral("hover"))->replot();
}

void LeverSurface::leaveEvent(QEvent* event) {
  Plot::leaveEvent(event);
  hover_->setVisible(false);
  layer(QStringLiteral("hover"))->replot();
}

SurfacePage::SurfacePage(PolicyDraft& policy, const PolicyTrack& track, QWidget* parent)
    : QWidget(parent),
      surface_(new LeverSurface(policy, track)),
      lever_(new QComboBox),
      x_(new QComboBox),
      y_(new QComboBox) {
  for (const LeverRow& row : kLeverRows) lever_->addItem(fromView(row.label));
  for (const SignalRow& row : kSignalRows)
    for (QComboBox* box : {x_, y_}) box->addItem(fromView(row.label));
  lever_->setCurrentIndex(static_cast<int>(Lever::screen_space_error));
  Draft* const draft = &policy.draft();
  connect(draft, &Draft::imageGeneratorChanged, this, [this, draft] { greyLevers(draft->imageGenerator()); });
  x_->setCurrentIndex(static_cast<int>(Signal::above_ground));
  y_->setCurrentIndex(static_cast<int>(Signal::speed));
  auto *leverRow = new QHBoxLayout, *signalsRow = new QHBoxLayout;
  const auto add = [&](QHBoxLayout& row, QComboBox* box, const QString& label, const QString& name) {
    auto* text = new QLabel(label);
    text->setBuddy(box);
    box->setAccessibleName(name);
    box->setToolTip(name);
    box->setSizeAdjustPolicy(QComboBox::AdjustToContents);
    row.addWidget(text);
    row.addWidget(box);
    connect(box, &QComboBox::currentIndexChanged, this, &SurfacePage::choose);
  };
  add(*leverRow, lever_, tr("Lever"), tr("Lever whose target is shown"));
  add(*signalsRow, x_, tr("over"), tr("Signal to the right"));
  add(*signalsRow, y_, tr("and"), tr("Signal upward"));
  for (QHBoxLayout* row : {leverRow, signalsRow}) row->addStretch(1);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->setSpacing(4);
  layout->addLayout(leverRow);
  layout->addLayout(signalsRow);
  layout->addWidget(surface_, 1);
  setFocusProxy(lever_);
}

/// A lever that was chosen before stays, so that one can see what the rules would do with it.
void SurfacePage::greyLevers(const IgProfile* ig) {
  auto& items = *qobject_cast<QStandardItemModel*>(lever_->model());
  for (int i = 0; i < items.rowCount(); ++i) {
    const std::string_view key = kLeverRows[static_cast<std::size_t>(i)].key;
    const QString lacks = lacksText(ig, key);
    items.item(i)->setEnabled(lacks.isEmpty());
    items.item(i)->setToolTip(lacks.isEmpty() ? ownRangeText(ig, key) : lacks);
  }
}

void SurfacePage::choose() {
  surface_->choose(static_cast<Lever>(lever_->currentIndex()), static_cast<Signal>(x_->currentIndex()),
                   static_cast<Signal>(y_->currentIndex()));
}

}  // namespace trimtab::views
