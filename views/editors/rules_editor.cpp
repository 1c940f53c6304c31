// SPDX-License-Identifier: GPL-3.0-or-later
#include "rules_editor.h"

#include <QBoxLayout>
#include <QComboBox>
#include <QHeaderView>
#include <QLabel>
#include <QStyledItemDelegate>
#include <QTableView>
#include <QTimer>
#include <QToolButton>

#include "rule_edit.h"
#include "views/controls/choice_box.h"
#include "views/controls/list_table.h"
#include "views/controls/note_line.h"
#include "views/model/keys.h"
#include "views/model/rules_model.h"
#include "views/model/theme.h"

namespace trimtab::views {

namespace {

/// A condition is chosen from a combo box that opens at once.
class ConditionDelegate : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  QWidget* createEditor(QWidget* parent, const QStyleOptionViewItem&,
                        const QModelIndex& index) const override {
    auto* box = new QComboBox(parent);
    box->addItems(RulesModel::conditionsOf(index.column()));
    box->setAccessibleName(
        index.model()->headerData(index.column(), Qt::Horizontal, Qt::DisplayRole).toString());
    auto* self = const_cast<ConditionDelegate*>(this);
    connect(box, &QComboBox::activated, self, [self, box] {
      emit self->commitData(box);
      emit self->closeEditor(box);
    });
    QTimer::singleShot(0, box, &QComboBox::showPopup);
    return box;
  }
  void setEditorData(QWidget* editor, const QModelIndex& index) const override {
    static_cast<QComboBox*>(editor)->setCurrentIndex(index.data(Qt::EditRole).toInt());
  }
  void setModelData(QWidget* editor, QAbstractItemModel* model, const QModelIndex& index) const override {
    model->setData(index, static_cast<QComboBox*>(editor)->currentIndex(), Qt::EditRole);
  }
  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    QStyledItemDelegate::paint(painter, option, index);
    QStyleOption arrow;
    arrow.palette = option.palette;
    arrow.state = QStyle::State_Enabled;
    const int size = option.fontMetrics.height() / 2;
    arrow.rect = QRect(option.rect.right() - size - 4, option.rect.center().y() - size / 2, size, size);
    option.widget->style()->drawPrimitive(QStyle::PE_IndicatorArrowDown, &arrow, painter, option.widget);
  }
  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    return QStyledItemDelegate::sizeHint(option, index) + QSize(option.fontMetrics.height(), 4);
  }
};

}  // namespace

RulesEditor::RulesEditor(Draft& draft, QWidget* parent)
    : QWidget(parent),
      draft_(draft),
      model_(new RulesModel(draft, this)),
      table_(new QTableView),
      note_(new NoteLine) {
  auto* combination = new ChoiceBox(draft, key::kCombination);
  auto* label = new QLabel(tr("Total &is"));
  label->setBuddy(combination);
  auto* top = new QHBoxLayout;
  top->addWidget(label);
  top->addWidget(combination);
  top->addStretch(1);

  setUpListTable(*table_, model_, tr("Rules"), tr("Nose down ▾"));
  table_->verticalHeader()->show();
  table_->setMinimumHeight(fontMetrics().height() * 8);
  auto* conditions = new ConditionDelegate(table_);
  table_->setItemDelegateForColumn(RulesModel::kAltitude, conditions);
  table_->setItemDelegateForColumn(RulesModel::kPitch, conditions);

  auto* buttons = new ListButtons;
  add_ = buttons->add(tr("Add"), tr("Add a rule after the selected one (Insert)"));
  duplicate_ = buttons->add(tr("Duplicate"), tr("Add a copy of the selected rule (Ctrl+D)"));
  remove_ = buttons->add(tr("Remove"), tr("Remove the selected rule (Delete)"));
  up_ = buttons->add(tr("Up"), tr("Move the selected rule up (Alt+Up)"));
  down_ = buttons->add(tr("Down"), tr("Move the selected rule down (Alt+Down)"));
  buttons->addSpace();
  QToolButton* const load =
      buttons->add(tr("Import…"), tr("Take rules and membership curves from a .fll or .fis file"));
  QToolButton* const save = buttons->add(
      tr("Export…"), tr("Write rules and membership curves as FuzzyLite (.fll) or MATLAB (.fis)"));
  connect(load, &QToolButton::clicked, this, &RulesEditor::importAsked);
  connect(save, &QToolButton::clicked, this, &RulesEditor::exportAsked);

  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->addLayout(top);
  layout->addWidget(table_, 1);
  layout->addWidget(buttons);
  layout->addWidget(note_);

  makeActions();
  connect(model_, &RulesModel::refused, this, &RulesEditor::say);
  connect(model_, &RulesModel::accepted, this, [this] { say({}); });
  connect(&draft, &Draft::findingsChanged, this, [this] { say({}); });
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this, &RulesEditor::showNote);
  // A condition is one click away, not two.
  connect(table_, &QTableView::clicked, this, [this](const QModelIndex& index) {
    if (!RulesModel::conditionsOf(index.column()).isEmpty()) table_->edit(index);
  });
  showNote();
}

