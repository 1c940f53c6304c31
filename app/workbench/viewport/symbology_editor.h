// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QPointF>
#include <QRectF>
#include <array>
#include <optional>

#include "trimtab/scene/symbology_geometry.h"
#include "views/model/draft.h"

class QKeyEvent;
class QPainter;

namespace trimtab::workbench {

/// Lets a person place symbols in the image with mouse and keys. A drag is one undo step, and so is a key
/// that is held down. Positions are in the widget's coordinates.
class SymbologyEditor : public QObject {
  Q_OBJECT
 public:
  explicit SymbologyEditor(views::Draft& draft);

  void setActive(bool on);
  bool active() const { return active_; }
  /// Sets which symbols are on the display and where. Without symbols nothing can be dragged.
  void setImage(const std::optional<SymbologyRequest>& symbols, const ViewShape& view, const QRectF& place);
  void select(int symbol);
  int selected() const { return selected_; }
  /// Returns the box round a symbol; empty if no part of it is in the image.
  QRectF boxOf(int symbol) const;

  /// These return true if the event was meant for a symbol.
  bool press(QPointF at);
  bool moveTo(QPointF at);
  bool release();
  bool key(const QKeyEvent& event);
  Qt::CursorShape cursor(QPointF at) const;
  void paint(QPainter& painter) const;

 signals:
  void changed();  ///< the viewport must paint again
  void selectionChanged(int symbol);
  void ended();  ///< the person pressed Esc

 private:
  struct Drag {
    int symbol = 0;
    bool resizes = false;
    QPointF from;
    double x = 0, y = 0, size = 1;  ///< of the symbol when the drag began
    QPointF middle;
    views::MergeToken token = 0;
  };
  int symbolAt(QPointF at) const;
  bool atCorner(QPointF at, int symbol) const;
  void place(int symbol, double x, double y, views::MergeToken token);
  double valueOf(int symbol, const char* field) const;

  views::Draft& draft_;
  bool active_ = false;
  int selected_ = -1;
  std::optional<Drag> drag_;
  views::MergeToken keyToken_ = 0;
  scene::SymbologyDrawing drawing_;
  ViewShape view_;
  QRectF place_;
};

}  // namespace trimtab::workbench
