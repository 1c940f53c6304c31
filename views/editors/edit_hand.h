// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Qt>
#include <optional>

#include "views/model/draft.h"

class QKeyEvent;

namespace trimtab::views {

/// Keeps which one of a row of things is selected, such as the points of a curve or the edges of bands, and
/// makes a drag, or a key held down, one undo step.
class EditHand {
 public:
  explicit EditHand(Draft& draft) : draft_(draft) {}

  int selected() const { return selected_; }  ///< -1 if none is
  /// Selects one of `count`, or none for -1, and returns whether that is another than before.
  bool select(int index, int count);
  /// Returns the neighbour that Tab or Shift+Tab goes to; nothing if the focus goes on to another widget.
  std::optional<int> tabbedTo(bool forward, int count) const;
  /// Returns the one at which Tab or Shift+Tab enters the widget; nothing for any other reason.
  static std::optional<int> enteredAt(Qt::FocusReason reason, int count);

  void beginDrag() { drag_ = draft_.newToken(); }
  bool dragging() const { return drag_ != 0; }
  MergeToken drag() const { return drag_; }
  /// Ends the drag and returns its token, with which an edit can still take it back.
  MergeToken endDrag();

  /// Returns the token of the key that is held down.
  MergeToken nudge();
  void endNudge() { nudge_ = 0; }
  void keyReleased(const QKeyEvent& event);

  enum class Command { none, type, add, remove, cancel };
  /// Returns what a key other than an arrow asks for in all such editors.
  static Command commandOf(const QKeyEvent& event);

 private:
  Draft& draft_;
  int selected_ = -1;
  MergeToken drag_ = 0, nudge_ = 0;  ///< 0: neither
};

}  // namespace trimtab::views
