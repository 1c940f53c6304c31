// SPDX-License-Identifier: GPL-3.0-or-later
#include "band_scale.h"

#include <cmath>
#include <limits>

#include "views/model/keys.h"
#include "views/model/rounded.h"
#include "views/model/theme.h"

namespace trimtab::views {

BandScale::BandScale(Draft& draft, QWidget* parent)
    : PointPlot(tr("Depth-map bands by total membership"), draft, key::kBands, parent),
      live_(addGraph()),
      throttle_(this, [this] { redraw(); }) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setInteractions(QCP::iNone);
  behind().leaveNamesOut();
  live_->setLineStyle(QCPGraph::lsNone);
  live_->setLayer(QStringLiteral("live"));
  liveText()->setPen(Qt::NoPen);
  yAxis->setRange(0, 1);
  for (QCPAxis* axis : {yAxis, yAxis2, xAxis2}) {
    axis->setTicks(false);
    axis->setTickLabels(false);
  }
  xAxis->setSubTicks(false);
  xAxis->grid()->setVisible(false);
  yAxis->grid()->setVisible(false);
  fitView();
  restyle();
  connect(&draft, &Draft::valueChanged, this, [this](const QString& changed) {
    const int last = static_cast<int>(bands().size) - 1;
    if (changed.toStdString() == key::kBands && selected() > last) return select(last);
    if (changed.toStdString() == key::kBands || changed.toStdString() == key::kHysteresis) redraw();
  });
  connect(&draft, &Draft::findingsChanged, this, &BandScale::redraw);
  connect(&draft, &Draft::referencesChanged, this, &BandScale::redraw);
}

QSize BandScale::sizeHint() const {
  return {360, fontMetrics().height() * 5 + 22};
}

std::vector<EditPoint> BandScale::points() const {
  std::vector<EditPoint> edges;
  for (const Band& band : bands().span()) edges.push_back({band.low, 0.5, true, false, false, {}});
  return edges;
}

int BandScale::bandAt(double total) const {
  const BandList list = bands();
  int band = -1;
  while (band + 1 < static_cast<int>(list.size) && list.band[static_cast<std::size_t>(band + 1)].low <= total)
    ++band;
  return band;
}

void BandScale::showFrame(const LiveFrame& frame) {
  if (total_ == frame.decision.totalMembership && liveBand_ == frame.decision.band) return;
  total_ = frame.decision.totalMembership;
  liveBand_ = frame.decision.band;
  throttle_.request();
}

void BandScale::moveHeld(const std::vector<std::size_t>& moved, QPointF by, MergeToken token) {
  commit(withEdgesMoved(std::get<BandList>(held()), moved, by.x()), token);
}

void BandScale::insertAt(double low, double) {
  const std::optional<InsertedBand> inserted = withBand(bands(), low);
  if (!inserted)
    return emit refused(tr("There is no room for another band here (at most %1).").arg(BandList::kCapacity));
  commit(inserted->bands, 0);
  select(static_cast<int>(inserted->index));
}

void BandScale::insertBesideSelected() {
  const BandList list = bands();
  if (list.size == 0) return addBand(1);
  const auto at = selected() < 0 ? list.size - 1 : static_cast<std::size_t>(selected());
  addBand(roundedTo((list.band[at].low + highOf(list, at)) / 2, kEdgeGap));
}

bool BandScale::removePoints(const std::vector<std::size_t>& gone) {
  const std::optional<BandList> left = withoutBands(bands(), gone);
  left ? commit(*left, 0) : emit refused(tr("One band stays."));
  return left.has_value();
}

void BandScale::selectElsewhere(QPointF pixel, bool) {
  select(bandAt(xAxis->pixelToCoord(pixel.x())));
}

double BandScale::distance(const EditPoint& point, QPointF pixel) const {
  if (!axisRect()->rect().adjusted(-10, -6, 10, 6).contains(pixel.toPoint()))
    return std::numeric_limits<double>::infinity();
  return std::abs(pixelOf(point.x).x() - pixel.x());
}

