// SPDX-License-Identifier: GPL-3.0-or-later
#include "curve_points_model.h"

#include <algorithm>

#include "theme.h"

namespace trimtab::views {

CurvePointsModel::CurvePointsModel(Draft& draft, CurveSpec spec, QObject* parent)
    : RowsModel(parent), draft_(draft), spec_(std::move(spec)) {
  refresh();
  connect(&draft_, &Draft::valueChanged, this, [this](const QString& key) {
    if (key.toStdString() == spec_.key || key.toStdString() == spec_.readingKey) refresh();
  });
}

CurvePoints CurvePointsModel::curve() const {
  return std::get<CurvePoints>(draft_.value(spec_.key));
}

void CurvePointsModel::refresh() {
  refreshRows(static_cast<int>(curve().size));
}

QVariant CurvePointsModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const CurvePoint p = curve().point[static_cast<std::size_t>(index.row())];
  const bool isX = index.column() == 0;
  switch (role) {
    case Qt::DisplayRole:
    case Qt::EditRole:
      return numberText(isX ? p.x : p.y, isX ? spec_.decimals + 3 : 6);
    case Qt::TextAlignmentRole:
      return QVariant(Qt::AlignRight | Qt::AlignVCenter);
    case Qt::AccessibleTextRole:
      return isX ? tr("%1 %2").arg(numberText(p.x, 3), spec_.unit)
                 : tr("membership %1").arg(numberText(p.y, 6));
    default:
      return {};
  }
}

QVariant CurvePointsModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (role != Qt::DisplayRole) return {};
  if (orientation == Qt::Vertical) return section + 1;
  return section == 0 ? tr("%1 (%2)").arg(spec_.quantity, spec_.unit) : tr("Membership");
}

Qt::ItemFlags CurvePointsModel::flags(const QModelIndex& index) const {
  Qt::ItemFlags flags = QAbstractTableModel::flags(index);
  flags.setFlag(Qt::ItemIsEditable, spec_.usesPoints(draft_.parameters()));
  flags.setFlag(Qt::ItemIsEnabled, spec_.usesPoints(draft_.parameters()));
  return flags;
}

bool CurvePointsModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  if (role != Qt::EditRole || !index.isValid()) return false;
  const QString text = value.toString();
  const auto refuse = [&](const QString& why) {
    emit refused(why);
    return false;
  };
  const bool isX = index.column() == 0;
  const std::optional<double> number = parseNumber(text, isX ? spec_.unit : QString());
  if (!number) return refuse(tr("“%1” is not a number.").arg(text));

  const std::size_t row = static_cast<std::size_t>(index.row());
  CurvePoints changed = curve();
  if (isX) {
    const Range typed = typedRange(changed, row, spec_);
    if (*number < typed.low || *number > typed.high)
      return refuse(
          tr("%1 %2 is not between the neighbours: %3 to %4 %2.")
              .arg(numberText(*number, 3), spec_.unit, numberText(typed.low, 3), numberText(typed.high, 3)));
    changed.point[row].x = *number;
    if (std::ranges::count(changed.span(), *number, &CurvePoint::x) > 2)
      return refuse(tr("Two points at %1 %2 are a step; a third there means nothing.")
                        .arg(numberText(*number, 3), spec_.unit));
  } else {
    if (*number < 0 || *number > 1)
      return refuse(tr("A membership is 0 to 1, not %1.").arg(numberText(*number, 6)));
    changed.point[row].y = *number;
  }
  if (const Findings findings = draft_.setValue(spec_.key, changed); !findings.empty())
    return refuse(QString::fromStdString(toString(findings)));
  emit accepted();
  return true;
}

}  // namespace trimtab::views
