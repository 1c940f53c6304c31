// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <optional>

#include "views/model/trace_buffer.h"

class QLabel;
class QListWidget;
class QTableWidget;

namespace trimtab::views {

/// One frame beside the median of the shown ones: its stages, its counts, what was uploaded and paged, and
/// its decision; and the shown frames over the budget, the longest first.
class FramePage : public QWidget {
  Q_OBJECT
 public:
  static constexpr int kMostListed = 100;

  explicit FramePage(const TraceBuffer& buffer, QWidget* parent = nullptr);
  /// The median and the list are of the frames from `from` up to `to`.
  void show(std::optional<std::uint64_t> frame, std::uint64_t from, std::uint64_t to, double budgetMs);
  std::optional<std::uint64_t> frame() const { return frame_; }

  QTableWidget& table() { return *table_; }
  QListWidget& over() { return *over_; }
  QString title() const;

 signals:
  void frameAsked(std::uint64_t frame);
  void spikeAsked(int direction);

 private:
  void fillTable(std::uint64_t from, std::uint64_t to);
  void fillOver(std::uint64_t from, std::uint64_t to, double budgetMs);
  QString worstStage(std::uint64_t frame) const;

  const TraceBuffer& buffer_;
  std::optional<std::uint64_t> frame_;
  QLabel *title_, *overTitle_;
  QTableWidget* table_;
  QListWidget* over_;
};

/// Returns the next image, in a direction of 1 or -1 from a frame, that took longer than the budget and than
/// one and a half times `medianMs`; nothing if there is none before `end`.
std::optional<std::uint64_t> nextSpike(const TraceBuffer& buffer, std::uint64_t from, int direction,
                                       std::uint64_t end, double budgetMs, double medianMs);

}  // namespace trimtab::views
