// SPDX-License-Identifier: GPL-3.0-or-later
#include "kept_text_cell.h"

#include <QKeyEvent>
#include <QLineEdit>

#include "views/model/theme.h"

namespace trimtab::views {

QWidget* KeptTextCell::createEditor(QWidget* parent, const QStyleOptionViewItem&,
                                    const QModelIndex& index) const {
  auto* edit = new QLineEdit(parent);
  edit->setFrame(false);
  edit->setAutoFillBackground(true);
  edit->setAccessibleName(
      index.model()->headerData(index.column(), Qt::Horizontal, Qt::DisplayRole).toString());
  editing_ = index;
  connect(edit, &QLineEdit::textEdited, edit,
          [edit] { setTextColour(*edit, edit->parentWidget()->palette().color(QPalette::Text)); });
  return edit;
}

void KeptTextCell::setEditorData(QWidget* editor, const QModelIndex& index) const {
  auto& edit = *static_cast<QLineEdit*>(editor);
  if (edit.isModified()) return;  // the table changes while somebody types
  const QString text = index.data(Qt::EditRole).toString();
  const bool keeps = keptFor_ == index && keptOver_ == text;
  edit.setText(keeps ? kept_ : text);
  if (keeps) setTextColour(edit, errorColour(edit.palette()));
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
        setTextColour(*edit, errorColour(edit->palette()));
        emit refused(why);
        return true;
      }
    }
  }
  return QStyledItemDelegate::eventFilter(watched, event);
}

}  // namespace trimtab::views
