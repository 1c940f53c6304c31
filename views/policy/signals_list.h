// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QAbstractTableModel>
#include <QTableView>
#include <array>
#include <optional>

#include "policy_draft.h"
#include "policy_live.h"

namespace trimtab::views {

/// The scheme of documents A and B, then the signals, each with its live value and whether rules ask for it.
class SignalsModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  enum Column { kName, kValue, kColumns };
  static constexpr int kScheme = 0;  ///< the scheme's row

  explicit SignalsModel(PolicyDraft& policy, QObject* parent = nullptr);

  static int rowOfSignal(Signal signal) { return static_cast<int>(signal) + 1; }
  static std::optional<Signal> signalOfRow(int row);
  void showLive(const PolicyLive& live);
  /// Names signals as rules do, which takes less width, or as people do.
  void useKeys(bool keys);

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& = {}) const override { return kColumns; }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  QString toolTip(Signal signal) const;

  PolicyDraft& policy_;
  std::array<QString, kSignals> values_;  ///< empty: unknown
  std::array<bool, kSignals> used_{};
  bool seen_ = false, keys_ = false;
};

/// The list on the left of the dock.
class SignalsList : public QTableView {
  Q_OBJECT
 public:
  explicit SignalsList(PolicyDraft& policy, QWidget* parent = nullptr);
  void showLive(const PolicyLive& live) { model_->showLive(live); }
  /// Returns the chosen signal; nothing for the scheme.
  std::optional<Signal> chosen() const;
  void choose(std::optional<Signal> signal);
  /// Returns the width that shows every name, and every value if there are values.
  int wholeWidth() const;
  /// Shows names and values, or only the keys of signals, which need less width.
  void showValues(bool shown);
  /// Goes to the next signal whose name begins with what is typed; the mark before it does not count.
  void keyboardSearch(const QString& typed) override;

 signals:
  void chosenChanged();

 private:
  SignalsModel* model_;
};

}  // namespace trimtab::views
