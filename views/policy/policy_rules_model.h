// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "policy_draft.h"
#include "policy_live.h"
#include "views/model/rows_model.h"

namespace trimtab::views {

/// The rules of a policy as a table, a row for each line of the draft. A line that cannot be read is shown as
/// text in the column of conditions, where a whole rule may be typed.
class PolicyRulesModel : public RowsModel {
  Q_OBJECT
 public:
  enum Column { kOn, kCondition, kSettings, kWeight, kFires, kReason, kColumns };
  explicit PolicyRulesModel(PolicyDraft& policy, QObject* parent = nullptr);

  /// Returns why a text is refused in a cell; empty if it is taken.
  QString refusal(const QModelIndex& index, const QString& text) const;
  void showLive(const PolicyLive& live);

  int columnCount(const QModelIndex& = {}) const override { return kColumns; }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;
  Qt::DropActions supportedDropActions() const override { return Qt::MoveAction; }
  QStringList mimeTypes() const override;
  QMimeData* mimeData(const QModelIndexList& indexes) const override;
  bool dropMimeData(const QMimeData* data, Qt::DropAction action, int row, int column,
                    const QModelIndex& parent) override;

 signals:
  void moved(int to);  ///< a row was dropped

 private:
  void refresh();
  QVariant text(const PolicyDraft::RuleLine& line, int column, double firing) const;
  std::optional<PolicyRule> changed(const QModelIndex& index, const QString& text, QString& why) const;

  PolicyDraft& policy_;
  std::vector<double> firing_;  ///< by row, in steps that a bar shows; NaN: unknown
  std::vector<bool> broken_;    ///< by row
};

/// Returns the settings of a rule as text, "screen_space_error = 4, far_distance = 0.8".
QString settingsText(const PolicyRule& rule);

}  // namespace trimtab::views
