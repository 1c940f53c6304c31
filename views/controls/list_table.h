// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QWidget>

class QAbstractItemModel;
class QHBoxLayout;
class QTableView;
class QToolButton;

namespace trimtab::views {

/// A table for a short list that is edited by typing. One row is selected; columns share the width and are at
/// least as wide as `sample`. Tab leaves the table.
void setUpListTable(QTableView& table, QAbstractItemModel* model, const QString& name, const QString& sample);

/// A row of buttons below such a table.
class ListButtons : public QWidget {
 public:
  explicit ListButtons(QWidget* parent = nullptr);
  /// Adds a button. `tip` says what it does and its key, and is its accessible name too.
  QToolButton* add(const QString& text, const QString& tip);
  /// Puts the following buttons at the other end.
  void addSpace();

 private:
  QHBoxLayout* row_;
  bool spaced_ = false;
};

}  // namespace trimtab::views
