// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <qcustomplot.h>

#include "views/model/plot_signals.h"

namespace trimtab::views {

/// Draws one trace against time: the extremes of each screen column, and a few markers of its own shape, so
/// that traces differ by more than their colour.
class TraceGraph : public QCPGraph {
  Q_OBJECT
 public:
  struct Look {
    Trace trace;
    QString name;
    QString unit;
    int colour;
    QCPScatterStyle::ScatterShape shape;
    Qt::PenStyle pen = Qt::SolidLine;
    double scale = 1;
    int decimals = 2;
    bool filled = false;
    bool rare = false;  ///< in the legend only once it was measured

    QString fullName() const { return unit.isEmpty() ? name : QStringLiteral("%1 (%2)").arg(name, unit); }
  };

  TraceGraph(QCPAxis* timeAxis, QCPAxis* valueAxis, Look look);
  const Look& look() const { return look_; }
  /// Returns the signal whose values a person reads. For a stacked area, whose graph is its upper edge, this
  /// is the stage.
  const PlotSignal& signal() const;
  void colour(const QPalette& palette);
  struct Heights {
    double largest = 0;
    double usual = 0;  ///< one screen column in twenty reaches higher, of few columns up to two
    double least = 0;  ///< 0 where nothing is below
  };
  /// Takes the frames from `from` up to `to`, with markers at multiples of `markerStepS` within the view.
  Heights take(const TraceBuffer& buffer, std::uint64_t from, std::uint64_t to, std::size_t columns,
               double markerStepS);

 protected:
  void draw(QCPPainter* painter) override;
  void drawLegendIcon(QCPPainter* painter, const QRectF& rect) const override;

 private:
  Look look_;
  QCPScatterStyle marker_;
  QVector<QPointF> markers_;  ///< time, value
  std::vector<TraceBuffer::Column> columns_;
  QVector<QCPGraphData> points_;
  std::vector<double> highs_;
};

}  // namespace trimtab::views
