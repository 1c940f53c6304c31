// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTableView>
#include <QWidget>

#include "policy_draft.h"
#include "policy_live.h"

class QToolButton;

namespace trimtab::views {

class NoteLine;
class TermPlot;
class TermsModel;

/// The terms of the plotted signal to type: names, shapes and numbers, with buttons. The selection is the
/// plot's.
class TermsPage : public QWidget {
  Q_OBJECT
 public:
  TermsPage(PolicyDraft& policy, TermPlot& plot, QWidget* parent = nullptr);
  QTableView& table() { return *table_; }
  void setSignal(Signal signal);
  void showLive(const PolicyLive& live);
  QString note() const;

 public slots:
  void addTerm();
  void duplicateTerm();
  void removeTerm();
  void typeNumbers();
  void say(const QString& refusal);

 private:
  void makeActions();
  void showNote();
  int selectedLine() const;

  PolicyDraft& policy_;
  TermPlot& plot_;
  TermsModel* model_;
  QTableView* table_;
  NoteLine* note_;
  QToolButton *add_, *duplicate_, *remove_, *copy_, *paste_;
  QString refusal_;
};

}  // namespace trimtab::views
