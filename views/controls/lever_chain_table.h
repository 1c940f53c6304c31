// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QTableWidget>

#include "trimtab/frame/frame_levers.h"

namespace trimtab {
struct IgProfile;
}

namespace trimtab::views {

/// The chain of the levers: a row for each lever, with what is drawn and with who changed it to what.
class LeverChainTable : public QTableWidget {
  Q_OBJECT
 public:
  enum Column { kDrawn, kChain, kColumns };

  explicit LeverChainTable(QWidget* parent = nullptr);
  /// Shows a chain. The tip of a row says why the step that changed the lever last did so. `reasons` has one
  /// reason for each step, in their order.
  void showChain(const LeverChain& chain, const std::array<QString, kLeverSteps>& reasons,
                 const IgProfile* ig);
};

/// Makes the rows of a table of kFrameLeverRows grey whose lever the image generator does not have, and says
/// so in their tips. The tips of the others end with what it sets.
void showWhatIgHas(QTableWidget& table, const LeverChain& chain, const IgProfile* ig);

}  // namespace trimtab::views
