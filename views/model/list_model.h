// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "draft.h"
#include "rows_model.h"

namespace trimtab::views {

/// A column of numbers in the table of a list parameter.
struct ListColumn {
  QString title;
  QString unit;      ///< that may be typed after a number
  int decimals = 0;  ///< that are shown at most
  std::function<double(const ParameterValue& list, std::size_t row)> number;
  /// Puts a typed number into a row, and returns why it may not stand there; empty if it may. If unset, the
  /// column is read only.
  std::function<QString(ParameterValue& list, std::size_t row, double typed)> put;
};

/// Describes the points of a curve, or bands, as a table.
struct ListTable {
  std::string_view key;  ///< of the parameter that holds the list
  std::vector<ListColumn> columns;
  std::string_view readingKey = {};  ///< of the parameter that decides whether the list is used; may be empty
  /// Reports whether the list is used, so that it may be edited. If unset, it always is.
  bool (*isUsed)(const TuningParameters&) = nullptr;
};

/// A list parameter as a table of typed numbers, one row per point or band. A typed text is refused, with the
/// reason, or becomes one edit of the draft.
class ListModel : public RowsModel {
  Q_OBJECT
 public:
  ListModel(Draft& draft, ListTable table, QObject* parent = nullptr);

  int columnCount(const QModelIndex& = {}) const override { return static_cast<int>(table_.columns.size()); }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;
  /// Shows the row that the last decision used in bold; -1 for none.
  void setLiveRow(int row);

 signals:
  void refused(const QString& why);
  void accepted();

 private:
  const ListColumn& columnOf(const QModelIndex& index) const {
    return table_.columns[static_cast<std::size_t>(index.column())];
  }
  void refresh();

  Draft& draft_;
  ListTable table_;
  int liveRow_ = -1;
};

}  // namespace trimtab::views
