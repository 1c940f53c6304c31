// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QListWidget>
#include <QWidget>

#include "policy_draft.h"

namespace trimtab::views {

/// What a review of the policy found, or why the draft does not run; a line leads to its rule or term.
class FindingsPage : public QWidget {
  Q_OBJECT
 public:
  explicit FindingsPage(PolicyDraft& policy, QWidget* parent = nullptr);
  const Findings& findings() const { return findings_; }
  QListWidget& list() { return *list_; }
  /// Reviews the policy if it has changed since the last time, which takes some milliseconds.
  void refresh();

 signals:
  void countChanged(int count);
  void ruleAsked(int line);
  void termAsked(int line);

 private:
  void showFindings(const Findings& findings);
  void colourLines();
  void follow(int row);

  PolicyDraft& policy_;
  QListWidget* list_;
  Findings findings_;
  std::optional<Policy> reviewed_;
  int told_ = -1;
};

}  // namespace trimtab::views
