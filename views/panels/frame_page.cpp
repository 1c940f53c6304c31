// SPDX-License-Identifier: GPL-3.0-or-later
#include "frame_page.h"

#include <QBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QTableWidget>
#include <algorithm>
#include <cmath>
#include <vector>

#include "views/model/plot_signals.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr int kFrameRole = Qt::UserRole;
/// Medians are of at most so many of the newest frames: sorting more would take a time that a person notices.
constexpr std::uint64_t kMostSorted = 20'000;
constexpr double kOverMedian = 1.5;

using enum Trace;
constexpr Trace kRows[]{frame_ms,
                        select_ms,
                        page_ms,
                        occlusion_ms,
                        cull_ms,
                        draw_ms,
                        gpu_ms,
                        blur_ms,
                        weather_ms,
                        symbology_ms,
                        triangles,
                        vertices,
                        tiles_drawn,
                        tiles_outside,
                        tiles_hidden,
                        tiles_built,
                        pages_read,
                        page_read_mb,
                        pages_waiting,
                        dynamic_scheme,
                        band,
                        depth_map_width_px,
                        lod_scale,
                        total_membership,
                        altitude_ft,
                        pitch_deg,
                        line_of_sight_degps};

QString cellText(const PlotSignal& signal, double value) {
  if (!std::isfinite(value)) return QStringLiteral("–");
  if (signal.trace == dynamic_scheme)
    return value > 0.5 ? FramePage::tr("dynamic") : FramePage::tr("frustum");
  if (signal.trace == band && value < 0) return FramePage::tr("none");
  return numberText(value, signal.decimals);
}

QTableWidgetItem* cellOf(const QString& text, bool number) {
  auto* cell = new QTableWidgetItem(text);
  if (number) cell->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
  return cell;
}

}  // namespace

FramePage::FramePage(const TraceBuffer& buffer, QWidget* parent)
    : QWidget(parent),
      buffer_(buffer),
      title_(new QLabel),
      overTitle_(new QLabel),
      table_(new QTableWidget(0, 4)),
      over_(new QListWidget) {
  title_->setWordWrap(true);
  overTitle_->setWordWrap(true);
  table_->setAccessibleName(tr("The chosen frame beside the median of the shown frames"));
  table_->setHorizontalHeaderLabels({tr("What"), tr("This frame"), tr("Median"), tr("Difference")});
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setDefaultSectionSize(fontMetrics().height() + 4);
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setStretchLastSection(true);
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setTabKeyNavigation(false);
  over_->setAccessibleName(tr("Shown frames over the budget, the longest first"));
  connect(over_, &QListWidget::itemActivated, this,
          [this](QListWidgetItem* item) { emit frameAsked(item->data(kFrameRole).toULongLong()); });
  connect(over_, &QListWidget::itemClicked, this,
          [this](QListWidgetItem* item) { emit frameAsked(item->data(kFrameRole).toULongLong()); });

  auto* steps = new QHBoxLayout;
  const auto step = [&](const QString& text, const QString& tip, int direction) {
    auto* button = new QPushButton(text);
    button->setToolTip(tip);
    connect(button, &QPushButton::clicked, this, [this, direction] { emit spikeAsked(direction); });
    steps->addWidget(button);
  };
  const QString what =
      tr("%1 frame that took longer than the budget and one and a half times the median (%2 in the plots)");
  step(tr("Previous spike"), what.arg(tr("The previous"), QStringLiteral("Shift+W")), -1);
  step(tr("Next spike"), what.arg(tr("The next"), QStringLiteral("W")), 1);
  steps->addStretch(1);

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addLayout(steps);
  layout->addWidget(title_);
  layout->addWidget(table_, 3);
  layout->addWidget(overTitle_);
  layout->addWidget(over_, 1);
  show({}, 0, 0, 0);
}

QString FramePage::title() const {
  return title_->text();
}

