// SPDX-License-Identifier: GPL-3.0-or-later
#include "list_model.h"

#include <QFont>

#include "theme.h"

namespace trimtab::views {
namespace {

std::size_t sizeOf(const ParameterValue& list) {
  if (const auto* bands = std::get_if<BandList>(&list)) return bands->size;
  return std::get<CurvePoints>(list).size;
}

}  // namespace

ListModel::ListModel(Draft& draft, ListTable table, QObject* parent)
    : RowsModel(parent), draft_(draft), table_(std::move(table)) {
  refresh();
  connect(&draft_, &Draft::valueChanged, this, [this](const QString& key) {
    if (key.toStdString() == table_.key || key.toStdString() == table_.readingKey) refresh();
  });
}

void ListModel::refresh() {
  refreshRows(static_cast<int>(sizeOf(draft_.value(table_.key))));
}

void ListModel::setLiveRow(int row) {
  if (row == liveRow_) return;
  liveRow_ = row;
  if (rows() > 0) emit dataChanged(index(0, 0), index(rows() - 1, columnCount() - 1), {Qt::FontRole});
}

QVariant ListModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const ListColumn& column = columnOf(index);
  switch (role) {
    case Qt::DisplayRole:
    case Qt::EditRole:
      return numberText(column.number(draft_.value(table_.key), static_cast<std::size_t>(index.row())),
                        column.decimals);
    case Qt::AccessibleTextRole:
      return QStringLiteral("%1 %2").arg(column.title, data(index, Qt::DisplayRole).toString());
    case Qt::TextAlignmentRole:
      return QVariant(Qt::AlignRight | Qt::AlignVCenter);
    case Qt::FontRole: {
      if (index.row() != liveRow_) return {};
      QFont bold;
      bold.setBold(true);
      return bold;
    }
    default:
      return {};
  }
}

QVariant ListModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (role != Qt::DisplayRole) return {};
  if (orientation == Qt::Vertical) return section + 1;
  return table_.columns[static_cast<std::size_t>(section)].title;
}

Qt::ItemFlags ListModel::flags(const QModelIndex& index) const {
  const bool used = table_.isUsed == nullptr || table_.isUsed(draft_.parameters());
  Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  flags.setFlag(Qt::ItemIsEnabled, used);
  flags.setFlag(Qt::ItemIsEditable, used && index.isValid() && columnOf(index).put);
  return flags;
}

bool ListModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || !index.isValid() || !columnOf(index).put) return false;
  const ListColumn& column = columnOf(index);
  const QString text = value.toString();
  QString why;
  if (const std::optional<double> number = parseNumber(text, column.unit)) {
    ParameterValue changed = draft_.value(table_.key);
    why = column.put(changed, static_cast<std::size_t>(index.row()), *number);
    if (why.isEmpty()) why = QString::fromStdString(toString(draft_.setValue(table_.key, changed)));
  } else {
    why = tr("“%1” is not a number.").arg(text);
  }
  if (why.isEmpty())
    emit accepted();
  else
    emit refused(why);
  return why.isEmpty();
}

}  // namespace trimtab::views
