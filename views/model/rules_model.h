// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "draft.h"
#include "rows_model.h"

namespace trimtab::views {

/// The rule base as a table: conditions, weight and output. The edit role of a condition is an index into
/// conditionsOf().
class RulesModel : public RowsModel {
  Q_OBJECT
 public:
  enum Column { kAltitude, kPitch, kWeight, kOutput, kColumns };
  explicit RulesModel(Draft& draft, QObject* parent = nullptr);

  /// Returns what the column of a condition offers; empty for other columns.
  static QStringList conditionsOf(int column);

  int columnCount(const QModelIndex& = {}) const override { return kColumns; }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;

 signals:
  void refused(const QString& why);
  void accepted();

 private:
  RuleList rules() const;
  bool put(const RuleList& rules);

  Draft& draft_;
};

}  // namespace trimtab::views
