// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot.h"

#include <algorithm>
#include <cmath>

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr int kUnboundedPx = 100000;
constexpr int kDescenderPx = 2, kLegendEntryMarginPx = 8, kColourScalePx = 12;

}  // namespace

Plot::Plot(const QString& accessibleName, Keyboard keyboard, QWidget* parent) : QCustomPlot(parent) {
  // QCustomPlot keeps every event of the mouse; what the wheel scrolls is around the plot.
  setAttribute(Qt::WA_NoMousePropagation, false);
  setAccessibleName(accessibleName);
  setFocusPolicy(keyboard == Keyboard::used ? Qt::StrongFocus : Qt::ClickFocus);
  setMouseTracking(true);
}

void Plot::keyPressEvent(QKeyEvent* event) {
  const bool in = event->key() == Qt::Key_Plus || event->key() == Qt::Key_Equal;
  if ((in || event->key() == Qt::Key_Minus) && zoomByKey(in ? 0.8 : 1.25)) return;
  QCustomPlot::keyPressEvent(event);
}

void Plot::wheelEvent(QWheelEvent* event) {
  if (!(event->modifiers() & Qt::ControlModifier)) return event->ignore();
  zoomByWheel(event);
  event->accept();
}

bool Plot::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride && focusPolicy() == Qt::StrongFocus) {
    const auto& key = *static_cast<QKeyEvent*>(event);
    if (key.key() == Qt::Key_Home && key.modifiers() == Qt::NoModifier) {
      event->accept();
      return true;
    }
  }
  return QCustomPlot::event(event);
}

void Plot::resizeEvent(QResizeEvent* event) {
  QCustomPlot::resizeEvent(event);
  resized();
}

void Plot::changeEvent(QEvent* event) {
  QCustomPlot::changeEvent(event);
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange) restyle();
}

void Plot::paintEvent(QPaintEvent* event) {
  QCustomPlot::paintEvent(event);
  if (focusPolicy() == Qt::StrongFocus) paintFocusFrame(*this);
}

double Plot::wheelFactor(const QWheelEvent& event) {
  return std::pow(kWheelZoom, event.angleDelta().y() / 120.0);
}

void Plot::addOverlays(std::initializer_list<const char*> names) {
  for (const char* name : names) {
    addLayer(QString::fromLatin1(name), nullptr, QCustomPlot::limAbove);
    layer(QString::fromLatin1(name))->setMode(QCPLayer::lmBuffered);
  }
}

QCPLegend* Plot::makeLegend() {
  auto* above = new QCPLegend;
  above->setFillOrder(QCPLegend::foColumnsFirst);
  above->setMargins(QMargins(4, 2, 4, 0));
  above->setRowSpacing(0);
  above->setColumnSpacing(6);
  above->setIconSize(16, 12);
  // Without a maximum of its own, an empty legend would limit the width of the whole column.
  above->setMaximumSize(kUnboundedPx, kUnboundedPx);
  return above;
}

void Plot::addLegendAbove() {
  legend = makeLegend();
  plotLayout()->insertRow(0);
  plotLayout()->addElement(0, 0, legend);
  plotLayout()->setRowStretchFactor(0, 0.001);
  setAutoAddPlottableToLegend(false);
}

void Plot::arrangeLegendAbove() {
  wrapLegend(*legend, width(), legend->itemCount() > 3 ? 2 : 1);
  replot(rpQueuedReplot);
}

void Plot::wrapLegend(QCPLegend& entries, int widthPx, int least) const {
  entries.setVisible(entries.itemCount() > 0);
  const QFontMetrics metrics(font());
  int widest = 0;
  // Places of the grid may be empty, also before the last entry.
  for (int i = 0; i < entries.elementCount(); ++i)
    if (auto* item = qobject_cast<QCPPlottableLegendItem*>(entries.elementAt(i))) {
      widest = std::max(widest, metrics.horizontalAdvance(item->plottable()->name()));
      // QCustomPlot clips an entry to its height, in which letters with descenders do not always fit.
      item->setMargins(QMargins(0, 0, 0, kDescenderPx));
    }
  const int entry = widest + entries.iconSize().width() + entries.iconTextPadding() +
                    entries.columnSpacing() + kLegendEntryMarginPx;
  const int wrap = std::max(least, widthPx / entry);
  if (wrap == entries.wrap()) return;
  entries.setWrap(wrap);
  // Only this places the entries that are there already anew.
  entries.setFillOrder(entries.fillOrder(), true);
}

