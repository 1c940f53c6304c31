// SPDX-License-Identifier: GPL-3.0-or-later
#include "report_view.h"

#include <QComboBox>
#include <QHeaderView>
#include <QPlainTextEdit>
#include <QTabWidget>
#include <QTableWidget>
#include <QVBoxLayout>
#include <cmath>

#include "views/model/theme.h"
#include "views/model/value_text.h"
#include "views/plots/report_plot.h"

namespace trimtab::workbench {
namespace {

void fill(QTableWidget& table, const experiment::Table& from) {
  table.clear();
  table.setRowCount(int(from.rows.size()));
  table.setColumnCount(int(from.columns.size()));
  for (int c = 0; c < table.columnCount(); ++c) {
    const std::string& column = from.columns[std::size_t(c)];
    table.setHorizontalHeaderItem(c, new QTableWidgetItem(QString::fromStdString(column).replace('_', ' ')));
    for (int r = 0; r < table.rowCount(); ++r) {
      const double number = from.number(std::size_t(r), column);
      const QString text = std::isfinite(number) ? views::numberText(number, std::abs(number) >= 1000 ? 0 : 3)
                                                 : QString::fromStdString(from.text(std::size_t(r), column));
      auto* item = new QTableWidgetItem(text);
      if (std::isfinite(number)) item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
      table.setItem(r, c, item);
    }
  }
  table.resizeColumnsToContents();
}

views::ReportPlotData toView(const experiment::Plot& plot) {
  views::ReportPlotData data{QString::fromStdString(plot.title),
                             QString::fromStdString(plot.xLabel),
                             QString::fromStdString(plot.yLabel),
                             {},
                             {}};
  for (const std::string& category : plot.categories) data.categories << QString::fromStdString(category);
  for (const experiment::Series& s : plot.series)
    data.series.append({QString::fromStdString(s.name), QVector<double>(s.x.begin(), s.x.end()),
                        QVector<double>(s.y.begin(), s.y.end()),
                        QVector<double>(s.yLow.begin(), s.yLow.end()),
                        QVector<double>(s.yHigh.begin(), s.yHigh.end())});
  return data;
}

}  // namespace

ReportView::ReportView(const QString& what, QWidget* parent)
    : QWidget(parent),
      table_(new QTableWidget(this)),
      plots_(new QComboBox(this)),
      plot_(new views::ReportPlot(this)),
      notes_(new QPlainTextEdit(this)) {
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setAlternatingRowColors(true);
  table_->setTabKeyNavigation(false);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(20);
  table_->setAccessibleName(what);
  table_->setMinimumHeight(48);
  plots_->setAccessibleName(tr("Plot"));
  notes_->setReadOnly(true);
  notes_->setAccessibleName(tr("Notes"));

  auto* plotPage = new QWidget(this);
  auto* plotColumn = new QVBoxLayout(plotPage);
  plotColumn->addWidget(plots_);
  plotColumn->addWidget(plot_, 1);
  auto* tabs = new QTabWidget(this);
  tabs->addTab(table_, tr("&Table"));
  tabs->addTab(plotPage, tr("&Plots"));
  tabs->addTab(notes_, tr("&Notes"));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(tabs, 1);
  connect(plots_, &QComboBox::currentIndexChanged, this, &ReportView::showPlot);
}

void ReportView::show(const experiment::Report& report) {
  report_ = report;
  fill(*table_, report.measured);
  QStringList notes{QString::fromStdString(report.machine)};
  for (const std::string& note : report.notes) notes << QString::fromStdString(note);
  notes_->setPlainText(notes.join(QStringLiteral("\n\n")));
  plots_->clear();
  for (const experiment::Plot& plot : report.plots) plots_->addItem(QString::fromStdString(plot.title));
}

void ReportView::showPlot(int index) {
  if (!report_ || index < 0 || index >= int(report_->plots.size())) return plot_->clear();
  plot_->show(toView(report_->plots[std::size_t(index)]));
}

}  // namespace trimtab::workbench
