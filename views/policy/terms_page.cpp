// SPDX-License-Identifier: GPL-3.0-or-later
#include "terms_page.h"

#include <QBoxLayout>
#include <QComboBox>
#include <QHeaderView>
#include <QTimer>
#include <QToolButton>

#include "bar_cell.h"
#include "kept_text_cell.h"
#include "term_plot.h"
#include "terms_model.h"
#include "views/controls/list_table.h"
#include "views/controls/note_line.h"
#include "views/model/keys.h"
#include "views/model/theme.h"

namespace trimtab::views {
namespace {

/// The shape of a term is chosen from a combo box that opens at once.
class ShapeCell : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  QWidget* createEditor(QWidget* parent, const QStyleOptionViewItem&, const QModelIndex&) const override {
    auto* box = new QComboBox(parent);
    for (const std::string_view shape : kTermShapes) box->addItem(fromView(shape));
    box->setAccessibleName(tr("Shape"));
    auto* self = const_cast<ShapeCell*>(this);
    connect(box, &QComboBox::activated, self, [self, box] {
      emit self->commitData(box);
      emit self->closeEditor(box);
    });
    QTimer::singleShot(0, box, &QComboBox::showPopup);
    return box;
  }
  void setEditorData(QWidget* editor, const QModelIndex& index) const override {
    static_cast<QComboBox*>(editor)->setCurrentText(index.data(Qt::EditRole).toString());
  }
  void setModelData(QWidget* editor, QAbstractItemModel* model, const QModelIndex& index) const override {
    model->setData(index, static_cast<QComboBox*>(editor)->currentText(), Qt::EditRole);
  }
};

}  // namespace

