// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTableWidget>

#include "trimtab/frame/frame_levers.h"

namespace trimtab::views {

/// The chain of the levers: a row a lever, a column a step. A cell is empty where the step left the lever as
/// it was; the last column is what is drawn.
class LeverChainTable : public QTableWidget {
  Q_OBJECT
 public:
  explicit LeverChainTable(QWidget* parent = nullptr);
  /// Shows a chain. A column's header says why its step did what it did: `reasons`, in the order of the
  /// steps.
  void showChain(const LeverChain& chain, const std::array<QString, kLeverSteps>& reasons);
};

}  // namespace trimtab::views
