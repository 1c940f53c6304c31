// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QWidget>
#include <optional>
#include <string_view>

#include "policy_draft.h"
#include "policy_live.h"
#include "views/model/live.h"
#include "views/model/throttle.h"

class QLabel;
class QMenu;
class QSplitter;
class QStackedWidget;
class QTabWidget;

namespace trimtab::views {

class FindingsPage;
class LeversView;
class RulesPage;
class SchemePage;
class SharesView;
class SignalsList;
class SurfacePage;
class TermPlot;
class TermsPage;

/// The Policy dock: the signals on the left, the chosen one's terms beside them, and below what follows from
/// them. The first entry of the list is the scheme of documents A and B, with its own curves and rules.
class PolicyPanel : public QWidget {
  Q_OBJECT
 public:
  explicit PolicyPanel(Draft& draft, QWidget* parent = nullptr);

  /// What the dock is made of, for those that lead to a part of it.
  struct Parts {
    SignalsList* signalsList = nullptr;
    SchemePage* scheme = nullptr;
    TermPlot* plot = nullptr;
    QTabWidget* tabs = nullptr;
    TermsPage* terms = nullptr;
    RulesPage* rules = nullptr;
    LeversView* levers = nullptr;
    SharesView* shares = nullptr;
    SurfacePage* surface = nullptr;
    FindingsPage* findings = nullptr;
  };
  const Parts& parts() const { return parts_; }
  PolicyDraft& policy() { return *policy_; }

  void showFrame(const LiveFrame& frame);
  /// Shows the editor of a parameter: a curve or the rules of the scheme, or the terms or rules of the
  /// policy.
  void showEditorOf(std::string_view key);
  /// Shows a rule, or a term with its signal.
  void showRule(int line);
  void showTerm(int line);

  /// Takes over a policy from a file as one undo step. Returns what was wrong with it, or worth knowing.
  /// Returns nothing if the file's variables are no signals and levers, or if its surface can only be come
  /// near to: a dialog that does not wait for its answer asks, and `imported` says what came of it.
  std::optional<Findings> importFile(const QString& file);
  /// Writes the policy that runs. The findings say why it failed.
  Findings exportFile(const QString& file) const;

  /// The least height shows the terms with their plot, or another page without it.
  QSize minimumSizeHint() const override;
  /// A dock scrolls a panel that is higher than this: one whose labels wrap asks for the height that it would
  /// like, not for the least.
  int heightForWidth(int) const override { return minimumSizeHint().height(); }

 signals:
  /// A policy was taken over that a person had to be asked about.
  void imported(const QString& what, const trimtab::Findings& findings);

 public slots:
  void askAndImport();
  void askAndExport();

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void makeTabs();
  void makeKeys();
  void arrange();
  QWidget* makeHead();
  QWidget* makeEmptyState();
  void fillStartMenu(QMenu& menu);
  void choose();
  void showState();
  std::optional<Signal> firstWithTerms() const;
  void addFirstTerm();
  void readActive();
  void refresh();

  Draft& draft_;
  PolicyDraft* policy_;
  PolicyTrack track_;
  LiveFrame frame_;
  PolicyLive live_;
  bool any_ = false, wasEmpty_ = true, schemeShown_ = false;
  bool splitByHand_ = false;  ///< a person has moved the handle between plot and pages
  Parts parts_;
  QStackedWidget* right_;
  QSplitter *upper_, *split_;
  QWidget *head_, *empty_;
  QLabel* note_;
  Throttle throttle_, reviewThrottle_;
};

}  // namespace trimtab::views
