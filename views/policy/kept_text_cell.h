// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QList>
#include <QStyledItemDelegate>
#include <functional>
#include <utility>

class QLineEdit;

namespace trimtab::views {

/// Edits a cell as text and keeps what was typed while it is refused: Enter does not close the editor, and a
/// cell that was left with a refused text offers it again the next time.
class KeptTextCell : public QStyledItemDelegate {
  Q_OBJECT
 public:
  /// `check` returns why a text is refused; empty if it is taken.
  using Check = std::function<QString(const QModelIndex&, const QString&)>;

  KeptTextCell(Check check, QObject* parent) : QStyledItemDelegate(parent), check_(std::move(check)) {}

  struct Word {
    QString word;      ///< "above_ground"
    QString name{};    ///< what it is called, "Height above ground"
    QString barred{};  ///< why it cannot be chosen: it is shown grey, with the reason
  };
  /// Returns the words that may follow a text.
  using Words = std::function<QList<Word>(const QModelIndex&, const QString& before)>;
  /// Offers words below the editor while one types.
  void completeFrom(Words words) { words_ = std::move(words); }

  QWidget* createEditor(QWidget* parent, const QStyleOptionViewItem& option,
                        const QModelIndex& index) const override;
  void setEditorData(QWidget* editor, const QModelIndex& index) const override;
  void setModelData(QWidget* editor, QAbstractItemModel* model, const QModelIndex& index) const override;

 signals:
  void refused(const QString& why) const;
  void accepted() const;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void addCompleter(QLineEdit& edit, const QPersistentModelIndex& index) const;

  Check check_;
  Words words_;
  /// What was typed last and refused, and into which cell that had which text.
  mutable QPersistentModelIndex keptFor_;
  mutable QString kept_, keptOver_;
  mutable QPersistentModelIndex editing_;
};

}  // namespace trimtab::views
