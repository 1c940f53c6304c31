// SPDX-License-Identifier: GPL-3.0-or-later
#include "policy_panel.h"

#include <QAction>
#include <QBoxLayout>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QMenu>
#include <QPushButton>
#include <QSplitter>
#include <QStackedWidget>
#include <QTabWidget>
#include <array>

#include "findings_page.h"
#include "lever_surface.h"
#include "levers_view.h"
#include "policy_files.h"
#include "rule_map_dialog.h"
#include "rules_page.h"
#include "scheme_page.h"
#include "shares_view.h"
#include "signals_list.h"
#include "term_plot.h"
#include "terms_page.h"
#include "trimtab/preset/policy_lines.h"
#include "views/controls/parameter_lines.h"
#include "views/controls/scrollable.h"
#include "views/controls/tell_findings.h"
#include "views/model/keys.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

// Lines of text that the plot and the pages need, what stands above both, and what both need at once.
constexpr int kLeastPlotLines = 6, kLeastPageLines = 10, kHeadLines = 5, kRoomyLines = 25;

/// A review takes some milliseconds: it follows a drag two or three times a second.
constexpr int kReviewMs = 400;

}  // namespace

PolicyPanel::PolicyPanel(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      policy_(new PolicyDraft(draft, this)),
      right_(new QStackedWidget),
      upper_(new QSplitter(Qt::Horizontal)),
      split_(new QSplitter(Qt::Vertical)),
      head_(makeHead()),
      empty_(makeEmptyState()),
      note_(new QLabel),
      throttle_(this, [this] { refresh(); }),
      reviewThrottle_(
          this, [this] { parts_.findings->refresh(); }, kReviewMs) {
  parts_.signalsList = new SignalsList(*policy_);
  parts_.scheme = new SchemePage(draft);
  parts_.plot = new TermPlot(*policy_, track_);
  right_->addWidget(parts_.scheme);
  right_->addWidget(parts_.plot);
  upper_->addWidget(parts_.signalsList);
  upper_->addWidget(right_);
  upper_->setStretchFactor(1, 1);
  upper_->setChildrenCollapsible(false);
  makeTabs();
  makeKeys();
  split_->addWidget(upper_);
  split_->addWidget(parts_.tabs);
  split_->setChildrenCollapsible(false);
  right_->setMinimumHeight(kLeastPlotLines * fontMetrics().height());
  parts_.tabs->setMinimumHeight(kLeastPageLines * fontMetrics().height());
  note_->setText(tr("The policy does not hold: the last valid one keeps running. See Findings."));
  note_->setWordWrap(true);
  setInk(*note_, Ink::error);
  // It keeps its place while nothing is wrong, so that no control moves when something is.
  QSizePolicy keepsPlace = note_->sizePolicy();
  keepsPlace.setRetainSizeWhenHidden(true);
  note_->setSizePolicy(keepsPlace);
  note_->hide();
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 2);
  layout->setSpacing(4);
  layout->addWidget(head_);
  layout->addWidget(empty_);
  layout->addWidget(note_);
  layout->addWidget(split_, 1);

  connect(split_, &QSplitter::splitterMoved, this, [this] { splitByHand_ = true; });
  connect(parts_.tabs, &QTabWidget::currentChanged, this, &PolicyPanel::arrange);
  connect(parts_.signalsList, &SignalsList::chosenChanged, this, &PolicyPanel::choose);
  connect(policy_, &PolicyDraft::termsChanged, this, &PolicyPanel::showState);
  connect(policy_, &PolicyDraft::rulesChanged, this, &PolicyPanel::showState);
  connect(&draft_, &Draft::findingsChanged, this, [this] {
    showState();
    reviewThrottle_.request();
    if (any_) throttle_.request();  // firings are those of the draft's rules only while it holds
  });
  connect(&draft_, &Draft::activeChanged, this, [this] {
    readActive();
    if (any_) throttle_.request();
  });
  connect(&draft_, &Draft::imageGeneratorChanged, this, [this] { refresh(); });
  connect(&draft_, &Draft::loaded, this, [this] { track_.clear(); });
  readActive();
  choose();
  reviewThrottle_.request();
}

QWidget* PolicyPanel::makeHead() {
  auto* head = new QWidget;
  auto* row = new QHBoxLayout(head);
  row->setContentsMargins(0, 0, 0, 0);
  const auto add = [this, row](std::string_view name, int stretch) {
    row->addWidget(new ParameterLines(draft_, std::array{name.data()}), stretch);
  };
  add(key::kPolicyEnabled, 0);
  add(key::kPolicyNorm, 1);
  head->setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Fixed);
  return head;
}

