// SPDX-License-Identifier: GPL-3.0-or-later
#include "edit_hand.h"

#include <QKeyEvent>
#include <algorithm>
#include <cmath>
#include <utility>

namespace trimtab::views {

bool EditHand::select(int index, int count) {
  const int before = std::exchange(selected_, std::clamp(index, -1, count - 1));
  const bool alone = std::exchange(beside_, {}).empty();
  return selected_ != before || !alone;
}

void EditHand::follow(int index) {
  if (selected_ >= 0) beside_.insert(selected_);
  beside_.erase(index);
  selected_ = index;
}

void EditHand::toggle(int index) {
  if (index == selected_)
    selected_ = beside_.empty() ? -1 : beside_.extract(beside_.begin()).value();
  else if (beside_.erase(index) == 0)
    follow(index);
}

void EditHand::selectAll(int count) {
  if (selected_ < 0 && count > 0) selected_ = 0;
  for (int i = 0; i < count; ++i)
    if (i != selected_) beside_.insert(i);
}

void EditHand::selectThese(const std::vector<int>& indexes, bool add) {
  if (!add) selected_ = -1, beside_.clear();
  for (const int i : indexes) {
    if (selected_ < 0)
      selected_ = i;
    else if (i != selected_)
      beside_.insert(i);
  }
}

std::vector<std::size_t> EditHand::group(int count) const {
  std::set<int> all = beside_;
  all.insert(selected_);
  return {all.lower_bound(0), all.lower_bound(count)};
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

QPointF EditHand::straightened(QPointF from, QPointF to, QPointF gonePx) {
  if (std::abs(gonePx.x()) > std::abs(gonePx.y())) return {to.x(), from.y()};
  return {from.x(), to.y()};
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
