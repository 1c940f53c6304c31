// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTableView>
#include <QWidget>

#include "policy_draft.h"
#include "policy_live.h"

class QLineEdit;
class QToolButton;

namespace trimtab::views {

class NoteLine;
class PolicyRulesModel;

/// The rules of the policy to edit, with buttons. Each edit is one undo step.
class RulesPage : public QWidget {
  Q_OBJECT
 public:
  explicit RulesPage(PolicyDraft& policy, QWidget* parent = nullptr);
  QTableView& table() { return *table_; }
  void showLive(const PolicyLive& live);
  QString note() const;
  /// Returns the selected line; -1 for none.
  int selected() const;
  void select(int line);
  /// Sets the signal that a new rule asks for.
  void setSignal(Signal signal) { signal_ = signal; }

 public slots:
  void addRule();
  void duplicateRule();
  void removeRule();
  void moveRule(int by);
  /// Selects the next rule (1), or the one before (-1), whose line has the searched text. Asks for the text
  /// if there is none.
  void findRule(int by);

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void makeTable();
  void makeActions();
  void makeSearch();
  void arrangeColumns();
  void selectFound(int from, int by);
  void say(const QString& refusal);
  void showNote();
  QString switchNote(std::size_t line) const;
  PolicyRule newRule() const;

  PolicyDraft& policy_;
  PolicyRulesModel* model_;
  QTableView* table_;
  NoteLine* note_;
  QLineEdit* search_;
  QToolButton *add_, *duplicate_, *remove_, *up_, *down_, *find_;
  Signal signal_ = Signal::above_ground;
  QString refusal_;
};

}  // namespace trimtab::views
