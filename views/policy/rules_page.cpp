// SPDX-License-Identifier: GPL-3.0-or-later
#include "rules_page.h"

#include <QAction>
#include <QBoxLayout>
#include <QHeaderView>
#include <QLineEdit>
#include <QRegularExpression>
#include <QScrollBar>
#include <QToolButton>
#include <algorithm>
#include <cmath>

#include "bar_cell.h"
#include "kept_text_cell.h"
#include "policy_rules_model.h"
#include "views/controls/list_table.h"
#include "views/controls/note_line.h"
#include "views/model/ig_words.h"
#include "views/model/keys.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

/// Returns the terms that may follow "SIGNAL is" and hedges; the signals, or the levers, in any other place.
QList<KeptTextCell::Word> wordsAfter(const QString& before, bool settings, const PolicyDraft& policy) {
  QList<KeptTextCell::Word> words;
  if (settings || before.contains(QStringLiteral(" then "))) {
    const IgProfile* const ig = policy.draft().imageGenerator();
    for (const LeverRow& row : kLeverRows)
      words << KeptTextCell::Word{fromView(row.key), fromView(row.label), lacksText(ig, row.key)};
    return words;
  }
  static const QRegularExpression kIs(
      QStringLiteral("(\\w+) is (not |very |somewhat |extremely |seldom )*$"));
  const auto signal = signalNamed(kIs.match(before).captured(1).toStdString());
  if (!signal) {
    for (const SignalRow& row : kSignalRows)
      words << KeptTextCell::Word{fromView(row.key), fromView(row.label)};
    return words;
  }
  for (const std::size_t line : policy.termsOf(*signal))
    words << KeptTextCell::Word{QString::fromStdString(policy.terms()[line].term->name)};
  for (const char* word : {"any", "not", "very", "somewhat", "extremely", "seldom"})
    words << KeptTextCell::Word{QString::fromLatin1(word)};
  return words;
}

}  // namespace

RulesPage::RulesPage(PolicyDraft& policy, QWidget* parent)
    : QWidget(parent),
      policy_(policy),
      model_(new PolicyRulesModel(policy, this)),
      table_(new QTableView),
      note_(new NoteLine),
      search_(new QLineEdit) {
  makeTable();
  auto* buttons = new ListButtons;
  add_ = buttons->add(tr("Add"), tr("Add a rule after the selected one (Insert)"));
  duplicate_ = buttons->add(tr("Duplicate"), tr("Add a copy of the selected rule (Ctrl+D)"));
  remove_ = buttons->add(tr("Remove"), tr("Remove the selected rule (Delete)"));
  up_ = buttons->add(tr("Up"), tr("Move the selected rule up (Alt+Up)"));
  down_ = buttons->add(tr("Down"), tr("Move the selected rule down (Alt+Down)"));
  find_ = buttons->add(tr("Find"), tr("Find a rule by a part of its line (F3; Shift+F3 finds backwards)"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->setSpacing(4);
  layout->addWidget(table_, 1);
  layout->addWidget(search_);
  layout->addWidget(buttons);
  layout->addWidget(note_);
  setFocusProxy(table_);
  makeActions();
  makeSearch();
  connect(model_, &PolicyRulesModel::moved, this, &RulesPage::select);
  connect(&policy_.draft(), &Draft::findingsChanged, this, [this] { showNote(); });
  connect(&policy_, &PolicyDraft::rulesChanged, this, &RulesPage::arrangeColumns);
  connect(&policy_, &PolicyDraft::rulesChanged, this, &RulesPage::showNote);
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this, &RulesPage::showNote);
  showNote();
}

void RulesPage::makeTable() {
  setUpListTable(*table_, model_, tr("Rules of the policy"), tr("00.0"));
  const auto width = [this](const char* sample) {
    return fontMetrics().horizontalAdvance(QLatin1String(sample)) + 14;
  };
  QHeaderView* const columns = table_->horizontalHeader();
  columns->setMinimumSectionSize(width("On"));
  columns->setSectionResizeMode(QHeaderView::Interactive);
  columns->resizeSection(PolicyRulesModel::kOn, width("On"));
  columns->moveSection(PolicyRulesModel::kFires, PolicyRulesModel::kCondition);
  columns->resizeSection(PolicyRulesModel::kWeight, width("Weight"));
  columns->resizeSection(PolicyRulesModel::kFires, width("0.00 0"));
  table_->setHorizontalScrollBarPolicy(Qt::ScrollBarAsNeeded);
  table_->setHorizontalScrollMode(QAbstractItemView::ScrollPerPixel);
  table_->setMinimumWidth(width("above_ground is low and speed is fast 0.00"));
  table_->setMinimumHeight(fontMetrics().height() * 4);
  table_->setWordWrap(false);
  QHeaderView* const lines = table_->verticalHeader();
  lines->show();
  lines->setSectionResizeMode(QHeaderView::Fixed);
  lines->setMinimumSectionSize(fontMetrics().height() + 4);
  lines->setDefaultSectionSize(fontMetrics().height() + 6);
  table_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed |
                          QAbstractItemView::AnyKeyPressed);
  table_->setDragDropMode(QAbstractItemView::InternalMove);
  table_->setDragDropOverwriteMode(false);
  table_->setDropIndicatorShown(true);
  table_->setDragEnabled(true);
  auto* text = new KeptTextCell(
      [this](const QModelIndex& index, const QString& typed) { return model_->refusal(index, typed); },
      table_);
  connect(text, &KeptTextCell::refused, this, &RulesPage::say);
  connect(text, &KeptTextCell::accepted, this, [this] { say({}); });
  text->completeFrom([this](const QModelIndex& index, const QString& before) {
    const bool words =
        index.column() == PolicyRulesModel::kCondition || index.column() == PolicyRulesModel::kSettings;
    return words ? wordsAfter(before, index.column() == PolicyRulesModel::kSettings, policy_)
                 : QList<KeptTextCell::Word>{};
  });
  for (const int column : {PolicyRulesModel::kCondition, PolicyRulesModel::kSettings,
                           PolicyRulesModel::kWeight, PolicyRulesModel::kReason})
    table_->setItemDelegateForColumn(column, text);
  table_->setItemDelegateForColumn(PolicyRulesModel::kFires, new BarCell(table_));
}

