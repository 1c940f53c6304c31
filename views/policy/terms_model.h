// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "policy_draft.h"
#include "policy_live.h"
#include "views/model/rows_model.h"

namespace trimtab::views {

/// The terms of one signal as a table: name, shape, numbers and live membership. Lines that cannot be read
/// follow, whatever signal they are about, so that they can be removed.
class TermsModel : public RowsModel {
  Q_OBJECT
 public:
  enum Column { kName, kShape, kNumbers, kNow, kColumns };
  explicit TermsModel(PolicyDraft& policy, QObject* parent = nullptr);

  void setSignal(Signal signal);
  Signal signal() const { return signal_; }
  /// Returns the line in the draft of a row, and the row of a line; -1 for none.
  int lineOf(int row) const;
  int rowOfLine(int line) const;
  /// Returns why a text is refused in a cell; empty if it is taken.
  QString refusal(const QModelIndex& index, const QString& text) const;
  void showLive(const PolicyLive& live);

  int columnCount(const QModelIndex& = {}) const override { return kColumns; }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;

 private:
  void refresh();
  const PolicyDraft::TermLine& lineAt(int row) const;
  std::optional<PolicyTerm> changed(const QModelIndex& index, const QString& text, QString& why) const;

  PolicyDraft& policy_;
  Signal signal_ = Signal::altitude;
  std::vector<std::size_t> lines_;
  std::vector<double> memberships_;  ///< by row, in steps that a bar shows; NaN: unknown
};

}  // namespace trimtab::views
