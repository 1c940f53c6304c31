// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>

#include "views/model/draft.h"
#include "views/model/live.h"

namespace trimtab::views {

class RulesEditor;
class RuleViewer;

/// The Rules dock: the rule base, and below it what each rule does in the last frame.
class RulesPanel : public QWidget {
  Q_OBJECT
 public:
  explicit RulesPanel(Draft& draft, QWidget* parent = nullptr);
  RulesEditor& editor() { return *editor_; }
  RuleViewer& viewer() { return *viewer_; }
  void showFrame(const LiveFrame& frame);

  /// Takes over rules and curves of a .fll or .fis file as one undo step. Returns what was wrong with it, or
  /// worth knowing.
  Findings importFile(const QString& file);
  /// Writes the rules and curves of the active parameters. The findings say why it failed, or what the file
  /// cannot express.
  Findings exportFile(const QString& file) const;

 public slots:
  void askAndImport();
  void askAndExport();

 private:
  Draft& draft_;
  RulesEditor* editor_;
  RuleViewer* viewer_;
};

}  // namespace trimtab::views