void BandScale::keyPressEvent(QKeyEvent* event) {
  const double step = event->modifiers() & Qt::ShiftModifier ? 10 * kEdgeGap : kEdgeGap;
  if (event->key() == Qt::Key_Down) return nudge(-step, 0);
  if (event->key() == Qt::Key_Up) return nudge(step, 0);
  PointPlot::keyPressEvent(event);
}

QString BandScale::describe() const {
  return tr(
      "Tab selects a band edge, arrow keys move it (Shift: ten times as far), Insert splits a band, "
      "Delete removes one.");
}

QString BandScale::readoutOf(double total, int) const {
  const int band = bandAt(total);
  const BandList list = bands();
  QString text = band < 0 ? tr("Total membership %1: view-frustum culling alone").arg(numberText(total, 2))
                          : tr("Total membership %1: depth map %2 × %3 px")
                                .arg(numberText(total, 2))
                                .arg(list.band[static_cast<std::size_t>(band)].widthPx)
                                .arg(list.band[static_cast<std::size_t>(band)].heightPx);
  for (const Reference which : kGhosts) {
    if (!draft().isChanged(key(), which)) continue;
    QStringList edges;
    const ParameterValue ghost = findRow(key())->get(*draft().reference(which));
    for (const Band& each : std::get<BandList>(ghost).span()) edges << numberText(each.low, 3);
    text +=
        QLatin1Char('\n') + (which == Reference::pinned ? tr("Dash-dotted, %1: %2") : tr("Dotted, %1: %2"))
                                .arg(ghostName(which, draft()), edges.join(QStringLiteral(", ")));
  }
  return text;
}

/// A readout within the scale would hide it.
void BandScale::say(const std::optional<QPointF>& at) {
  if (at) setToolTip(readoutOf(std::clamp(xAxis->pixelToCoord(at->x()), 0.0, BandList::kTop), -1));
}

template <class Item>
Item& BandScale::add(const char* layerName) {
  auto* item = new Item(this);
  item->setLayer(QString::fromLatin1(layerName));
  drawn_ << item;
  return *item;
}

void BandScale::fill(double low, double high, double height, const QBrush& brush) {
  auto& rect = add<QCPItemRect>("background");
  rect.topLeft->setCoords(low, height);
  rect.bottomRight->setCoords(high, 0);
  rect.setPen(Qt::NoPen);
  rect.setBrush(brush);
}

void BandScale::restyle() {
  applyTheme(*this);
  const double line = fontMetrics().height();
  axisRect()->setAutoMargins(QCP::msNone);
  axisRect()->setMargins(QMargins(10, int(line) + 10, 10, int(1.4 * line) + 12));
  live_->setScatterStyle(
      {QCPScatterStyle::ssTriangleInverted, QPen(liveColour(palette())), QBrush(liveColour(palette())), 12});
  PointPlot::restyle();
  liveText()->setColor(palette().color(QPalette::WindowText));
  liveText()->setPen(Qt::NoPen);
  liveText()->setBrush(Qt::NoBrush);
}

void BandScale::redraw() {
  for (QCPAbstractItem* item : drawn_) removeItem(item);
  drawn_.clear();
  drawBands();
  drawEdges();
  drawGhosts();
  drawLive();
  showPoints(palette().color(QPalette::Text));
}

