// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "views/model/draft.h"

class QLabel;
class QTableView;

namespace trimtab::views {

class ChangesModel;

/// The page Changes: every edit with the values before and after it and its time. It is the history too: a
/// click or Enter on a row goes back, or forward, to it; Delete takes one change back and keeps later ones.
class ChangesPanel : public QWidget {
  Q_OBJECT
 public:
  explicit ChangesPanel(Draft& draft, QWidget* parent = nullptr);

  QTableView& table() { return *table_; }
  QString summary() const;

 private:
  void setUpTable();
  void goTo(const QModelIndex& index);
  void copy();
  void revert();
  void summarise();

  Draft& draft_;
  ChangesModel* model_;
  QTableView* table_;
  QLabel* summary_;
};

}  // namespace trimtab::views
