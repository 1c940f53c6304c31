#include "trimtab/measure/lever_tally.h"

namespace trimtab {

void LeverTally::add(const LeverChain& chain) {
  ++images_;
  for (std::size_t i = 0; i < kFrameLeverRows.size(); ++i) {
    const FrameLeverRow& row = kFrameLeverRows[i];
    ++changed_[i][static_cast<std::size_t>(lastChange(chain, row))];
    asked_[i] += valueOf(chain.policy, row);
    drawn_[i] += valueOf(chain.drawn, row);
  }
}

}  // namespace trimtab
