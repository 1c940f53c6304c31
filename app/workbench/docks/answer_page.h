// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <optional>

#include "app/harness/answer.h"

class QLabel;
class QTableWidget;

namespace trimtab::workbench {

/// Says which measured preset fits the budget best, and shows the numbers of all of them in a table that a
/// person sorts by any column.
class AnswerPage : public QWidget {
  Q_OBJECT

 public:
  explicit AnswerPage(QWidget* parent = nullptr);

  /// Shows the units of one flight against this budget.
  void show(const harness::Results& results, const QString& flight, double budgetMs);
  /// Says that nothing has been measured.
  void clear();

  const std::optional<harness::Answer>& answer() const { return answer_; }
  QString text() const;
  QTableWidget& table() { return *table_; }

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void fill();

  std::optional<harness::Answer> answer_;
  QLabel *why_, *measured_;
  QTableWidget* table_;
};

}  // namespace trimtab::workbench
