// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTableWidget>

#include "trimtab/frame/frame_levers.h"

namespace trimtab::views {

/// The chain of the levers: a row for each lever, with what is drawn and with who changed it to what.
class LeverChainTable : public QTableWidget {
  Q_OBJECT
 public:
  enum Column { kDrawn, kChain, kColumns };

  explicit LeverChainTable(QWidget* parent = nullptr);
  /// Shows a chain. A column's header says why its step did what it did: `reasons`, in the order of the
  /// steps.
  void showChain(const LeverChain& chain, const std::array<QString, kLeverSteps>& reasons);
};

}  // namespace trimtab::views
