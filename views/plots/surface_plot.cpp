// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_plot.h"

#include <QAction>
#include <algorithm>
#include <cmath>

#include "cividis.h"
#include "contour.h"
#include "trimtab/fuzzy/bands.h"
#include "trimtab/fuzzy/combination.h"
#include "trimtab/fuzzy/membership.h"
#include "trimtab/units/not_finite.h"
#include "views/model/theme.h"

namespace trimtab::views {

namespace {

// So many take a third of a millisecond to compute, and the colour map interpolates between them.
constexpr int kColumns = 241, kRows = 161;
constexpr std::size_t kLongestTrack = 4000;

/// Whether two sets of parameters have the same surface and bands.
bool sameSurface(const TuningParameters& a, const TuningParameters& b) {
  return std::ranges::all_of(parameterRows(), [&](const ParameterRow& row) {
    return !row.key.starts_with("fuzzy.") || row.get(a) == row.get(b);
  });
}

QCPRange altitudeRange(const AltitudeParameters& p) {
  QCPRange range(p.curve.point[0].x, p.curve.point[p.curve.size - 1].x);
  if (p.reading != AltitudeReading::table) range.upper = std::max(range.upper, p.maximum.value());
  const double margin = std::max(500.0, 0.25 * range.size());
  return {range.lower - margin, range.upper + margin};
}

QCPRange pitchRange(const PitchParameters& p) {
  const bool line = p.reading == PitchReading::linear;
  const double low = line ? p.curve.point[0].x : -p.limit.value();
  const double high = line ? p.curve.point[p.curve.size - 1].x : p.limit.value();
  const double margin = std::max(5.0, 0.2 * (high - low));
  return {std::max(-90.0, low - margin), std::min(90.0, high + margin)};
}

}  // namespace

SurfacePlot::SurfacePlot(Draft& draft, QWidget* parent)
    : Plot(tr("Total membership over altitude and pitch"), Keyboard::ignored, parent),
      draft_(draft),
      surfaceThrottle_(this, [this] { compute(); }),
      liveThrottle_(this, [this] { showLive(); }) {
  setMinimumSize(260, 200);
  makePlottables();
  restyle();
  fitView();
  connect(&draft_, &Draft::activeChanged, this, [this] {
    if (!sameSurface(shown_, *draft_.active())) surfaceThrottle_.request();
  });
  connect(&draft_, &Draft::loaded, this, &SurfacePlot::fitView);
  for (QCPAxis* const axis : {xAxis, yAxis})
    connect(axis, qOverload<const QCPRange&>(&QCPAxis::rangeChanged), this,
            [this] { surfaceThrottle_.request(); });
  connect(this, &QCustomPlot::mouseDoubleClick, this, &SurfacePlot::fitView);
  auto* fit = new QAction(tr("Fit"), this);
  connect(fit, &QAction::triggered, this, &SurfacePlot::fitView);
  auto* clear = new QAction(tr("Clear track"), this);
  connect(clear, &QAction::triggered, this, &SurfacePlot::clearTrack);
  addActions({fit, clear});
  setContextMenuPolicy(Qt::ActionsContextMenu);
}

void SurfacePlot::makePlottables() {
  addOverlays({"live", "hover"});
  xAxis->setLabel(tr("Altitude (ft)"));
  yAxis->setLabel(tr("Pitch (°), nose up positive"));
  xAxis->setNumberFormat(QStringLiteral("f"));
  xAxis->setNumberPrecision(0);
  setInteractions(QCP::iRangeDrag | QCP::iRangeZoom);
  axisRect()->setupFullAxesBox();

  map_ = new QCPColorMap(xAxis, yAxis);
  map_->setTightBoundary(true);
  map_->setGradient(cividis());
  map_->setDataRange({0, BandList::kTop});
  map_->setName(tr("Total"));
  scale_ = addColourScale(cividis());
  scale_->setDataRange({0, BandList::kTop});
  scale_->axis()->setLabel(tr("Total and depth map (px)"));

  const auto curve = [this](const QString& name, const char* layerName, const QColor& ink, double width) {
    auto* made = new QCPCurve(xAxis, yAxis);
    made->setName(name);
    made->setLayer(QString::fromLatin1(layerName));
    made->setPen(QPen(ink, width, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    return made;
  };
  edgesHalo_ = curve(tr("Band edges"), "main", QColor(0, 0, 0, 150), 3);
  edges_ = curve(tr("Band edges"), "main", Qt::white, 1.2);
  trackHalo_ = curve(tr("Track"), "live", Qt::white, 4);
  trackLine_ = curve(tr("Track"), "live", QColor(213, 94, 0), 2);
  live_ = addGraph();
  live_->setLayer(QStringLiteral("live"));
  live_->setLineStyle(QCPGraph::lsNone);
  live_->setScatterStyle(
      QCPScatterStyle(QCPScatterStyle::ssCircle, QPen(Qt::black, 2), QBrush(Qt::white), 11));
  hover_ = new QCPItemText(this);
  hover_->setLayer(QStringLiteral("hover"));
  hover_->position->setType(QCPItemPosition::ptAxisRectRatio);
  hover_->position->setCoords(0.01, 0.01);
  hover_->setPositionAlignment(Qt::AlignLeft | Qt::AlignTop);
  hover_->setPadding(QMargins(4, 2, 4, 2));
  hover_->setVisible(false);
}

void SurfacePlot::restyle() {
  applyTheme(*this);
  applyThemeTo(*scale_);
  hover_->setColor(palette().color(QPalette::ToolTipText));
  hover_->setBrush(palette().color(QPalette::ToolTipBase));
  hover_->setFont(font());
  replot(QCustomPlot::rpQueuedReplot);
}

void SurfacePlot::fitView() {
  xAxis->setRange(altitudeRange(draft_.active()->altitude));
  yAxis->setRange(pitchRange(draft_.active()->pitch));
  surfaceThrottle_.request();
}

void SurfacePlot::compute() {
  const TuningParameters& p = *draft_.active();
  shown_ = p;
  ++computed_;
  const QCPRange x = xAxis->range(), y = yAxis->range();
  QCPColorMapData* const cells = map_->data();
  if (cells->keySize() != kColumns || cells->valueSize() != kRows) cells->setSize(kColumns, kRows);
  cells->setRange(x, y);
  const auto at = [](const QCPRange& range, int i, int count) {
    return range.lower + range.size() * i / (count - 1);
  };
  std::vector<double> altitude(kColumns), totals(static_cast<std::size_t>(kColumns) * kRows);
  for (int c = 0; c < kColumns; ++c)
    altitude[static_cast<std::size_t>(c)] = altitudeMembership(p.altitude, at(x, c, kColumns));
  std::size_t next = 0;
  for (int r = 0; r < kRows; ++r) {
    const double pitch = pitchMembership(p.pitch, at(y, r, kRows));
    for (int c = 0; c < kColumns; ++c) {
      const double total = combine(p.scheme.combination, altitude[static_cast<std::size_t>(c)], pitch);
      cells->setCell(c, r, total);
      totals[next++] = total;
    }
  }
  drawEdges(totals);

  QSharedPointer<QCPAxisTickerText> ticks(new QCPAxisTickerText);
  ticks->addTick(0, QStringLiteral("0"));
  for (const Band& b : p.scheme.bands.span())
    ticks->addTick(b.low, tr("%1: %2 × %3").arg(views::numberText(b.low, 3)).arg(b.widthPx).arg(b.heightPx));
  ticks->addTick(BandList::kTop, views::numberText(BandList::kTop, 0));
  scale_->axis()->setTicker(ticks);
  showLive();
  replot(rpQueuedReplot);
}

void SurfacePlot::drawEdges(const std::vector<double>& totals) {
  const QCPRange x = xAxis->range(), y = yAxis->range();
  QVector<double> t, keys, values;
  const auto add = [&](double key, double value) {
    t << static_cast<double>(t.size());
    keys << key;
    values << value;
  };
  for (const Band& band : shown_.scheme.bands.span())
    for (const auto& [from, to] : contour({kColumns, kRows, totals}, band.low)) {
      for (const ContourPoint& point : {from, to})
        add(x.lower + x.size() * point.x / (kColumns - 1), y.lower + y.size() * point.y / (kRows - 1));
      add(kNan, kNan);
    }
  edges_->setData(t, keys, values, true);
  edgesHalo_->setData(t, keys, values, true);
}

double SurfacePlot::totalAt(double altitudeFt, double pitchDeg) const {
  if (computed_ == 0 || !xAxis->range().contains(altitudeFt) || !yAxis->range().contains(pitchDeg))
    return kNan;
  return combine(shown_.scheme.combination, altitudeMembership(shown_.altitude, altitudeFt),
                 pitchMembership(shown_.pitch, pitchDeg));
}

void SurfacePlot::showFrame(const LiveFrame& frame) {
  const FrameDecision& d = frame.decision;
  if (d.reason == SchemeReason::invalid_input || d.reason == SchemeReason::altitude_unknown) return;
  const CurvePoint now{d.altitudeFt, d.pitchDeg};
  now_ = now;
  const bool moved =
      track_.empty() || std::abs(track_.back().x - now.x) > 15 || std::abs(track_.back().y - now.y) > 0.15;
  if (moved) {
    if (track_.size() == kLongestTrack)
      track_.erase(track_.begin(), track_.begin() + static_cast<std::ptrdiff_t>(kLongestTrack / 4));
    track_.push_back(now);
    trackMoved_ = true;
  }
  liveThrottle_.request();
}

void SurfacePlot::showLive() {
  if (!now_) return;
  if (trackMoved_) {
    trackMoved_ = false;
    QVector<QCPCurveData> points;
    points.reserve(static_cast<qsizetype>(track_.size()));
    for (const CurvePoint& p : track_) points.append({static_cast<double>(points.size()), p.x, p.y});
    for (QCPCurve* curve : {trackHalo_, trackLine_}) curve->data()->set(points, true);
  }
  live_->setData({now_->x}, {now_->y});
  layer(QStringLiteral("live"))->replot();
}

void SurfacePlot::clearTrack() {
  track_.clear();
  trackMoved_ = true;
  if (now_) liveThrottle_.request();
}

void SurfacePlot::mouseMoveEvent(QMouseEvent* event) {
  QCustomPlot::mouseMoveEvent(event);
  const double altitude = xAxis->pixelToCoord(event->position().x());
  const double pitch = yAxis->pixelToCoord(event->position().y());
  const double total = totalAt(altitude, pitch);
  hover_->setVisible(!std::isnan(total));
  if (!std::isnan(total)) {
    const BandList& bands = shown_.scheme.bands;
    const int band = bandOf(bands, total);
    const QString size = band < 0 ? tr("frustum")
                                  : tr("depth map %1 × %2")
                                        .arg(bands.band[static_cast<std::size_t>(band)].widthPx)
                                        .arg(bands.band[static_cast<std::size_t>(band)].heightPx);
    hover_->setText(tr("%1 ft, %2°: total %3, %4")
                        .arg(views::numberText(altitude, 0), views::numberText(pitch, 1),
                             QString::number(total, 'f', 3), size));
  }
  layer(QStringLiteral("hover"))->replot();
}

void SurfacePlot::leaveEvent(QEvent* event) {
  QCustomPlot::leaveEvent(event);
  hover_->setVisible(false);
  layer(QStringLiteral("hover"))->replot();
}

}  // namespace trimtab::views