QWidget* PolicyPanel::makeEmptyState() {
  auto* box = new QWidget;
  auto* text = new QLabel(tr(
      "A policy is a set of rules that let the flight set the levers, such as “if above_ground is low then "
      "screen_space_error = 4”. This preset has none."));
  text->setWordWrap(true);
  auto* start = new QPushButton(tr("Start from…"));
  start->setToolTip(tr("Take over the policy of a preset that ships"));
  auto* menu = new QMenu(start);
  connect(menu, &QMenu::aboutToShow, this, [this, menu] { fillStartMenu(*menu); });
  start->setMenu(menu);
  auto* add = new QPushButton(tr("Add a term"));
  add->setToolTip(tr("Begin with what a rule may call low, fast or steep"));
  connect(add, &QPushButton::clicked, this, &PolicyPanel::addFirstTerm);
  auto* load = new QPushButton(tr("Import…"));
  load->setToolTip(tr("Take a policy from a file of a fuzzy-logic tool"));
  connect(load, &QPushButton::clicked, this, &PolicyPanel::askAndImport);
  auto* row = new QHBoxLayout;
  for (QPushButton* button : {start, add, load}) {
    button->setAutoDefault(false);
    row->addWidget(button);
  }
  row->addStretch(1);
  auto* layout = new QVBoxLayout(box);
  layout->setContentsMargins(2, 0, 2, 0);
  layout->setSpacing(4);
  layout->addWidget(text);
  layout->addLayout(row);
  return box;
}

void PolicyPanel::fillStartMenu(QMenu& menu) {
  menu.clear();
  for (const std::string_view name : shippedPresets()) {
    const auto preset = loadPreset(std::string(name));
    const auto policy = preset ? policyOf(preset->parameters.policy) : Result<Policy>(Policy{});
    if (!policy || policy->empty()) continue;
    QAction* action = menu.addAction(fromView(name), this, [this, taken = *policy, name] {
      policy_->replace(taken, tr("Start from %1").arg(fromView(name)));
    });
    action->setToolTip(QString::fromStdString(preset->description));
  }
  menu.setToolTipsVisible(true);
  if (menu.isEmpty()) menu.addAction(tr("no preset that ships has a policy"))->setEnabled(false);
}

void PolicyPanel::makeTabs() {
  Parts& p = parts_;
  p.tabs = new QTabWidget;
  p.tabs->setDocumentMode(true);
  p.tabs->setAccessibleName(tr("Pages of the policy"));
  p.terms = new TermsPage(*policy_, *p.plot);
  p.rules = new RulesPage(*policy_);
  p.levers = new LeversView;
  p.shares = new SharesView;
  p.surface = new SurfacePage(*policy_, track_);
  p.findings = new FindingsPage(*policy_);
  // Bars and shares scroll apart, so that no scroll bar is within another.
  auto* levers = new QSplitter(Qt::Vertical);
  levers->addWidget(scrollable(p.levers, tr("Levers")));
  levers->addWidget(p.shares);
  levers->setStretchFactor(0, 3);
  levers->setStretchFactor(1, 2);
  levers->setChildrenCollapsible(false);
  p.tabs->addTab(p.terms, tr("Terms"));
  p.tabs->addTab(p.rules, tr("Rules"));
  p.tabs->addTab(levers, tr("Levers"));
  p.tabs->addTab(p.surface, tr("Surface"));
  p.tabs->addTab(p.findings, tr("Findings"));
  p.tabs->setTabToolTip(2, tr("Where the levers are, and the share of each rule in them"));
  p.tabs->setTabToolTip(3, tr("A lever over two signals"));
  p.tabs->setTabToolTip(4, tr("What is allowed and probably not meant"));
  connect(p.plot, &TermPlot::typingAsked, this, [this] {
    parts_.tabs->setCurrentWidget(parts_.terms);
    parts_.terms->typeNumbers();
  });
  connect(p.plot, &TermPlot::refused, this, [this] { parts_.tabs->setCurrentWidget(parts_.terms); });
  connect(p.findings, &FindingsPage::ruleAsked, this, &PolicyPanel::showRule);
  connect(p.findings, &FindingsPage::termAsked, this, &PolicyPanel::showTerm);
  connect(p.findings, &FindingsPage::countChanged, this, [this](int count) {
    parts_.tabs->setTabText(4, count == 0 ? tr("Findings") : tr("Findings (%1)").arg(count));
  });
}

