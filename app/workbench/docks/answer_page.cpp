// SPDX-License-Identifier: GPL-3.0-or-later
#include "answer_page.h"

#include <QEvent>
#include <QHeaderView>
#include <QLabel>
#include <QTableWidget>
#include <QVBoxLayout>
#include <cmath>

#include "views/model/error_run.h"
#include "views/model/theme.h"

namespace trimtab::workbench {
namespace {

enum AnswerColumn { preset, culling, median, p95, p99, over, flip, geometric, pop, verdict, kAnswerColumns };

/// Sorts by its number, so that 9 comes before 10. What was not measured comes last.
class Number : public QTableWidgetItem {
 public:
  Number(double value, const QString& text) : QTableWidgetItem(text), value_(value) {
    setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
  }
  bool operator<(const QTableWidgetItem& other) const override {
    return rank() < static_cast<const Number&>(other).rank();
  }

 private:
  double rank() const { return std::isnan(value_) ? HUGE_VAL : value_; }
  double value_;
};

/// Returns a number with three digits and no unit, which its column names.
QString digits(double value) {
  return views::textOf({{}, {}, {}, true}, value);
}

/// A percentile, or why there is none.
QTableWidgetItem* percentileOf(double value, int needed) {
  auto* cell = new Number(value, digits(value));
  if (std::isnan(value)) cell->setToolTip(AnswerPage::tr("Needs %1 frames").arg(needed));
  return cell;
}

QTableWidgetItem* verdictOf(const harness::Answer& answer, std::size_t row) {
  // The rows are sorted by rank: the best comes first, then what fits, then what may fit.
  const double rank = answer.isBest(row) ? -1 : double(answer.rows[row].fit);
  const QString words = QString::fromStdString(harness::verdictText(answer, row));
  return new Number(rank, answer.isBest(row) ? QStringLiteral("★ ") + words : words);
}

}  // namespace

AnswerPage::AnswerPage(QWidget* parent)
    : QWidget(parent),
      why_(new QLabel(this)),
      measured_(new QLabel(this)),
      table_(new QTableWidget(0, kAnswerColumns, this)) {
  table_->setHorizontalHeaderLabels({tr("Preset"), tr("Culling"), tr("Median\n(ms)"), tr("p95\n(ms)"),
                                     tr("p99\n(ms)"), tr("Over\nbudget (%)"), tr("FLIP\n(mean)"),
                                     tr("Geometric\nlargest (px)"), tr("Pop p95\n(of 255)"), tr("Verdict")});
  const char* const hints[kAnswerColumns] = {
      QT_TR_NOOP("The preset"),
      QT_TR_NOOP("The culling case in which it was drawn"),
      QT_TR_NOOP("Half of the frames take no longer"),
      QT_TR_NOOP("95 % of the frames take no longer. It needs 20 frames"),
      QT_TR_NOOP("99 % of the frames take no longer. It needs 100 frames"),
      QT_TR_NOOP("Share of the frames that take longer than the budget"),
      QT_TR_NOOP("Difference from the reference that a person sees, 0 to 1; mean of the frames"),
      QT_TR_NOOP("By how many pixels the ground is displaced at most"),
      QT_TR_NOOP(
          "By how much the image jumps from frame to frame beyond the reference; 95 % of the frames jump "
          "no more"),
      QT_TR_NOOP(
          "A preset fits if 95 % of its frames are surely within the budget, and may fit where the frames do "
          "not "
          "tell. The best have the smallest FLIP, or the shortest frames where FLIP does not differ; if "
          "several are the best, no difference between them can be told from noise")};
  for (int column = 0; column < kAnswerColumns; ++column)
    table_->horizontalHeaderItem(column)->setToolTip(tr(hints[column]));
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setSelectionBehavior(QAbstractItemView::SelectRows);
  table_->setAccessibleName(tr("Measured presets"));
  table_->verticalHeader()->hide();
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setStretchLastSection(true);
  table_->horizontalHeader()->setSortIndicator(verdict, Qt::AscendingOrder);
  table_->setSortingEnabled(true);
  why_->setWordWrap(true);
  why_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  why_->setAccessibleName(tr("Best preset"));
  measured_->setWordWrap(true);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  column->addWidget(why_);
  column->addWidget(measured_);
  column->addWidget(table_, 1);
  clear();
}

void AnswerPage::clear() {
  answer_.reset();
  measured_->clear();
  fill();
}

void AnswerPage::show(const harness::Results& results, const QString& flight, double budgetMs) {
  answer_ = harness::answerOf(results, flight.toStdString(), budgetMs);
  const std::size_t frames = answer_->rows.empty() ? 0 : answer_->rows.front().frames;
  measured_->setText(tr("%L1 frames along %2 over %3, drawn at %L4 × %L5 px; budget %6")
                         .arg(frames)
                         .arg(flight, QString::fromStdString(results.terrain))
                         .arg(results.widthPx)
                         .arg(results.heightPx)
                         .arg(views::msText(budgetMs)));
  fill();
}

QString AnswerPage::text() const {
  return why_->text() + QLatin1Char('\n') + measured_->text();
}

void AnswerPage::fill() {
  why_->setText(answer_ ? QString::fromStdString(answer_->why)
                        : tr("Nothing has been measured. Measure says which preset fits the budget."));
  measured_->setVisible(answer_.has_value());
  table_->setVisible(answer_.has_value());
  // A row would move while its cells are put in.
  table_->setSortingEnabled(false);
  table_->setRowCount(answer_ ? int(answer_->rows.size()) : 0);
  for (int i = 0; i < table_->rowCount(); ++i) {
    const harness::AnswerRow& row = answer_->rows[std::size_t(i)];
    const bool best = answer_->isBest(std::size_t(i));
    table_->setItem(i, preset, new QTableWidgetItem(QString::fromStdString(row.name.preset)));
    table_->setItem(i, culling,
                    new QTableWidgetItem(views::methodText(QString::fromStdString(row.name.method))));
    const auto put = [&](AnswerColumn column, double value) {
      table_->setItem(i, column, new Number(value, digits(value)));
    };
    put(median, row.medianMs);
    table_->setItem(i, p95, percentileOf(row.p95Ms, 20));
    if (std::isfinite(row.p95Ms))
      table_->item(i, p95)->setToolTip(
          tr("Of the flight: %1, each bound with 95 % confidence")
              .arg(QString::fromStdString(harness::boundsText(row.p95BoundsMs))));
    table_->setItem(i, p99, percentileOf(row.p99Ms, 100));
    put(over, row.overShare * 100);
    put(flip, row.flip);
    put(geometric, row.geometricPx);
    put(pop, row.pop);
    table_->setItem(i, verdict, verdictOf(*answer_, std::size_t(i)));
    for (int column = 0; column < kAnswerColumns; ++column) {
      QTableWidgetItem& cell = *table_->item(i, column);
      if (best)
        cell.setBackground(
            views::blend(palette().color(QPalette::Base), views::seriesColour(2, palette()), 0.25));
      if (row.fit == harness::Fit::no) cell.setForeground(views::quietColour(palette()));
    }
  }
  table_->setSortingEnabled(true);
}

void AnswerPage::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange) fill();
}

}  // namespace trimtab::workbench
