// SPDX-License-Identifier: GPL-3.0-or-later
#include "bands_model.h"

#include <QFont>
#include <cmath>

#include "keys.h"
#include "theme.h"

namespace trimtab::views {

BandsModel::BandsModel(Draft& draft, QObject* parent) : RowsModel(parent), draft_(draft) {
  refresh();
  connect(&draft_, &Draft::valueChanged, this, [this](const QString& key) {
    if (key.toStdString() == key::kBands) refresh();
  });
}

BandList BandsModel::bands() const {
  return std::get<BandList>(draft_.value(key::kBands));
}

void BandsModel::refresh() {
  refreshRows(static_cast<int>(bands().size));
}

void BandsModel::setLiveBand(int band) {
  if (band == liveBand_) return;
  liveBand_ = band;
  if (rows() > 0) emit dataChanged(index(0, 0), index(rows() - 1, kColumns - 1), {Qt::FontRole});
}

QVariant BandsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const BandList list = bands();
  const std::size_t row = static_cast<std::size_t>(index.row());
  const Band& band = list.band[row];
  if (role == Qt::DisplayRole || role == Qt::EditRole) {
    switch (index.column()) {
      case kFrom:
        return numberText(band.low, 6);
      case kTo:
        return numberText(highOf(list, row), 6);
      case kWidth:
        return numberText(band.widthPx, 0);
      default:
        return numberText(band.heightPx, 0);
    }
  }
  if (role == Qt::TextAlignmentRole) return QVariant(Qt::AlignRight | Qt::AlignVCenter);
  if (role == Qt::FontRole && index.row() == liveBand_) {
    QFont bold;
    bold.setBold(true);
    return bold;
  }
  return {};
}

QVariant BandsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (role != Qt::DisplayRole) return {};
  if (orientation == Qt::Vertical) return section + 1;
  switch (section) {
    case kFrom:
      return tr("From");
    case kTo:
      return tr("Below");
    case kWidth:
      return tr("Width (px)");
    default:
      return tr("Height (px)");
  }
}

Qt::ItemFlags BandsModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  flags.setFlag(Qt::ItemIsEditable, index.column() != kTo);
  return flags;
}

bool BandsModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || !index.isValid() || index.column() == kTo) return false;
  const auto refuse = [&](const QString& why) {
    emit refused(why);
    return false;
  };
  const bool isEdge = index.column() == kFrom;
  const QString text = value.toString();
  const std::optional<double> number = parseNumber(text, isEdge ? QString() : QStringLiteral("px"));
  if (!number) return refuse(tr("“%1” is not a number.").arg(text));

  BandList changed = bands();
  const std::size_t row = static_cast<std::size_t>(index.row());
  if (isEdge) {
    const Range free = freeEdgeRange(changed, row);
    if (*number < free.low || *number > free.high)
      return refuse(tr("%1 is not between the neighbours: %2 to %3.")
                        .arg(numberText(*number, 6), numberText(free.low, 6), numberText(free.high, 6)));
    changed.band[row].low = *number;
  } else {
    const Range hard = findRow(key::kBands)->hard;
    if (!(*number >= hard.low && *number <= hard.high) || *number != std::floor(*number))
      return refuse(tr("A size is a whole number from %1 to %2 px, not %3.")
                        .arg(numberText(hard.low, 0), numberText(hard.high, 0), text));
    (index.column() == kWidth ? changed.band[row].widthPx : changed.band[row].heightPx) =
        static_cast<int>(*number);
  }
  if (const Findings findings = draft_.setValue(key::kBands, changed); !findings.empty())
    return refuse(QString::fromStdString(toString(findings)));
  emit accepted();
  return true;
}

}  // namespace trimtab::views