/// Conditions and settings stand whole; what is beyond the edge is scrolled to. The reason takes what the
/// other columns leave.
void RulesPage::arrangeColumns() {
  for (const int column :
       {PolicyRulesModel::kCondition, PolicyRulesModel::kSettings, PolicyRulesModel::kReason})
    table_->resizeColumnToContents(column);
  const int reason = table_->columnWidth(PolicyRulesModel::kReason);
  const QScrollBar& bar = *table_->verticalScrollBar();
  int others = table_->verticalHeader()->sizeHint().width() + 2 * table_->frameWidth() +
               (bar.isVisible() ? bar.sizeHint().width() : 0);
  for (int column = 0; column < PolicyRulesModel::kReason; ++column) others += table_->columnWidth(column);
  const int rest = table_->width() - others;
  // Less than a word of the reason would be a cut one: the condition takes the place.
  const int word = fontMetrics().horizontalAdvance(tr("Reason")) + 14;
  if (rest > 0 && rest < word)
    table_->setColumnWidth(PolicyRulesModel::kCondition,
                           table_->columnWidth(PolicyRulesModel::kCondition) + rest);
  table_->setColumnWidth(PolicyRulesModel::kReason, std::max(reason, rest));
}

void RulesPage::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  arrangeColumns();
}

void RulesPage::makeActions() {
  addCommand(*table_, *add_, Qt::Key_Insert, [this] { addRule(); });
  addCommand(*table_, *duplicate_, Qt::CTRL | Qt::Key_D, [this] { duplicateRule(); });
  addCommand(*table_, *remove_, Qt::Key_Delete, [this] { removeRule(); });
  addCommand(*table_, *up_, Qt::ALT | Qt::Key_Up, [this] { moveRule(-1); });
  addCommand(*table_, *down_, Qt::ALT | Qt::Key_Down, [this] { moveRule(1); });
}

void RulesPage::makeSearch() {
  search_->hide();
  search_->setPlaceholderText(tr("A part of a rule: a signal, a term, a lever, a reason"));
  search_->setAccessibleName(tr("Find a rule"));
  connect(find_, &QToolButton::clicked, this, [this] { findRule(1); });
  connect(search_, &QLineEdit::returnPressed, this, [this] { findRule(1); });
  // While it is typed, the selected rule stays as long as it has the text.
  connect(search_, &QLineEdit::textEdited, this, [this] { selectFound(std::max(0, selected()), 1); });
  const auto action = [](QWidget* where, const QKeySequence& keys, Qt::ShortcutContext context, auto act) {
    auto* a = new QAction(where);
    a->setShortcut(keys);
    a->setShortcutContext(context);
    where->addAction(a);
    connect(a, &QAction::triggered, where, act);
  };
  action(this, Qt::Key_F3, Qt::WidgetWithChildrenShortcut, [this] { findRule(1); });
  action(this, Qt::SHIFT | Qt::Key_F3, Qt::WidgetWithChildrenShortcut, [this] { findRule(-1); });
  action(search_, Qt::Key_Escape, Qt::WidgetShortcut, [this] {
    search_->hide();
    table_->setFocus();
    say({});
  });
}

void RulesPage::findRule(int by) {
  if (search_->isHidden() || search_->text().trimmed().isEmpty()) {
    search_->show();
    search_->setFocus();
    search_->selectAll();
    return;
  }
  selectFound(selected() + by, by);
}

void RulesPage::selectFound(int from, int by) {
  const QString wanted = search_->text().trimmed();
  const int count = model_->rowCount();
  for (int i = 0; i < count && !wanted.isEmpty(); ++i) {
    const int line = ((from + i * by) % count + count) % count;
    const std::string& text = policy_.rules()[static_cast<std::size_t>(line)].text;
    if (!QString::fromStdString(text).contains(wanted, Qt::CaseInsensitive)) continue;
    select(line);
    return say({});
  }
  say(wanted.isEmpty() ? QString() : tr("No rule has “%1”.").arg(wanted));
}

