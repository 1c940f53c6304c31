// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept_text_cell.h"

#include <QAbstractItemView>
#include <QApplication>
#include <QCompleter>
#include <QKeyEvent>
#include <QLineEdit>
#include <QStandardItemModel>

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

/// Completes the word before the cursor, by its own letters or those of its name. Enter belongs to the editor
/// unless a word was chosen by the arrow keys.
class WordCompleter : public QCompleter {
 public:
  explicit WordCompleter(QLineEdit& edit) : QCompleter(&edit), edit_(edit) {
    setModel(&model_);
    setWidget(&edit);
    setFilterMode(Qt::MatchContains);
    setCaseSensitivity(Qt::CaseInsensitive);
    popup_ = popup();
    popup_->setAccessibleName(tr("Words"));
    connect(this, qOverload<const QModelIndex&>(&QCompleter::activated), &edit,
            [this](const QModelIndex& chosen) { insert(chosen.data(Qt::UserRole).toString()); });
  }

  qsizetype wordBegin() const {
    const QString before = edit_.text().left(edit_.cursorPosition());
    qsizetype at = before.size();
    while (at > 0 && (before[at - 1].isLetterOrNumber() || before[at - 1] == QLatin1Char('_'))) --at;
    return at;
  }

  void offer(const QList<KeptTextCell::Word>& words) {
    const qsizetype begin = wordBegin();
    const QString typed = edit_.text().mid(begin, edit_.cursorPosition() - begin);
    model_.clear();
    bool whole = typed.isEmpty();
    for (const auto& [word, name, barred] : words) {
      whole = whole || word == typed;
      const QString more = barred.isEmpty() ? name : barred;
      auto* item = new QStandardItem(more.isEmpty() ? word : QStringLiteral("%1 – %2").arg(word, more));
      item->setEnabled(barred.isEmpty());
      item->setData(word, Qt::UserRole);
      model_.appendRow(item);
    }
    setCompletionPrefix(typed);
    if (whole || completionCount() == 0) return popup_->hide();
    QRect under = edit_.inputMethodQuery(Qt::ImCursorRectangle).toRect();
    under.setWidth(popup_->sizeHintForColumn(0) + 24);
    complete(under);
  }

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    const auto isEnter = [event] {
      const int key = static_cast<QKeyEvent*>(event)->key();
      return key == Qt::Key_Return || key == Qt::Key_Enter;
    };
    if (popup_ != nullptr && watched == popup_ && event->type() == QEvent::KeyPress && isEnter() &&
        !popup_->currentIndex().isValid()) {
      popup_->hide();
      return QApplication::sendEvent(&edit_, event);
    }
    return QCompleter::eventFilter(watched, event);
  }

 private:
  void insert(const QString& word) {
    const qsizetype begin = wordBegin();
    edit_.setSelection(int(begin), int(edit_.cursorPosition() - begin));
    edit_.insert(word);
  }

  QLineEdit& edit_;
  QStandardItemModel model_;
  QAbstractItemView* popup_ = nullptr;  ///< none while it is made, which sends events already
};

}  // namespace

void KeptTextCell::addCompleter(QLineEdit& edit, const QPersistentModelIndex& index) const {
  auto* completer = new WordCompleter(edit);
  connect(&edit, &QLineEdit::textEdited, completer, [this, completer, index](const QString& text) {
    completer->offer(words_(index, text.left(completer->wordBegin())));
  });
}

QWidget* KeptTextCell::createEditor(QWidget* parent, const QStyleOptionViewItem&,
                                    const QModelIndex& index) const {
  auto* edit = new QLineEdit(parent);
  edit->setFrame(false);
  edit->setAutoFillBackground(true);
  edit->setAccessibleName(
      index.model()->headerData(index.column(), Qt::Horizontal, Qt::DisplayRole).toString());
  editing_ = index;
  if (words_) addCompleter(*edit, index);
  connect(edit, &QLineEdit::textEdited, edit, [edit] { setInk(*edit, Ink::plain); });
  return edit;
}

void KeptTextCell::setEditorData(QWidget* editor, const QModelIndex& index) const {
  auto& edit = *static_cast<QLineEdit*>(editor);
  if (edit.isModified()) return;  // the table changes while somebody types
  const QString text = index.data(Qt::EditRole).toString();
  const bool keeps = keptFor_ == index && keptOver_ == text;
  edit.setText(keeps ? kept_ : text);
  if (keeps) setInk(edit, Ink::error);
}

void KeptTextCell::setModelData(QWidget* editor, QAbstractItemModel* model, const QModelIndex& index) const {
  const QString text = static_cast<QLineEdit*>(editor)->text(), before = index.data(Qt::EditRole).toString();
  if (text == before) {
    keptFor_ = QModelIndex();
    emit accepted();
    return;
  }
  if (const QString why = check_(index, text); !why.isEmpty()) {
    keptFor_ = index;
    kept_ = text;
    keptOver_ = before;
    emit refused(why);
    return;
  }
  keptFor_ = QModelIndex();
  emit accepted();
  model->setData(index, text, Qt::EditRole);
}

bool KeptTextCell::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::KeyPress) {
    const int key = static_cast<QKeyEvent*>(event)->key();
    auto* edit = qobject_cast<QLineEdit*>(watched);
    const bool done =
        key == Qt::Key_Return || key == Qt::Key_Enter || key == Qt::Key_Tab || key == Qt::Key_Backtab;
    if (key == Qt::Key_Escape) keptFor_ = QModelIndex();
    if (edit != nullptr && done && editing_.isValid() &&
        edit->text() != editing_.data(Qt::EditRole).toString()) {
      if (const QString why = check_(editing_, edit->text()); !why.isEmpty()) {
        setInk(*edit, Ink::error);
        emit refused(why);
        return true;
      }
    }
  }
  return QStyledItemDelegate::eventFilter(watched, event);
}

}  // namespace trimtab::views
