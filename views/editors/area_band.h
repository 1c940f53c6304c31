// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QMouseEvent>
#include <QRubberBand>
#include <optional>

namespace trimtab::views {

/// A rectangle that the mouse draws over empty space to select what lies in it.
class AreaBand : public QRubberBand {
 public:
  explicit AreaBand(QWidget* parent) : QRubberBand(Rectangle, parent) {}

  bool drawn() const { return !isHidden(); }
  void begin(const QMouseEvent& press) {
    from_ = press.position().toPoint();
    setGeometry(QRect(from_, QSize()));
    show();
  }
  void drawTo(const QMouseEvent& move) { setGeometry(QRect(from_, move.position().toPoint()).normalized()); }
  /// Ends the rectangle and returns it in the parent's coordinates; nothing if it was no more than a click.
  std::optional<QRect> end() {
    hide();
    constexpr int kClickPx = 2;
    if (width() <= kClickPx && height() <= kClickPx) return std::nullopt;
    return geometry();
  }

 private:
  QPoint from_;
};

}  // namespace trimtab::views