void FramePage::show(std::optional<std::uint64_t> frame, std::uint64_t from, std::uint64_t to,
                     double budgetMs) {
  frame_ = frame && *frame >= buffer_.begin() && *frame < buffer_.end() ? frame : std::nullopt;
  if (frame_)
    title_->setText(tr("Frame at %1 s: %2 ms of %3 ms; most in %4")
                        .arg(numberText(buffer_.time(*frame_), 3),
                             numberText(shownValue(buffer_, signalOf(frame_ms), *frame_), 1),
                             numberText(budgetMs, 1), worstStage(*frame_)));
  else
    title_->setText(tr("Click a frame in a plot, or go to a spike."));
  fillTable(from, to);
  fillOver(from, to, budgetMs);
}

QString FramePage::worstStage(std::uint64_t frame) const {
  Trace worst = draw_ms;
  for (const StackedStage& stage : kStack)
    if (std::fmax(buffer_.value(stage.stage, frame), 0) > std::fmax(buffer_.value(worst, frame), 0))
      worst = stage.stage;
  return signalOf(worst).name();
}

void FramePage::fillTable(std::uint64_t from, std::uint64_t to) {
  table_->setRowCount(0);
  if (!frame_) return;
  if (to - from > kMostSorted) from = to - kMostSorted;
  for (const Trace trace : kRows) {
    const PlotSignal& signal = signalOf(trace);
    const double here = shownValue(buffer_, signal, *frame_);
    const double usual = buffer_.statistics(trace, from, to).median * signal.scale;
    if (!std::isfinite(here) && !std::isfinite(usual)) continue;
    const int row = table_->rowCount();
    table_->insertRow(row);
    table_->setItem(row, 0, cellOf(signal.fullName(), false));
    table_->setItem(row, 1, cellOf(cellText(signal, here), true));
    table_->setItem(row, 2, cellOf(cellText(signal, usual), true));
    const double by = here - usual;
    const bool says = std::isfinite(by) && trace != dynamic_scheme && numberText(by, signal.decimals) != "0";
    table_->setItem(row, 3,
                    cellOf(says ? (by > 0 ? QStringLiteral("+") : QString()) + numberText(by, signal.decimals)
                                : QString(),
                           true));
  }
}

void FramePage::fillOver(std::uint64_t from, std::uint64_t to, double budgetMs) {
  over_->clear();
  std::vector<std::uint64_t> over;
  std::uint64_t images = 0;
  for (std::uint64_t f = std::max(from, buffer_.begin()); f < std::min(to, buffer_.end()); ++f) {
    if (!buffer_.isNewImage(f)) continue;
    ++images;
    if (static_cast<double>(buffer_.value(frame_ms, f)) > budgetMs) over.push_back(f);
  }
  overTitle_->setText(over.empty()
                          ? tr("None of the shown frames is over %1 ms.").arg(numberText(budgetMs, 1))
                          : tr("%L1 of %L2 shown frames are over %3 ms; the longest:")
                                .arg(over.size())
                                .arg(images)
                                .arg(numberText(budgetMs, 1)));
  const auto most = over.begin() + std::min<std::ptrdiff_t>(std::ssize(over), kMostListed);
  std::partial_sort(over.begin(), most, over.end(), [this](std::uint64_t a, std::uint64_t b) {
    return buffer_.value(frame_ms, a) > buffer_.value(frame_ms, b);
  });
  for (auto f = over.begin(); f != most; ++f) {
    auto* item =
        new QListWidgetItem(tr("%1 s: %2 ms, most in %3")
                                .arg(numberText(buffer_.time(*f), 3),
                                     numberText(double(buffer_.value(frame_ms, *f)), 1), worstStage(*f)),
                            over_);
    item->setData(kFrameRole, qulonglong(*f));
  }
}

std::optional<std::uint64_t> nextSpike(const TraceBuffer& buffer, std::uint64_t from, int direction,
                                       std::uint64_t end, double budgetMs, double medianMs) {
  const double limit = std::fmax(budgetMs, kOverMedian * medianMs);
  const auto isSpike = [&](std::uint64_t f) {
    return static_cast<double>(buffer.value(frame_ms, f)) > limit && buffer.isNewImage(f);
  };
  if (direction > 0) {
    for (std::uint64_t f = std::max(from + 1, buffer.begin()); f < end; ++f)
      if (isSpike(f)) return f;
  } else {
    for (std::uint64_t f = std::min(from, end); f-- > buffer.begin();)
      if (isSpike(f)) return f;
  }
  return std::nullopt;
}

}  // namespace trimtab::views