/// Ctrl+Tab goes through the pages from wherever the focus is in the dock.
void PolicyPanel::makeKeys() {
  for (const int by : {1, -1}) {
    auto* step = new QAction(this);
    if (by > 0)
      step->setShortcut(Qt::CTRL | Qt::Key_Tab);
    else
      step->setShortcuts({Qt::CTRL | Qt::SHIFT | Qt::Key_Tab, Qt::CTRL | Qt::SHIFT | Qt::Key_Backtab});
    step->setShortcutContext(Qt::WidgetWithChildrenShortcut);
    addAction(step);
    connect(step, &QAction::triggered, this, [this, by] {
      QTabWidget& pages = parts_.signalsList->chosen() ? *parts_.tabs : *parts_.scheme;
      pages.setCurrentIndex((pages.currentIndex() + by + pages.count()) % pages.count());
      if (parts_.signalsList->chosen()) arrange();
      pages.currentWidget()->setFocus();
    });
  }
}

void PolicyPanel::choose() {
  const auto signal = parts_.signalsList->chosen();
  if (signal) {
    parts_.terms->setSignal(*signal);
    parts_.rules->setSignal(*signal);
    right_->setCurrentWidget(parts_.plot);
  } else {
    right_->setCurrentWidget(parts_.scheme);
  }
  // Of both, only the one that is shown asks for its width.
  for (QWidget* page : {static_cast<QWidget*>(parts_.scheme), static_cast<QWidget*>(parts_.plot)}) {
    QSizePolicy width = page->sizePolicy();
    width.setHorizontalPolicy(page == right_->currentWidget() ? QSizePolicy::Expanding
                                                              : QSizePolicy::Ignored);
    page->setSizePolicy(width);
  }
  // The curves of the scheme stand beside their tables and need the room of the values.
  const bool narrower = std::exchange(schemeShown_, !signal) != !signal;
  if (narrower) {
    parts_.signalsList->showValues(signal.has_value());
    upper_->setSizes({signal ? parts_.signalsList->wholeWidth() : parts_.signalsList->minimumWidth(), 10000});
  }
  showState();
  if (any_) throttle_.request();
}

/// In a low dock only the page of terms stands below its plot, and in a very low one no page does: the pages
/// scroll, so that the dock itself need not.
void PolicyPanel::arrange() {
  const int lines = height() / fontMetrics().height();
  const bool pages = !parts_.tabs->isHidden(), roomy = lines >= kRoomyLines;
  const bool both = lines >= kLeastPlotLines + kLeastPageLines + kHeadLines;
  const bool plot = roomy || !pages || (both && parts_.tabs->currentWidget() == parts_.terms);
  upper_->setVisible(plot);
  setFocusProxy(plot ? static_cast<QWidget*>(parts_.signalsList) : parts_.tabs->currentWidget());
  if (!plot || !pages || splitByHand_) return;
  const int upper = split_->height() * 42 / 100;
  split_->setSizes({upper, split_->height() - upper});
}

QSize PolicyPanel::minimumSizeHint() const {
  return {QWidget::minimumSizeHint().width(), (kLeastPageLines + kHeadLines) * fontMetrics().height()};
}

void PolicyPanel::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  arrange();
}

std::optional<Signal> PolicyPanel::firstWithTerms() const {
  for (const SignalRow& row : kSignalRows)
    if (!policy_->termsOf(row.signal).empty()) return row.signal;
  return std::nullopt;
}

void PolicyPanel::showState() {
  const bool empty = policy_->empty();
  // Who opens, imports or begins a policy wants to see it.
  if (std::exchange(wasEmpty_, empty) && !empty && !parts_.signalsList->chosen())
    parts_.signalsList->choose(firstWithTerms());
  head_->setVisible(!empty || draft_.parameters().policy.enabled);
  empty_->setVisible(empty);
  parts_.tabs->setVisible(!empty && parts_.signalsList->chosen().has_value());
  arrange();
  const bool broken =
      !draft_.findingsOf(key::kPolicyTerms).empty() || !draft_.findingsOf(key::kPolicyRules).empty();
  note_->setVisible(broken);
}