TermsPage::TermsPage(PolicyDraft& policy, TermPlot& plot, QWidget* parent)
    : QWidget(parent),
      policy_(policy),
      plot_(plot),
      model_(new TermsModel(policy, this)),
      table_(new QTableView),
      note_(new NoteLine) {
  setUpListTable(*table_, model_, tr("Terms"), tr("00.0"));
  const auto width = [this](const char* sample) {
    return fontMetrics().horizontalAdvance(QLatin1String(sample)) + 16;
  };
  QHeaderView* const columns = table_->horizontalHeader();
  columns->setSectionResizeMode(QHeaderView::Interactive);
  columns->setSectionResizeMode(TermsModel::kNumbers, QHeaderView::Stretch);
  columns->resizeSection(TermsModel::kName, width("near_ground_xx"));
  columns->resizeSection(TermsModel::kShape, width("trapezoid"));
  columns->resizeSection(TermsModel::kNow, width("0.00 0.0"));
  table_->setWordWrap(false);
  table_->setMinimumWidth(width("near_ground trapezoid -inf 0 500 1500 0.00"));
  table_->setMinimumHeight(fontMetrics().height() * 4);
  table_->setEditTriggers(QAbstractItemView::DoubleClicked | QAbstractItemView::EditKeyPressed |
                          QAbstractItemView::AnyKeyPressed);
  auto* text = new KeptTextCell(
      [this](const QModelIndex& index, const QString& typed) { return model_->refusal(index, typed); },
      table_);
  connect(text, &KeptTextCell::refused, this, &TermsPage::say);
  connect(text, &KeptTextCell::accepted, this, [this] { say({}); });
  table_->setItemDelegateForColumn(TermsModel::kName, text);
  table_->setItemDelegateForColumn(TermsModel::kNumbers, text);
  table_->setItemDelegateForColumn(TermsModel::kShape, new ShapeCell(table_));
  table_->setItemDelegateForColumn(TermsModel::kNow, new BarCell(table_));

  auto* buttons = new ListButtons;
  add_ = buttons->add(tr("Add"), tr("Add a term to this signal (Insert)"));
  duplicate_ = buttons->add(tr("Duplicate"), tr("Add a copy of the selected term (Ctrl+D)"));
  remove_ = buttons->add(tr("Remove"), tr("Remove the selected term (Delete)"));
  buttons->addSpace();
  copy_ = buttons->add(tr("Copy shape"), tr("Copy the selected term's shape (Ctrl+C)"));
  paste_ = buttons->add(tr("Paste shape"), tr("Give the selected term the copied shape (Ctrl+V)"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(4, 4, 4, 4);
  layout->setSpacing(4);
  layout->addWidget(table_, 1);
  layout->addWidget(buttons);
  layout->addWidget(note_);

  setFocusProxy(table_);
  makeActions();
  connect(&plot_, &TermPlot::selectedChanged, this, [this] {
    const int row = model_->rowOfLine(plot_.term());
    if (row < 0)
      table_->clearSelection();
    else if (table_->currentIndex().row() != row)
      table_->setCurrentIndex(model_->index(row, std::max(0, table_->currentIndex().column())));
    else
      table_->selectRow(row);
    say({});
  });
  connect(table_->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& current) {
            if (current.isValid()) plot_.selectTerm(model_->lineOf(current.row()), plot_.selected());
            showNote();
          });
  connect(&plot_, &TermPlot::refused, this, &TermsPage::say);
  connect(&plot_, &TermPlot::addAsked, this, &TermsPage::addTerm);
  connect(&plot_, &TermPlot::duplicateAsked, this, &TermsPage::duplicateTerm);
  connect(&plot_, &TermPlot::removeAsked, this, &TermsPage::removeTerm);
  connect(&plot_, &TermPlot::dragged, this, [this] { say({}); });
  connect(&policy_.draft(), &Draft::findingsChanged, this, [this] { showNote(); });
  showNote();
}

void TermsPage::makeActions() {
  addCommand(*table_, *add_, Qt::Key_Insert, [this] { addTerm(); });
  addCommand(*table_, *duplicate_, Qt::CTRL | Qt::Key_D, [this] { duplicateTerm(); });
  addCommand(*table_, *remove_, Qt::Key_Delete, [this] { removeTerm(); });
  addCommand(*table_, *copy_, QKeySequence::Copy, [this] { plot_.copyShape(); });
  addCommand(*table_, *paste_, QKeySequence::Paste, [this] { plot_.pasteShape(); });
}

int TermsPage::selectedLine() const {
  return table_->currentIndex().isValid() ? model_->lineOf(table_->currentIndex().row()) : -1;
}

void TermsPage::setSignal(Signal signal) {
  model_->setSignal(signal);
  plot_.setSignal(signal);
  const int row = model_->rowOfLine(plot_.term());
  if (row >= 0) table_->setCurrentIndex(model_->index(row, 0));
  say({});
}

void TermsPage::showLive(const PolicyLive& live) {
  model_->showLive(live);
}

void TermsPage::addTerm() {
  if (policy_.terms().size() >= kMostPolicyTerms)
    return say(tr("A policy has at most %1 terms.").arg(kMostPolicyTerms));
  const Signal signal = plot_.signal();
  const PolicyTerm term = newTerm(signal, policy_.freeName(signal, "term"), plot_.view());
  const std::size_t line = policy_.terms().size();
  policy_.insertTerm(line, term, tr("Add Term"));
  plot_.selectTerm(static_cast<int>(line), 0);
}

void TermsPage::duplicateTerm() {
  const int line = selectedLine();
  if (line < 0 || !policy_.terms()[static_cast<std::size_t>(line)].term) return;
  if (policy_.terms().size() >= kMostPolicyTerms)
    return say(tr("A policy has at most %1 terms.").arg(kMostPolicyTerms));
  PolicyTerm copy = *policy_.terms()[static_cast<std::size_t>(line)].term;
  copy.name = policy_.freeName(copy.signal, copy.name);
  policy_.insertTerm(static_cast<std::size_t>(line) + 1, copy, tr("Duplicate Term"));
  plot_.selectTerm(line + 1, 0);
}

void TermsPage::removeTerm() {
  if (const int line = selectedLine(); line >= 0) policy_.removeTerm(static_cast<std::size_t>(line));
}

void TermsPage::typeNumbers() {
  const int row = model_->rowOfLine(plot_.term());
  if (row < 0) return;
  table_->setFocus();
  table_->setCurrentIndex(model_->index(row, TermsModel::kNumbers));
  table_->edit(model_->index(row, TermsModel::kNumbers));
}

QString TermsPage::note() const {
  return note_->text();
}

void TermsPage::say(const QString& refusal) {
  refusal_ = refusal;
  showNote();
}

void TermsPage::showNote() {
  QString text = refusal_;
  if (text.isEmpty()) text = sentences(policy_.draft().findingsOf(key::kPolicyTerms));
  note_->say(text, Ink::error);
  const bool any = selectedLine() >= 0;
  for (QToolButton* button : {duplicate_, remove_, copy_, paste_}) button->setEnabled(any);
}

}  // namespace trimtab::views
