// SPDX-License-Identifier: GPL-3.0-or-later
#include "sweep_page.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QStackedWidget>
#include <QTableWidget>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>

#include "trimtab/preset/table.h"
#include "trimtab/units/not_finite.h"
#include "views/model/error_run.h"
#include "views/model/theme.h"
#include "views/plots/cividis.h"
#include "views/plots/sweep_plot.h"

namespace trimtab::workbench {
namespace {

/// Returns the parameter's label with its unit.
QString titleOf(const harness::SweepAxis& axis) {
  const ParameterRow* const row = findRow(axis.key);
  if (row == nullptr) return QString::fromStdString(axis.key);
  const QString label = views::fromView(row->label);
  return row->unit.empty() ? label : QStringLiteral("%1 (%2)").arg(label, views::fromView(row->unit));
}

QStringList valuesOf(const harness::SweepAxis& axis) {
  QStringList values;
  for (const std::string& value : axis.values) values << QString::fromStdString(value);
  return values;
}

QString nameOf(const harness::Sweep& sweep) {
  QStringList axes;
  for (const harness::SweepAxis& axis : sweep.axes) axes << titleOf(axis);
  return SweepPage::tr("%1, %2: %3")
      .arg(QString::fromStdString(sweep.base), views::methodText(QString::fromStdString(sweep.method)),
           axes.join(QStringLiteral(" × ")));
}

/// Returns the best rows of one sweep.
std::vector<std::size_t> bestIn(const harness::Sweep& sweep, const harness::Results& results,
                                const harness::Answer& answer) {
  std::vector<std::size_t> rows;
  for (const std::size_t row : sweep.rows)
    if (row != harness::Sweep::kNotMeasured) rows.push_back(row);
  return harness::bestOf(results, answer, rows);
}

bool holds(const std::vector<std::size_t>& rows, std::size_t row) {
  return std::find(rows.begin(), rows.end(), row) != rows.end();
}

}  // namespace

SweepPage::SweepPage(QWidget* parent)
    : QWidget(parent),
      choice_(new QComboBox(this)),
      quantity_(new QComboBox(this)),
      said_(new QLabel(this)),
      pages_(new QStackedWidget(this)),
      nothing_(
          new QLabel(tr("No parameter was swept. Measure has a choice of one or two parameters to sweep."))),
      plot_(new views::SweepPlot),
      map_(new QTableWidget) {
  choice_->setAccessibleName(tr("Sweep"));
  choice_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  quantity_->addItems({tr("p95 (ms)"), tr("median (ms)"), tr("over budget (%)"), tr("FLIP"),
                       tr("geometric, largest (px)"), tr("pop p95 (of 255)")});
  quantity_->setAccessibleName(tr("What the map shows"));
  said_->setWordWrap(true);
  nothing_->setAlignment(Qt::AlignCenter);
  nothing_->setWordWrap(true);
  map_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  map_->setAccessibleName(tr("Map of the sweep"));
  map_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  map_->verticalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  for (QWidget* page :
       {static_cast<QWidget*>(nothing_), static_cast<QWidget*>(plot_), static_cast<QWidget*>(map_)})
    pages_->addWidget(page);
  auto* top = new QHBoxLayout;
  top->addWidget(choice_, 1);
  top->addWidget(quantity_);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  column->addLayout(top);
  column->addWidget(said_);
  column->addWidget(pages_, 1);
  connect(choice_, &QComboBox::currentIndexChanged, this, &SweepPage::showSweep);
  connect(quantity_, &QComboBox::currentIndexChanged, this, &SweepPage::showSweep);
  clear();
}

void SweepPage::clear() {
  show({}, {});
}

void SweepPage::show(const harness::Results& results, const harness::Answer& answer) {
  const int kept = choice_->currentIndex();
  answer_ = answer;
  sweeps_ = harness::sweepsOf(answer_);
  best_.clear();
  for (const harness::Sweep& sweep : sweeps_) best_.push_back(bestIn(sweep, results, answer_));
  {
    const QSignalBlocker quiet(choice_);
    choice_->clear();
    for (const harness::Sweep& sweep : sweeps_) choice_->addItem(nameOf(sweep));
    choice_->setCurrentIndex(std::clamp(kept, sweeps_.empty() ? -1 : 0, int(sweeps_.size()) - 1));
  }
  showSweep();
}

QString SweepPage::text() const {
  return said_->text();
}

void SweepPage::showSweep() {
  const int index = choice_->currentIndex();
  const bool any = index >= 0 && std::size_t(index) < sweeps_.size();
  for (QWidget* part : {static_cast<QWidget*>(choice_), static_cast<QWidget*>(said_)}) part->setVisible(any);
  if (!any) {
    quantity_->hide();
    return pages_->setCurrentWidget(nothing_);
  }
  const harness::Sweep& sweep = sweeps_[std::size_t(index)];
  const std::vector<std::size_t>& best = best_[std::size_t(index)];
  const QString budget = views::msText(answer_.budgetMs);
  QStringList names;
  for (const std::size_t row : best) names << QString::fromStdString(answer_.rows[row].name.preset);
  if (names.isEmpty())
    said_->setText(tr("None of these values fits %1.").arg(budget));
  else if (names.size() == 1)
    said_->setText(tr("★ %1 is the best of what fits %2.").arg(names[0], budget));
  else
    said_->setText(tr("★ %1 do not differ, and are the best of what fits %2.")
                       .arg(names.join(QStringLiteral(", ")), budget));
  quantity_->setVisible(sweep.axes.size() > 1);
  sweep.axes.size() > 1 ? showMap(sweep, best) : showLine(sweep, best);
}

void SweepPage::showLine(const harness::Sweep& sweep, const std::vector<std::size_t>& best) {
  views::SweepLine line{titleOf(sweep.axes[0]), valuesOf(sweep.axes[0]), {}, {}, answer_.budgetMs, -1};
  for (const std::size_t row : sweep.rows) {
    const bool measured = row != harness::Sweep::kNotMeasured;
    if (measured && !best.empty() && row == best.front()) line.best = line.ms.size();
    line.ms.append(measured ? answer_.rows[row].p95Ms : kNan);
    line.flip.append(measured ? answer_.rows[row].flip : kNan);
  }
  plot_->show(line);
  pages_->setCurrentWidget(plot_);
}

double SweepPage::valueOf(std::size_t row) const {
  if (row == harness::Sweep::kNotMeasured) return kNan;
  const harness::AnswerRow& r = answer_.rows[row];
  switch (Quantity(quantity_->currentIndex())) {
    case Quantity::p95:
      return r.p95Ms;
    case Quantity::median:
      return r.medianMs;
    case Quantity::over:
      return r.overShare * 100;
    case Quantity::flip:
      return r.flip;
    case Quantity::geometric:
      return r.geometricPx;
    case Quantity::pop:
      return r.pop;
  }
  return kNan;
}

void SweepPage::showMap(const harness::Sweep& sweep, const std::vector<std::size_t>& best) {
  const auto down = sweep.axes[0].values.size(), across = sweep.axes[1].values.size();
  map_->setRowCount(int(down));
  map_->setColumnCount(int(across));
  QStringList rows = valuesOf(sweep.axes[0]), columns = valuesOf(sweep.axes[1]);
  rows[0] = titleOf(sweep.axes[0]) + QLatin1Char('\n') + rows[0];
  columns[0] = titleOf(sweep.axes[1]) + QLatin1Char('\n') + columns[0];
  map_->setVerticalHeaderLabels(rows);
  map_->setHorizontalHeaderLabels(columns);
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const std::size_t row : sweep.rows)
    if (const double value = valueOf(row); std::isfinite(value))
      low = std::min(low, value), high = std::max(high, value);
  QCPColorGradient gradient = views::cividis();
  for (std::size_t i = 0; i < down; ++i)
    for (std::size_t j = 0; j < across; ++j) {
      const std::size_t row = sweep.at(i, j);
      const double value = valueOf(row);
      const bool timed = row != harness::Sweep::kNotMeasured && !std::isnan(answer_.rows[row].medianMs);
      const bool fits = timed && answer_.rows[row].fit != harness::Fit::no;
      const QString number =
          std::isnan(value) ? QStringLiteral("–") : views::textOf({{}, {}, {}, true}, value);
      auto* cell = new QTableWidgetItem(!timed || (fits && !holds(best, row)) ? number
                                        : fits                                ? tr("★ %1").arg(number)
                                                                              : tr("✕ %1").arg(number));
      cell->setTextAlignment(Qt::AlignCenter);
      cell->setToolTip(timed ? QString::fromStdString(harness::verdictText(answer_, row))
                             : tr("not measured"));
      if (std::isfinite(value)) {
        const QColor colour(gradient.color(value, QCPRange(low, std::max(high, low + 1e-12))));
        cell->setBackground(colour);
        cell->setForeground(colour.lightness() > 120 ? Qt::black : Qt::white);
      }
      map_->setItem(int(i), int(j), cell);
    }
  pages_->setCurrentWidget(map_);
}

}  // namespace trimtab::workbench
