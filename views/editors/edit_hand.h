// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Qt>
#include <optional>

#include "views/model/draft.h"

class QKeyEvent;

namespace trimtab::views {

/// What hand and keys do to a row of things that are edited one at a time, such as the points of a curve or
/// the edges of bands: one of them is selected, a drag is one undo step, and so is a key held down.
class EditHand {
 public:
  explicit EditHand(Draft& draft) : draft_(draft) {}

  int selected() const { return selected_; }  ///< -1: none
  /// Selects one of `count`, or none for -1, and returns whether that is another than before.
  bool select(int index, int count);
  /// The neighbour that Tab or Shift+Tab goes to; nothing if the focus moves on to another widget.
  std::optional<int> tabbedTo(bool forward, int count) const;
  /// The one that the focus enters at; nothing if it comes by other ways than Tab.
  static std::optional<int> enteredAt(Qt::FocusReason reason, int count);

  void beginDrag() { drag_ = draft_.newToken(); }
  bool dragging() const { return drag_ != 0; }
  MergeToken drag() const { return drag_; }
  /// Ends the drag and returns its token, with which an edit can still take it back.
  MergeToken endDrag();

  /// The token of the key that is held down.
  MergeToken nudge();
  void endNudge() { nudge_ = 0; }
  void keyReleased(const QKeyEvent& event);

  enum class Command { none, type, add, remove, cancel };
  /// What a key asks for, beside the arrows, that all such editors have in common.
  static Command commandOf(const QKeyEvent& event);

 private:
  Draft& draft_;
  int selected_ = -1;
  MergeToken drag_ = 0, nudge_ = 0;  ///< 0: neither
};

}  // namespace trimtab::views
