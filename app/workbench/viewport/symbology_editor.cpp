// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbology_editor.h"

#include <QKeyEvent>
#include <QPainter>
#include <algorithm>
#include <cmath>
#include <string>

#include "views/panels/symbology_panel.h"

namespace trimtab::workbench {
namespace {

constexpr double kBoxMargin = 6, kHandle = 8;  ///< of a box round its symbol; of a corner's square
constexpr int kBoxes = static_cast<int>(kSymbols);
static_assert(views::SymbologyPanel::kSymbols == kBoxes);

std::string keyOf(int symbol, const char* field) {
  return std::string(views::SymbologyPanel::kPrefixes[static_cast<std::size_t>(symbol)]) + field;
}

QString labelOf(int symbol) {
  const std::string_view label = findRow(keyOf(symbol, ".show"))->label;
  return QString::fromUtf8(label.data(), static_cast<qsizetype>(label.size()));
}

/// As many digits as the row shows: a pixel of a wide screen.
double rounded(double value) {
  return std::clamp(std::round(value * 1000) / 1000, -1.0, 1.0) + 0.0;
}

std::array<QPointF, 4> cornersOf(const QRectF& box) {
  return {box.topLeft(), box.topRight(), box.bottomRight(), box.bottomLeft()};
}

}  // namespace

SymbologyEditor::SymbologyEditor(views::Draft& draft) : draft_(draft) {}

void SymbologyEditor::setActive(bool on) {
  active_ = on;
  drag_.reset();
  if (!on) select(-1);
  emit changed();
}

void SymbologyEditor::setImage(const std::optional<SymbologyRequest>& symbols, const ViewShape& view,
                               const QRectF& place) {
  view_ = view;
  place_ = place;
  if (symbols)
    scene::drawSymbology(scene::quantised(*symbols, view), view, drawing_);
  else
    drawing_.box.fill({});
}

void SymbologyEditor::select(int symbol) {
  if (symbol == selected_) return;
  selected_ = symbol;
  emit selectionChanged(symbol);
  emit changed();
}

QRectF SymbologyEditor::boxOf(int symbol) const {
  const scene::SymbolBox& box = drawing_.box[static_cast<std::size_t>(symbol)];
  if (box.empty()) return {};
  const double x = place_.width() / view_.widthPx, y = place_.height() / view_.heightPx;
  const QPointF topLeft(place_.left() + double{box.left} * x, place_.bottom() - double{box.top} * y);
  const QPointF bottomRight(place_.left() + double{box.right} * x, place_.bottom() - double{box.bottom} * y);
  return QRectF(topLeft, bottomRight)
      .adjusted(-kBoxMargin, -kBoxMargin, kBoxMargin, kBoxMargin)
      .intersected(place_);
}

bool SymbologyEditor::atCorner(QPointF at, int symbol) const {
  const QRectF box = boxOf(symbol);
  if (box.isEmpty()) return false;
  return std::ranges::any_of(cornersOf(box), [at](QPointF corner) {
    return std::max(std::abs(corner.x() - at.x()), std::abs(corner.y() - at.y())) <= kHandle;
  });
}

/// Prefers the corners of the chosen symbol, then the smallest box, because a ladder lies under all others.
int SymbologyEditor::symbolAt(QPointF at) const {
  if (selected_ >= 0 && atCorner(at, selected_)) return selected_;
  int best = -1;
  double least = 0;
  for (int i = 0; i < kBoxes; ++i) {
    const QRectF box = boxOf(i);
    const double area = box.width() * box.height();
    if (box.contains(at) && (best < 0 || area < least)) best = i, least = area;
  }
  return best;
}

double SymbologyEditor::valueOf(int symbol, const char* field) const {
  return std::get<double>(draft_.value(keyOf(symbol, field)));
}

bool SymbologyEditor::press(QPointF at) {
  if (!active_) return false;
  const int symbol = symbolAt(at);
  const bool resizes = symbol >= 0 && symbol == selected_ && atCorner(at, symbol);
  select(symbol);
  if (symbol >= 0)
    drag_ = Drag{symbol,
                 resizes,
                 at,
                 valueOf(symbol, ".x"),
                 valueOf(symbol, ".y"),
                 valueOf(symbol, ".size"),
                 boxOf(symbol).center(),
                 draft_.newToken()};
  return true;
}

bool SymbologyEditor::moveTo(QPointF at) {
  if (!active_) return false;
  if (!drag_) return true;
  const Drag& d = *drag_;
  if (!d.resizes) {
    place(d.symbol, d.x + 2 * (at.x() - d.from.x()) / place_.width(),
          d.y - 2 * (at.y() - d.from.y()) / place_.height(), d.token);
    return true;
  }
  const QPointF before = d.from - d.middle, now = at - d.middle;
  const double length = std::hypot(before.x(), before.y());
  if (!(length > 1)) return true;
  const ParameterRow* row = findRow(keyOf(d.symbol, ".size"));
  const double size = d.size * std::hypot(now.x(), now.y()) / length;
  const views::Draft::KeyValue value{
      row->key, std::clamp(std::round(size * 100) / 100, row->usual.low, row->usual.high)};
  draft_.setValues({&value, 1}, tr("Resize %1").arg(labelOf(d.symbol)), d.token);
  return true;
}

bool SymbologyEditor::release() {
  if (!active_) return false;
  drag_.reset();
  return true;
}

void SymbologyEditor::place(int symbol, double x, double y, views::MergeToken token) {
  const views::Draft::KeyValue values[] = {{findRow(keyOf(symbol, ".x"))->key, rounded(x)},
                                           {findRow(keyOf(symbol, ".y"))->key, rounded(y)}};
  draft_.setValues(values, tr("Move %1").arg(labelOf(symbol)), token);
}

bool SymbologyEditor::key(const QKeyEvent& event) {
  if (!active_) return false;
  if (event.key() == Qt::Key_Escape) {
    emit ended();
    return true;
  }
  if (selected_ < 0) return false;
  QPointF by;
  switch (event.key()) {
    case Qt::Key_Left:
      by.setX(-1);
      break;
    case Qt::Key_Right:
      by.setX(1);
      break;
    case Qt::Key_Up:
      by.setY(1);
      break;
    case Qt::Key_Down:
      by.setY(-1);
      break;
    default:
      return false;
  }
  if (!event.isAutoRepeat() || keyToken_ == 0) keyToken_ = draft_.newToken();
  // The step is one of the image's pixels, but never one that rounds to nothing.
  const double steps = event.modifiers() & Qt::ShiftModifier ? 10 : 1;
  const double dx = steps * std::max(2.0 / std::max(1, view_.widthPx), 0.001);
  const double dy = steps * std::max(2.0 / std::max(1, view_.heightPx), 0.001);
  place(selected_, valueOf(selected_, ".x") + by.x() * dx, valueOf(selected_, ".y") + by.y() * dy, keyToken_);
  return true;
}

Qt::CursorShape SymbologyEditor::cursor(QPointF at) const {
  if (drag_) return drag_->resizes ? Qt::SizeFDiagCursor : Qt::ClosedHandCursor;
  const int symbol = symbolAt(at);
  if (symbol >= 0 && symbol == selected_ && atCorner(at, symbol)) return Qt::SizeFDiagCursor;
  return symbol >= 0 ? Qt::OpenHandCursor : Qt::ArrowCursor;
}

void SymbologyEditor::paint(QPainter& painter) const {
  if (!active_) return;
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  for (int i = 0; i < kBoxes; ++i) {
    const QRectF box = boxOf(i);
    if (box.isEmpty()) continue;
    const bool chosen = i == selected_;
    // Black below white is seen on any ground.
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(QColor(0, 0, 0, 180), chosen ? 4 : 3));
    painter.drawRect(box);
    painter.setPen(QPen(chosen ? QColor(255, 200, 60) : QColor(255, 255, 255, 200), chosen ? 2 : 1,
                        chosen ? Qt::SolidLine : Qt::DashLine));
    painter.drawRect(box);
    if (!chosen) continue;
    painter.setBrush(QColor(255, 200, 60));
    painter.setPen(QPen(Qt::black, 1));
    for (const QPointF corner : cornersOf(box))
      painter.drawRect(QRectF(corner.x() - kHandle / 2, corner.y() - kHandle / 2, kHandle, kHandle));
    const QString said = QStringLiteral("%1  %2, %3  × %4")
                             .arg(labelOf(i))
                             .arg(valueOf(i, ".x"), 0, 'f', 3)
                             .arg(valueOf(i, ".y"), 0, 'f', 3)
                             .arg(valueOf(i, ".size"), 0, 'f', 2);
    const QRectF text = painter.fontMetrics().boundingRect(said).toRectF();
    QRectF label(box.left(), box.top() - text.height() - 8, text.width() + 12, text.height() + 6);
    if (label.top() < place_.top()) label.moveTop(box.bottom() + 2);
    painter.fillRect(label, QColor(0, 0, 0, 190));
    painter.setPen(Qt::white);
    painter.drawText(label, Qt::AlignCenter, said);
  }
  painter.restore();
}

}  // namespace trimtab::workbench
