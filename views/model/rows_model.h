// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QAbstractTableModel>

namespace trimtab::views {

/// A table that adds and removes rows at its end, so that a selection survives a drag that changes their
/// number.
class RowsModel : public QAbstractTableModel {
 public:
  using QAbstractTableModel::QAbstractTableModel;
  int rowCount(const QModelIndex& parent = {}) const override { return parent.isValid() ? 0 : rows_; }

 protected:
  /// Announces that the table has `now` rows, of which any cell may have changed.
  void refreshRows(int now) {
    if (now > rows_) {
      beginInsertRows({}, rows_, now - 1);
      rows_ = now;
      endInsertRows();
    } else if (now < rows_) {
      beginRemoveRows({}, now, rows_ - 1);
      rows_ = now;
      endRemoveRows();
    }
    if (rows_ > 0) emit dataChanged(index(0, 0), index(rows_ - 1, columnCount() - 1));
  }
  int rows() const { return rows_; }

 private:
  int rows_ = 0;
};

}  // namespace trimtab::views