int RulesPage::selected() const {
  return table_->currentIndex().isValid() ? table_->currentIndex().row() : -1;
}

void RulesPage::select(int line) {
  if (line < 0 || line >= model_->rowCount()) return;
  const int column = std::max(int(PolicyRulesModel::kCondition), table_->currentIndex().column());
  table_->setCurrentIndex(model_->index(line, column));
  table_->scrollTo(model_->index(line, column));
}

void RulesPage::showLive(const PolicyLive& live) {
  model_->showLive(live);
}

/// A rule that asks for what the person looks at.
PolicyRule RulesPage::newRule() const {
  PolicyRule rule;
  Signal signal = signal_;
  std::string term = "any";
  const auto terms = policy_.termsOf(signal);
  if (!terms.empty()) term = policy_.terms()[terms.front()].term->name;
  rule.condition = std::string(rowOf(signal).key) + " is " + term;
  rule.settings = {{Lever::screen_space_error, 4}};
  const auto has = [this](const LeverRow& row) {
    return lacksText(policy_.draft().imageGenerator(), row.key).isEmpty();
  };
  // For an image generator without one, it sets a lever that is there, to what changes nothing yet.
  if (!has(rowOf(Lever::screen_space_error)))
    if (const auto row = std::ranges::find_if(kLeverRows, has); row != kLeverRows.end())
      rule.settings = {{row->lever, std::isfinite(row->neutral) ? row->neutral : row->usual.high}};
  return rule;
}

void RulesPage::addRule() {
  if (policy_.rules().size() >= kMostPolicyRules)
    return say(tr("A policy has at most %1 rules.").arg(kMostPolicyRules));
  const int at = selected() < 0 ? model_->rowCount() : selected() + 1;
  policy_.insertRule(static_cast<std::size_t>(at), newRule(), tr("Add Rule"));
  select(at);
  say({});
}

void RulesPage::duplicateRule() {
  const int at = selected();
  if (at < 0 || !policy_.rules()[static_cast<std::size_t>(at)].rule) return;
  if (policy_.rules().size() >= kMostPolicyRules)
    return say(tr("A policy has at most %1 rules.").arg(kMostPolicyRules));
  policy_.insertRule(static_cast<std::size_t>(at) + 1, *policy_.rules()[static_cast<std::size_t>(at)].rule,
                     tr("Duplicate Rule"));
  select(at + 1);
  say({});
}

void RulesPage::removeRule() {
  const int at = selected();
  if (at < 0) return;
  policy_.removeRule(static_cast<std::size_t>(at));
  select(std::min(at, model_->rowCount() - 1));
  say({});
}

void RulesPage::moveRule(int by) {
  const int at = selected(), to = at + by;
  if (at < 0 || to < 0 || to >= model_->rowCount()) return;
  policy_.moveRule(static_cast<std::size_t>(at), static_cast<std::size_t>(to));
  select(to);
}

/// Levers are weighted means: a rule that no other rule shares a lever with sets it in full as soon as it
/// fires at all.
QString RulesPage::switchNote(std::size_t line) const {
  const auto counts = [this](std::size_t i) {
    const auto& rule = policy_.rules()[i].rule;
    return rule && rule->enabled && rule->weight > 0;
  };
  if (!counts(line)) return {};
  QStringList alone;
  for (const LeverSetting& setting : policy_.rules()[line].rule->settings) {
    bool shared = false;
    for (std::size_t i = 0; i < policy_.rules().size(); ++i)
      shared = shared || (i != line && counts(i) &&
                          std::ranges::find(policy_.rules()[i].rule->settings, setting.lever,
                                            &LeverSetting::lever) != policy_.rules()[i].rule->settings.end());
    if (!shared) alone << fromView(rowOf(setting.lever).label);
  }
  if (alone.isEmpty()) return {};
  return tr("Rule %1 is a switch: no other rule sets %2, so it counts in full at any firing above 0.")
      .arg(line + 1)
      .arg(alone.join(QStringLiteral(", ")));
}

QString RulesPage::note() const {
  return note_->text();
}

void RulesPage::say(const QString& refusal) {
  refusal_ = refusal;
  showNote();
}

void RulesPage::showNote() {
  QString text = refusal_;
  if (text.isEmpty()) text = sentences(policy_.draft().findingsOf(key::kPolicyRules));
  const int at = selected(), count = model_->rowCount();
  const QString switches = text.isEmpty() && at >= 0 ? switchNote(static_cast<std::size_t>(at)) : QString();
  note_->say(text + switches, text.isEmpty() ? Ink::quiet : Ink::error);
  duplicate_->setEnabled(at >= 0);
  remove_->setEnabled(at >= 0);
  up_->setEnabled(at > 0);
  down_->setEnabled(at >= 0 && at + 1 < count);
}

}  // namespace trimtab::views
