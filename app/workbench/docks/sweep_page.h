// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <vector>

#include "app/harness/answer.h"
#include "app/harness/sweep.h"

class QComboBox;
class QLabel;
class QStackedWidget;
class QTableWidget;

namespace trimtab::views {
class SweepPlot;
}  // namespace trimtab::views

namespace trimtab::workbench {

/// Shows a sweep: one parameter as lines of frame time and error, two as a map whose cells are coloured by
/// one of them. Cells over the budget are crossed, and the best one that fits is marked.
class SweepPage : public QWidget {
  Q_OBJECT

 public:
  explicit SweepPage(QWidget* parent = nullptr);

  /// Shows the sweeps of an answer from these results; an answer without any says how to make one.
  void show(const harness::Results& results, const harness::Answer& answer);
  void clear();

  std::size_t sweeps() const { return sweeps_.size(); }
  views::SweepPlot& plot() { return *plot_; }
  QTableWidget& map() { return *map_; }
  QString text() const;

 private:
  enum class Quantity { p95, median, over, flip, geometric, pop };

  void showSweep();
  /// `best` are the rows that are marked.
  void showLine(const harness::Sweep& sweep, const std::vector<std::size_t>& best);
  void showMap(const harness::Sweep& sweep, const std::vector<std::size_t>& best);
  double valueOf(std::size_t row) const;

  harness::Answer answer_;
  std::vector<harness::Sweep> sweeps_;
  std::vector<std::vector<std::size_t>> best_;  ///< of each sweep; they need not be the best of the answer
  QComboBox *choice_, *quantity_;
  QLabel* said_;
  QStackedWidget* pages_;
  QLabel* nothing_;
  views::SweepPlot* plot_;
  QTableWidget* map_;
};

}  // namespace trimtab::workbench
