// SPDX-License-Identifier: GPL-3.0-or-later
#include "changes_model.h"

#include <QFont>
#include <QGuiApplication>
#include <QLocale>
#include <QPalette>
#include <QStringList>

#include "views/model/theme.h"
#include "views/model/value_text.h"

namespace trimtab::views {

ChangesModel::ChangesModel(Draft& draft, QObject* parent) : RowsModel(parent), draft_(draft) {
  follow();
  connect(&draft_.undoStack(), &QUndoStack::indexChanged, this, &ChangesModel::follow);
  connect(&draft_, &Draft::referencesChanged, this, &ChangesModel::follow);
}

/// A step after an undo replaces all that were undone, so the count alone does not say which rows are new:
/// the view asks for all of them again, which costs only those in sight.
void ChangesModel::follow() {
  refreshRows(draft_.undoStack().count() + 1);
}

QString ChangesModel::cell(int row, int column) const {
  const bool saved = row == draft_.undoStack().cleanIndex();
  if (row == 0) {
    if (column != kWhat) return {};
    return saved ? tr("As opened") : tr("As opened, before it was saved");
  }
  const Step step = draft_.step(row - 1);
  if (column == kWhen) return QLocale().toString(step.when.time(), QStringLiteral("HH:mm:ss"));
  const bool one = step.changes.size() == 1;
  if (column == kWhat) {
    const QString text = one ? fromView(step.changes.front().row->label)
                             : tr("%1 (%2 parameters)").arg(step.text, QString::number(step.changes.size()));
    return saved ? tr("%1, saved").arg(text) : text;
  }
  QStringList texts;
  for (const Change& change : step.changes) {
    const BeforeAfter both = changeText(change);
    const QString& text = column == kBefore ? both.before : both.after;
    texts << (one ? text : tr("%1 %2").arg(fromView(change.row->label), text));
  }
  return texts.join(QStringLiteral("; "));
}

QVariant ChangesModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rows()) return {};
  const int row = index.row();
  switch (role) {
    case Qt::DisplayRole:
      return cell(row, index.column());
    case Qt::ToolTipRole: {
      if (row == 0) return tr("A click goes back to the preset as it was opened.");
      const Step step = draft_.step(row - 1);
      return step.text + QLatin1Char('\n') + stepText(step);
    }
    case Qt::FontRole: {
      QFont font;
      font.setBold(row == currentRow());
      return font;
    }
    case Qt::ForegroundRole:
      return row > currentRow() ? QVariant(quietColour(QGuiApplication::palette())) : QVariant();
    default:
      return {};
  }
}

QVariant ChangesModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (role == Qt::TextAlignmentRole) return QVariant(Qt::AlignLeft | Qt::AlignVCenter);
  if (role != Qt::DisplayRole || orientation != Qt::Horizontal) return {};
  const QStringList titles{tr("What"), tr("Before"), tr("After"), tr("When")};
  return titles.at(section);
}

QString ChangesModel::toText(const QList<int>& rows) const {
  QString text = QStringLiteral("what\tbefore\tafter\twhen\n");
  for (const int row : rows) {
    QStringList cells;
    for (int column = 0; column <= kWhen; ++column) cells << cell(row, column);
    text += cells.join(QLatin1Char('\t')) + QLatin1Char('\n');
  }
  return text;
}

}  // namespace trimtab::views