void Plot::applyThemeWithLegendAbove() {
  applyTheme(*this);
  legend->setBorderPen(Qt::NoPen);
  legend->setBrush(Qt::NoBrush);
}

QCPColorScale* Plot::addColourScale(const QCPColorGradient& gradient) {
  auto* scale = new QCPColorScale(this);
  scale->setGradient(gradient);
  scale->setBarWidth(kColourScalePx);
  scale->setRangeDrag(false);
  scale->setRangeZoom(false);
  plotLayout()->addElement(0, 1, scale);
  auto* margins = new QCPMarginGroup(this);
  axisRect()->setMarginGroup(QCP::msTop | QCP::msBottom, margins);
  scale->setMarginGroup(QCP::msTop | QCP::msBottom, margins);
  return scale;
}

void Plot::applyThemeTo(QCPColorScale& scale) const {
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::Text);
  QCPAxis& axis = *scale.axis();
  axis.setTickPen(blend(base, ink, 0.55));
  axis.setSubTickPen(blend(base, ink, 0.55));
  axis.setLabelColor(ink);
  axis.setTickLabelColor(ink);
  axis.setTickLabelFont(font());
  axis.setLabelFont(font());
}

QCPItemText* Plot::addReadout(const char* layerName, const QMargins& padding) {
  auto* text = new QCPItemText(this);
  text->setLayer(QString::fromLatin1(layerName));
  text->setClipToAxisRect(false);
  text->position->setType(QCPItemPosition::ptAbsolute);
  text->setPadding(padding);
  text->setTextAlignment(Qt::AlignLeft);
  text->setVisible(false);
  return text;
}

void Plot::placeReadout(QCPItemText& readout, const QString& text, QPointF beside) const {
  const QColor base = palette().color(QPalette::Base), ink = palette().color(QPalette::Text);
  readout.setText(text);
  readout.setFont(font());
  readout.setColor(ink);
  readout.setBrush(base);
  readout.setPen(QPen(blend(base, ink, 0.4)));
  const QSize size =
      QFontMetrics(font()).boundingRect(QRect(0, 0, 4000, 4000), Qt::AlignLeft, text).size() + QSize(14, 10);
  QPointF corner(beside.x() + 12, beside.y() - size.height() - 6);
  if (corner.x() + size.width() > width()) corner.setX(beside.x() - 12 - size.width());
  corner.setX(std::clamp(corner.x(), 2.0, std::max(2.0, double(width() - size.width() - 2))));
  corner.setY(std::clamp(corner.y(), 2.0, std::max(2.0, double(height() - size.height() - 2))));
  readout.setPositionAlignment(Qt::AlignLeft | Qt::AlignTop);
  readout.position->setCoords(corner);
}

QCPItemStraightLine* Plot::addLine(const char* layerName, QCPAxisRect* rect) {
  auto* line = new QCPItemStraightLine(this);
  line->setLayer(QString::fromLatin1(layerName));
  line->setClipAxisRect(rect);
  for (QCPItemPosition* point : {line->point1, line->point2})
    point->setAxes(rect->axis(QCPAxis::atBottom), rect->axis(QCPAxis::atLeft));
  return line;
}

void Plot::putVertical(QCPItemStraightLine& line, double key) {
  line.point1->setCoords(key, 0);
  line.point2->setCoords(key, 1);
}

void Plot::putHorizontal(QCPItemStraightLine& line, double value) {
  line.point1->setCoords(0, value);
  line.point2->setCoords(1, value);
}

}  // namespace trimtab::views
