// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "band_edit.h"
#include "edit_hand.h"
#include "views/model/draft.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

namespace trimtab::views {

/// The scale of the total membership, 0 to 2, with its bands. Edges are dragged or moved by keys; the
/// hysteresis is shaded on both sides of each edge, and the live total is marked.
class BandScale : public QWidget {
  Q_OBJECT
 public:
  explicit BandScale(Draft& draft, QWidget* parent = nullptr);

  void showFrame(const LiveFrame& frame);
  int selected() const { return hand_.selected(); }
  void select(int index);
  void addBand(double low);
  /// Adds a band in the middle of the selected one.
  void addBandInSelected();
  void removeSelected();
  /// Returns where a total lies, in this widget's coordinates.
  QPointF pixelOf(double total) const;

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;

 signals:
  void selectedChanged(int index);
  void refused(const QString& why);
  void typingAsked();  ///< the person wants to type the selected band's values

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  bool focusNextPrevChild(bool next) override;
  void focusInEvent(QFocusEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;

 private:
  BandList bands() const;
  void commit(const BandList& bands, MergeToken token);
  QRectF track() const;
  double totalAt(double x) const;
  int edgeAt(QPointF pixel) const;
  int bandAt(double total) const;
  void paintBands(QPainter& painter);
  void paintGhosts(QPainter& painter);
  QString ghostsText() const;
  void paintEdges(QPainter& painter);
  void paintLive(QPainter& painter);

  Draft& draft_;
  EditHand hand_;
  BandList dragStart_;
  std::optional<double> total_;
  int liveBand_ = -1;
  Throttle throttle_;
};

}  // namespace trimtab::views
