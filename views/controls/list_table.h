// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QWidget>
#include <functional>

class QAbstractItemModel;
class QHBoxLayout;
class QKeySequence;
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

/// Makes a button, a key of the table, and an entry in the table's menu do the same.
void addCommand(QTableView& table, QToolButton& button, const QKeySequence& key, std::function<void()> act);

}  // namespace trimtab::views
