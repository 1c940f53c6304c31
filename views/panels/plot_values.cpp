// SPDX-License-Identifier: GPL-3.0-or-later
#include "plot_values.h"

#include <QHeaderView>
#include <cmath>

#include "trimtab/units/not_finite.h"
#include "views/model/theme.h"
#include "views/plots/time_plot.h"

namespace trimtab::views {
namespace {

QString textOf(double value, int decimals) {
  return std::isfinite(value) ? numberText(value, decimals) : QStringLiteral("–");
}

}  // namespace

PlotValues::PlotValues(const TraceBuffer& buffer, const TimePlot& plot, QWidget* parent)
    : QTableWidget(parent), buffer_(buffer), plot_(plot) {
  setAccessibleName(tr("Values at the cursors and over the shown range"));
  setColumnCount(kColumns);
  setHorizontalHeaderLabels({tr("Signal"), QStringLiteral("A"), QStringLiteral("B"), QStringLiteral("B − A"),
                             tr("Min"), tr("Median"), tr("p95"), tr("Max")});
  horizontalHeaderItem(kP95)->setToolTip(tr("95 of 100 shown frames are not above this"));
  verticalHeader()->hide();
  verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 4);
  horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  horizontalHeader()->setStretchLastSection(true);
  setEditTriggers(NoEditTriggers);
  setTabKeyNavigation(false);
  connect(&plot_, &TimePlot::lanesChanged, this, &PlotValues::remake);
  remake();
}

void PlotValues::put(int row, int column, const QString& text) {
  QTableWidgetItem* cell = item(row, column);
  if (!cell) {
    setItem(row, column, cell = new QTableWidgetItem);
    if (column > kSignal) cell->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
  }
  cell->setText(text);
}

void PlotValues::remake() {
  setRowCount(static_cast<int>(plot_.traces().size()) + 1);
  put(0, kSignal, tr("time (s)"));
  int row = 1;
  for (const TraceGraph* trace : plot_.traces()) {
    put(row, kSignal, trace->signal().fullName());
    setRowHidden(row++, false);
  }
  fillCursors();
  fillStatistics();
}

void PlotValues::fillCursors() {
  const bool on = plot_.hasCursors();
  for (const int column : {kA, kB, kDifference}) setColumnHidden(column, !on);
  if (!on) return;
  const auto a = plot_.frameAt(plot_.cursor(0)), b = plot_.frameAt(plot_.cursor(1));
  const auto line = [&](int row, double at, double bt, int decimals) {
    put(row, kA, textOf(at, decimals));
    put(row, kB, textOf(bt, decimals));
    put(row, kDifference, textOf(bt - at, decimals));
  };
  line(0, a ? buffer_.time(*a) : plot_.cursor(0), b ? buffer_.time(*b) : plot_.cursor(1), 3);
  int row = 1;
  for (const TraceGraph* trace : plot_.traces()) {
    const PlotSignal& signal = trace->signal();
    line(row++, a ? shownValue(buffer_, signal, *a) : kNan, b ? shownValue(buffer_, signal, *b) : kNan,
         signal.decimals + 1);
  }
}

void PlotValues::fillStatistics() {
  const auto [from, to] = plot_.framesShown();
  put(0, kLeast, textOf(from < to ? buffer_.time(from) : kNan, 3));
  put(0, kLargest, textOf(from < to ? buffer_.time(to - 1) : kNan, 3));
  int row = 1;
  for (const TraceGraph* trace : plot_.traces()) {
    const PlotSignal& signal = trace->signal();
    const TraceBuffer::Statistics all = buffer_.statistics(signal.trace, from, to);
    const double values[]{all.least, all.median, all.p95, all.largest};
    for (int i = 0; i < 4; ++i) put(row, kLeast + i, textOf(values[i] * signal.scale, signal.decimals + 1));
    setRowHidden(row++, signal.rare && std::isnan(all.median));
  }
}

}  // namespace trimtab::views
