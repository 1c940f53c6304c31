// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QAbstractTableModel>
#include <QTableView>
#include <vector>

#include "policy_live.h"

namespace trimtab::views {

/// What each rule of the active policy does in the last frame: how far it fires, and its share in each lever
/// that the policy sets.
class SharesModel : public QAbstractTableModel {
  Q_OBJECT
 public:
  enum Column { kRule, kFires, kFirstLever };
  using QAbstractTableModel::QAbstractTableModel;
  void showLive(const PolicyLive& live);

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& = {}) const override {
    return kFirstLever + static_cast<int>(levers_.size());
  }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  struct Row {
    QString rule;
    bool counts = false;           ///< whether the rule is switched on
    std::vector<double> values;    ///< firing, then shares; NaN: the rule does not set the lever
    std::vector<double> settings;  ///< of each lever; NaN: none
  };
  void rebuild(const PolicyLive& live);

  Policy policy_;
  std::vector<Lever> levers_;
  QStringList lacks_;  ///< why the image generator does not follow a lever of `levers_`; empty if it does
  std::vector<Row> rows_;
};

/// The rule viewer.
class SharesView : public QTableView {
  Q_OBJECT
 public:
  explicit SharesView(QWidget* parent = nullptr);
  void showLive(const PolicyLive& live);

 private:
  SharesModel* model_;
};

}  // namespace trimtab::views
