// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "draft.h"
#include "rows_model.h"

namespace trimtab::views {

/// The steps of the undo stack as a table: what was changed, from what to what, and when. Row 0 is the preset
/// as it was opened, row N the draft after N steps; rows after the current one are undone steps.
class ChangesModel : public RowsModel {
  Q_OBJECT
 public:
  enum Column { kWhat, kBefore, kAfter, kWhen };

  explicit ChangesModel(Draft& draft, QObject* parent = nullptr);

  int columnCount(const QModelIndex& = {}) const override { return kWhen + 1; }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  /// Returns the row whose values the draft has.
  int currentRow() const { return draft_.undoStack().index(); }
  /// Returns these rows as lines with tabs, below a line of titles.
  QString toText(const QList<int>& rows) const;

 private:
  void follow();
  QString cell(int row, int column) const;

  Draft& draft_;
};

}  // namespace trimtab::views