void BandScale::drawBands() {
  const BandList list = bands();
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::Text);
  const QColor band = seriesColour(0, palette());
  for (int i = -1; i < static_cast<int>(list.size); ++i) {
    const auto at = static_cast<std::size_t>(std::max(i, 0));
    const double low = i < 0 ? 0 : list.band[at].low;
    const double high = i >= 0 ? highOf(list, at) : list.size > 0 ? list.band[0].low : BandList::kTop;
    const bool live = total_ && i == liveBand_;
    const double depth = list.size > 0 ? 0.10 + 0.30 * (i + 1) / static_cast<double>(list.size) : 0.1;
    fill(low, high, 1, i < 0 ? blend(base, ink, 0.06) : blend(base, band, depth));
    if (live) fill(low, high, 0.1, liveColour(palette()));
    QFont font = this->font();
    font.setBold(live);
    auto& text = add<QCPItemText>("grid");
    text.setText(i < 0 ? tr("frustum")
                       : QStringLiteral("%1×%2").arg(list.band[at].widthPx).arg(list.band[at].heightPx));
    text.position->setCoords((low + high) / 2, 0.5);
    text.setColor(ink);
    const double width = pixelOf(high).x() - pixelOf(low).x();
    if (const QFontMetrics metrics(font); metrics.horizontalAdvance(text.text()) >= width - 4) {
      // The text of a narrow cell runs upward.
      text.setRotation(-90);
      text.setVisible(metrics.height() < width);
      font.setPointSizeF(font.pointSizeF() * 0.75);
    }
    text.setFont(font);
  }
}

void BandScale::drawEdges() {
  const BandList list = bands();
  const QColor ink = palette().color(QPalette::Text);
  const double hysteresis = std::get<double>(draft().value(key::kHysteresis));
  const bool broken = isAtFault() || (draft().isBroken() && !draft().findingsOf(key::kHysteresis).empty());
  const QColor edge = broken ? errorColour(palette()) : ink;
  QColor zone = edge;
  zone.setAlpha(70);
  const QSharedPointer<QCPAxisTickerText> labels(new QCPAxisTickerText);
  double lastEnd = -1e9;
  const auto label = [&](double value) {
    const QString text = numberText(value, 3);
    const double half = fontMetrics().horizontalAdvance(text) / 2.0, x = pixelOf(value).x();
    if (x - half < lastEnd + 4) return;
    lastEnd = x + half;
    labels->addTick(value, text);
  };
  label(0);
  for (std::size_t i = 0; i < list.size; ++i) {
    const double low = list.band[i].low;
    if (hysteresis > 0)
      fill(std::max(0.0, low - hysteresis), std::min(BandList::kTop, low + hysteresis), 1,
           QBrush(zone, Qt::BDiagPattern));
    auto& line = add<QCPItemStraightLine>("grid");
    putVertical(line, low);
    line.setPen(QPen(edge, static_cast<int>(i) == selected() ? 3 : 1.6));
    label(low);
  }
  label(BandList::kTop);
  xAxis->setTicker(labels);
}

/// Draws the edges of the file and of a pinned snapshot, if the draft has others.
void BandScale::drawGhosts() {
  for (const Reference which : kGhosts) {
    QVector<Ghosts::Line> edges;
    if (draft().isChanged(key(), which)) {
      const ParameterValue list = findRow(key())->get(*draft().reference(which));
      for (const Band& band : std::get<BandList>(list).span())
        edges << Ghosts::Line{{band.low, 0.0}, {band.low, 1.0}};
    }
    behind().show(which, edges);
  }
}

void BandScale::drawLive() {
  const bool shown = total_ && std::isfinite(*total_);
  liveText()->setVisible(shown);
  live_->data()->clear();
  if (!shown) return;
  const double at = std::clamp(*total_, 0.0, BandList::kTop);
  auto& line = add<QCPItemStraightLine>("live");
  putVertical(line, at);
  line.setPen(QPen(liveColour(palette()), 2));
  live_->addData(at, 0.95);
  liveText()->setText(tr("total %1").arg(numberText(*total_, 3)));
  const double half = fontMetrics().horizontalAdvance(liveText()->text()) / 2.0 + 4;
  liveText()->setPositionAlignment(Qt::AlignHCenter | Qt::AlignBottom);
  liveText()->position->setCoords(std::clamp(pixelOf(at).x(), half, std::max(half, width() - half)),
                                  axisRect()->top() - 2);
}

}  // namespace trimtab::views