void PolicyPanel::addFirstTerm() {
  if (!parts_.signalsList->chosen()) parts_.signalsList->choose(Signal::above_ground);
  parts_.terms->addTerm();
  parts_.tabs->setCurrentWidget(parts_.terms);
  parts_.plot->setFocus();
}

void PolicyPanel::showFrame(const LiveFrame& frame) {
  frame_ = frame;
  any_ = true;
  track_.push(frame.time, frame.input.signalValues);
  parts_.scheme->showFrame(frame);
  throttle_.request();
}

/// Reads the active policy once for each change of it; frames only decide it.
void PolicyPanel::readActive() {
  live_.policy = policy_->active();
}

void PolicyPanel::refresh() {
  live_.compiled = draft_.active().policy();
  live_.ig = draft_.imageGenerator();
  live_.seen = any_;
  if (any_) live_.flight = frame_.input.signalValues;
  live_.decided = any_ && live_.compiled != nullptr;
  live_.matches = !draft_.isBroken();
  if (live_.decided) {
    live_.outcome = frame_.decision.policy;
    live_.compiled->decide(live_.flight, live_.decision);
  }
  parts_.signalsList->showLive(live_);
  if (!parts_.signalsList->chosen()) return;
  parts_.plot->showLive(live_);
  parts_.terms->showLive(live_);
  parts_.rules->showLive(live_);
  parts_.levers->showLive(live_);
  parts_.shares->showLive(live_);
  parts_.surface->showLive(live_);
}

void PolicyPanel::showEditorOf(std::string_view key) {
  if (key == key::kPolicyTerms || key == key::kPolicyRules) {
    if (!parts_.signalsList->chosen())
      parts_.signalsList->choose(firstWithTerms().value_or(Signal::above_ground));
    const bool rules = key == key::kPolicyRules;
    parts_.tabs->setCurrentWidget(rules ? static_cast<QWidget*>(parts_.rules) : parts_.terms);
    (rules ? static_cast<QWidget*>(&parts_.rules->table()) : parts_.plot)->setFocus();
    return;
  }
  parts_.signalsList->choose(std::nullopt);
  parts_.scheme->showMemberships();
  parts_.scheme->setFocus();
}

void PolicyPanel::showRule(int line) {
  parts_.tabs->setCurrentWidget(parts_.rules);
  parts_.rules->select(line);
  parts_.rules->table().setFocus();
}

void PolicyPanel::showTerm(int line) {
  const auto& term = policy_->terms()[static_cast<std::size_t>(line)].term;
  if (!term) return;
  parts_.signalsList->choose(term->signal);
  parts_.tabs->setCurrentWidget(parts_.terms);
  parts_.plot->selectTerm(line, 0);
  parts_.plot->setFocus();
}

std::optional<Findings> PolicyPanel::importFile(const QString& file) {
  const Result<RuleFile> rules = openRuleFile(file);
  if (!rules) return rules.findings();
  const Result<Policy> policy = rules->policy({}, false);
  if (policy ? rules->acceptMatters() : mappingMayHelp(policy.findings())) {
    for (RuleMapDialog* earlier : findChildren<RuleMapDialog*>()) earlier->close();
    auto* dialog = new RuleMapDialog(
        *rules, QFileInfo(file).fileName(),
        [this, file](const Policy& made, const Findings& notes) {
          policy_->replace(made, tr("Import Policy"));
          emit imported(tr("The policy was imported: %1").arg(file), notes);
        },
        this);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->open();
    return std::nullopt;
  }
  if (policy) policy_->replace(*policy, tr("Import Policy"));
  return policy.findings();
}

Findings PolicyPanel::exportFile(const QString& file) const {
  return writePolicyFile(file, policy_->active(), draft_.preset().name);
}

void PolicyPanel::askAndImport() {
  const QString file = QFileDialog::getOpenFileName(this, tr("Import Policy"), {}, policyFileFilters());
  if (file.isEmpty()) return;
  if (const auto findings = importFile(file))
    tellFindings(this, tr("The policy was not imported"), tr("The policy was imported"), *findings);
}

void PolicyPanel::askAndExport() {
  QFileDialog dialog(this, tr("Export Policy"), {}, policyFileFilters());
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("fll"));
  dialog.selectFile(QStringLiteral("policy.fll"));
  if (dialog.exec() != QDialog::Accepted) return;
  tellFindings(this, tr("The policy was not exported"), tr("The policy was exported"),
               exportFile(dialog.selectedFiles().constFirst()));
}

}  // namespace trimtab::views
