// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rows_model.h"
#include "terrain_summary.h"
#include "trimtab/frame/terrain_frame.h"

namespace trimtab::views {

/// The levels of a terrain as a table, with how many nodes of each the last image drew.
class TerrainLevelsModel : public RowsModel {
  Q_OBJECT
 public:
  enum Column { kLevel, kNodes, kTriangles, kMaxError, kRmsError, kSurfaceError, kSize, kDrawn, kColumns };
  using RowsModel::RowsModel;

  /// `finestFirst` says that level 0 is the finest, as it is for tiles.
  void setLevels(std::vector<TerrainLevel> levels, bool finestFirst);
  void setDrawn(const LevelsFrame& drawn);

  int columnCount(const QModelIndex& parent = {}) const override { return parent.isValid() ? 0 : kColumns; }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  QString text(const TerrainLevel& level, std::size_t number, int column) const;

  std::vector<TerrainLevel> levels_;
  LevelsFrame drawn_;
  bool finestFirst_ = true;
};

}  // namespace trimtab::views
