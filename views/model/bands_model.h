// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "draft.h"
#include "rows_model.h"
#include "views/editors/band_edit.h"

namespace trimtab::views {

/// The bands as a table of typed values: lower edge, upper edge (that of the next band, read only), width and
/// height.
class BandsModel : public RowsModel {
  Q_OBJECT
 public:
  enum Column { kFrom, kTo, kWidth, kHeight, kColumns };
  explicit BandsModel(Draft& draft, QObject* parent = nullptr);

  int columnCount(const QModelIndex& = {}) const override { return kColumns; }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;
  /// Shows the band of the last decision in bold; -1 for none.
  void setLiveBand(int band);

 signals:
  void refused(const QString& why);
  void accepted();

 private:
  BandList bands() const;
  void refresh();

  Draft& draft_;
  int liveBand_ = -1;
};

}  // namespace trimtab::views