void RulesEditor::makeActions() {
  addCommand(*table_, *add_, Qt::Key_Insert, [this] { addRule(); });
  addCommand(*table_, *duplicate_, Qt::CTRL | Qt::Key_D, [this] { duplicateRule(); });
  addCommand(*table_, *remove_, Qt::Key_Delete, [this] { removeRule(); });
  addCommand(*table_, *up_, Qt::ALT | Qt::Key_Up, [this] { moveRule(-1); });
  addCommand(*table_, *down_, Qt::ALT | Qt::Key_Down, [this] { moveRule(1); });
}

int RulesEditor::selected() const {
  return table_->currentIndex().isValid() ? table_->currentIndex().row() : -1;
}

void RulesEditor::put(const RuleList& rules, std::size_t select) {
  const int column = std::max(0, table_->currentIndex().column());
  if (const Findings findings = draft_.setValue(key::kRules, rules); !findings.empty())
    return say(QString::fromStdString(toString(findings)));
  table_->setCurrentIndex(model_->index(static_cast<int>(select), column));
  say({});
}

void RulesEditor::addRule() {
  const auto rules = std::get<RuleList>(draft_.value(key::kRules));
  const int at = selected();
  const auto after = at < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(at));
  const auto inserted = withRule(rules, after, {});
  if (!inserted) return say(tr("A rule base has at most %1 rules.").arg(RuleList::kCapacity));
  put(inserted->rules, inserted->index);
}

void RulesEditor::duplicateRule() {
  const auto rules = std::get<RuleList>(draft_.value(key::kRules));
  if (selected() < 0) return;
  const auto at = static_cast<std::size_t>(selected());
  const auto inserted = withRule(rules, at, rules.rule[at]);
  if (!inserted) return say(tr("A rule base has at most %1 rules.").arg(RuleList::kCapacity));
  put(inserted->rules, inserted->index);
}

void RulesEditor::removeRule() {
  if (selected() < 0) return;
  const auto at = static_cast<std::size_t>(selected());
  const auto removed = withoutRule(std::get<RuleList>(draft_.value(key::kRules)), at);
  if (!removed) return say(tr("One rule must stay."));
  put(*removed, std::min(at, removed->size - 1));
}

void RulesEditor::moveRule(int by) {
  if (selected() < 0) return;
  const auto at = static_cast<std::size_t>(selected());
  if (const auto moved = withRuleMoved(std::get<RuleList>(draft_.value(key::kRules)), at, by))
    put(*moved, static_cast<std::size_t>(selected() + by));
}

QString RulesEditor::note() const {
  return note_->text();
}

void RulesEditor::say(const QString& refusal) {
  refusal_ = refusal;
  showNote();
}

void RulesEditor::showNote() {
  QString text = refusal_;
  QColor colour = errorColour(palette());
  if (const Findings findings = draft_.findingsOf(key::kRules); text.isEmpty() && !findings.empty()) {
    text = tr("Expected %1; found %2.")
               .arg(QString::fromStdString(findings.front().expected),
                    QString::fromStdString(findings.front().found));
    if (findings.front().severity != Severity::error) colour = warningColour(palette());
  }
  if (text.isEmpty() && draft_.parameters().scheme.combination != Combination::rules) {
    text = tr("The total does not come from these rules. Choose “Rule base” above to use them.");
    colour = quietColour(palette());
  }
  note_->say(text, colour);
  const int at = selected(), count = model_->rowCount();
  duplicate_->setEnabled(at >= 0);
  remove_->setEnabled(at >= 0);
  up_->setEnabled(at > 0);
  down_->setEnabled(at >= 0 && at + 1 < count);
}

}  // namespace trimtab::views
