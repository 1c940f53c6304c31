// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "draft.h"
#include "rows_model.h"
#include "views/editors/curve_edit.h"

namespace trimtab::views {

/// The breakpoints of a curve as a table of typed values: one row per point, with x and membership.
class CurvePointsModel : public RowsModel {
  Q_OBJECT
 public:
  CurvePointsModel(Draft& draft, CurveSpec spec, QObject* parent = nullptr);

  int columnCount(const QModelIndex& = {}) const override { return 2; }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  /// Refuses a text that is no number, and a value beyond a neighbour or outside 0..1; emits `refused` with
  /// the reason.
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;

 signals:
  void refused(const QString& why);
  void accepted();

 private:
  CurvePoints curve() const;
  void refresh();

  Draft& draft_;
  CurveSpec spec_;
};

}  // namespace trimtab::views
