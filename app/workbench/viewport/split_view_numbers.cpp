// SPDX-License-Identifier: GPL-3.0-or-later
#include <QHeaderView>
#include <QTableWidget>
#include <cmath>

#include "split_view.h"
#include "split_work.h"
#include "trimtab/measure/statistics.h"
#include "views/model/error_run.h"
#include "views/model/theme.h"

// The table of what both presets cost and lose.
namespace trimtab::workbench {
namespace {

enum Column {
  flipColumn,
  ssimColumn,
  psnrColumn,
  maxPxColumn,
  meanPxColumn,
  trianglesColumn,
  msColumn,
  kColumns
};

/// What the two times say, with the interval of their ratio. A first image that read pages says nothing.
QString timeText(bool timed, const PairedRatio& ratio) {
  if (!timed) return QStringLiteral("–");
  const QString words = QString::fromStdString(inWords(ratio));
  if (differenceOf(ratio) == MeasuredDifference::unknown) return words;
  return SplitView::tr("%1\n× %2 to %3")
      .arg(words, views::numberText(ratio.low, 2), views::numberText(ratio.high, 2));
}

}  // namespace

void SplitView::makeNumbers() {
  numbers_->setRowCount(3);
  numbers_->setColumnCount(kColumns);
  numbers_->setHorizontalHeaderLabels({tr("FLIP"), tr("SSIM"), tr("PSNR (dB)"), tr("Geometric\nmax (px)"),
                                       tr("Geometric\nmean (px)"), tr("Triangles"), tr("Frame (ms)")});
  numbers_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  numbers_->setAccessibleName(tr("Errors and cost of both"));
  numbers_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  numbers_->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  numbers_->setSelectionMode(QAbstractItemView::NoSelection);
  numbers_->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  numbers_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  numbers_->setToolTip(
      tr("The first two rows compare with the reference; the third row compares the right image "
         "with the left one. Times are of both images drawn in turns while the view rests, with the interval "
         "that holds their ratio by 95 %"));
}

void SplitView::fill(const Work& work) {
  const auto put = [this](int row, Column column, const QString& text) {
    auto* item = new QTableWidgetItem(text);
    item->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
    numbers_->setItem(row, column, item);
  };
  const auto errors = [&](int row, double flipError, double ssim, double psnr) {
    put(row, flipColumn, views::numberText(flipError, 4));
    put(row, ssimColumn, views::numberText(ssim, 5));
    put(row, psnrColumn, std::isinf(psnr) ? tr("∞ (equal)") : views::numberText(psnr, 2));
  };
  QStringList names;
  for (const Side side : {left, right}) {
    const Work::One& one = work.sides[side];
    names << (side == left ? tr("Left: %1") : tr("Right: %1")).arg(one.label);
    const FrameError equal{0, 0, 0, INFINITY, 1, 0, 0, 0};
    const FrameError& error = one.reference ? equal : one.error;
    errors(side, error.flip, error.ssim, error.psnrDb);
    put(side, maxPxColumn, views::numberText(error.geometricMaxPx, 2));
    put(side, meanPxColumn, views::numberText(error.geometricMeanPx, 3));
    put(side, trianglesColumn, QLocale().toString(qulonglong(one.drawn().visible.triangles)));
    put(side, msColumn, views::numberText(quantileOf(one.ms, 0.5), 1));
  }
  names << tr("Right compared with left");
  errors(2, work.flip, work.ssim, work.psnr);
  const auto ratio = [&](double a, double b) {
    return a > 0 && b > 0 ? QStringLiteral("× %1").arg(views::numberText(b / a, 2)) : QStringLiteral("–");
  };
  const FrameResult &first = work.sides[left].drawn(), &second = work.sides[right].drawn();
  put(2, maxPxColumn, QStringLiteral("–"));
  put(2, meanPxColumn, QStringLiteral("–"));
  put(2, trianglesColumn, ratio(double(first.visible.triangles), double(second.visible.triangles)));
  put(2, msColumn, timeText(work.timed, work.rightOverLeft()));
  numbers_->setVerticalHeaderLabels(names);
  int height = numbers_->horizontalHeader()->height() + 2 * numbers_->frameWidth();
  for (int row = 0; row < numbers_->rowCount(); ++row) height += numbers_->rowHeight(row);
  numbers_->setFixedHeight(height);
}

}  // namespace trimtab::workbench
