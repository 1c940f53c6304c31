// SPDX-License-Identifier: GPL-3.0-or-later
#include "edit_hand.h"

#include <QKeyEvent>
#include <algorithm>
#include <utility>

namespace trimtab::views {

bool EditHand::select(int index, int count) {
  const int before = std::exchange(selected_, std::clamp(index, -1, count - 1));
  return selected_ != before;
}

std::optional<int> EditHand::tabbedTo(bool forward, int count) const {
  const int to = selected_ + (forward ? 1 : -1);
  if (to < 0 || to >= count) return std::nullopt;
  return to;
}

std::optional<int> EditHand::enteredAt(Qt::FocusReason reason, int count) {
  if (reason == Qt::TabFocusReason) return 0;
  if (reason == Qt::BacktabFocusReason) return count - 1;
  return std::nullopt;
}

MergeToken EditHand::endDrag() {
  return std::exchange(drag_, 0);
}

MergeToken EditHand::nudge() {
  if (nudge_ == 0) nudge_ = draft_.newToken();
  return nudge_;
}

void EditHand::keyReleased(const QKeyEvent& event) {
  if (!event.isAutoRepeat()) endNudge();
}

EditHand::Command EditHand::commandOf(const QKeyEvent& event) {
  switch (event.key()) {
    case Qt::Key_Return:
    case Qt::Key_Enter:
      return Command::type;
    case Qt::Key_Insert:
      return Command::add;
    case Qt::Key_Delete:
    case Qt::Key_Backspace:
      return Command::remove;
    case Qt::Key_Escape:
      return Command::cancel;
    default:
      return Command::none;
  }
}

}  // namespace trimtab::views
