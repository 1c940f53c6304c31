// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>
#include <QWidget>

class QAbstractItemModel;
class QHBoxLayout;
class QTableView;
class QToolButton;

namespace trimtab::views {

/// The table of a short list that an editor edits by typing: one row is selected, columns share the width and
/// are at least as wide as `sample`. Tab leaves the table.
void setUpListTable(QTableView& table, QAbstractItemModel* model, const QString& name, const QString& sample);

/// The buttons below such a table, in a row.
class ListButtons : public QWidget {
 public:
  explicit ListButtons(QWidget* parent = nullptr);
  /// `tip` says what it does and its key; it is the accessible name too.
  QToolButton* add(const QString& text, const QString& tip);
  /// What follows stands at the other end.
  void addSpace();

 private:
  QHBoxLayout* row_;
  bool spaced_ = false;
};

}  // namespace trimtab::views
