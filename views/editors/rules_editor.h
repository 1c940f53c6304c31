// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "views/model/draft.h"

class QTableView;
class QToolButton;

namespace trimtab::views {

class NoteLine;
class RulesModel;

/// Edits the rule base of Eq. (2): conditions in combo boxes, weight and output typed; rules are added,
/// copied, removed and moved. Each edit is one undo step.
class RulesEditor : public QWidget {
  Q_OBJECT
 public:
  explicit RulesEditor(Draft& draft, QWidget* parent = nullptr);
  QTableView& table() { return *table_; }
  QString note() const;
  /// Returns the index of the selected rule; -1 for none.
  int selected() const;

 public slots:
  void addRule();
  void duplicateRule();
  void removeRule();
  void moveRule(int by);

 signals:
  void importAsked();
  void exportAsked();

 private:
  void makeActions();
  void put(const RuleList& rules, std::size_t select);
  void say(const QString& refusal);
  void showNote();

  Draft& draft_;
  RulesModel* model_;
  QTableView* table_;
  NoteLine* note_;
  QToolButton *add_, *duplicate_, *remove_, *up_, *down_;
  QString refusal_;
};

}  // namespace trimtab::views
