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

/// Places symbols with mouse and keys in the picture. One undo step a drag, or a key held down. Positions are
/// the widget's.
class SymbologyEditor : public QObject {
  Q_OBJECT
 public:
  explicit SymbologyEditor(views::Draft& draft);

  void setActive(bool on);
  bool active() const { return active_; }
  /// What is on the display and where. Without symbols there is nothing to take hold of.
  void setPicture(const std::optional<SymbologyRequest>& symbols, const ViewShape& view, const QRectF& place);
  void select(int symbol);
  int selected() const { return selected_; }
  /// Empty where nothing of it is in the picture.
  QRectF boxOf(int symbol) const;

  /// True when the event was for a symbol.
  bool press(QPointF at);
  bool moveTo(QPointF at);
  bool release();
  bool key(const QKeyEvent& event);
  Qt::CursorShape cursor(QPointF at) const;
  void paint(QPainter& painter) const;

 signals:
  void changed();  ///< paint again
  void selectionChanged(int symbol);
  void ended();  ///< by Esc

 private:
  struct Drag {
    int symbol = 0;
    bool resizes = false;
    QPointF from;
    double x = 0, y = 0, size = 1;  ///< when it began
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
