// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QPointF>
#include <Qt>
#include <optional>
#include <set>
#include <vector>

#include "views/model/draft.h"

class QKeyEvent;

namespace trimtab::views {

/// Keeps which of a row of things are selected, such as the points of a curve or the edges of bands, and
/// makes a drag, or a key held down, one undo step. Tables and descriptions follow one of those that are
/// selected; the others move and go with it.
class EditHand {
 public:
  explicit EditHand(Draft& draft) : draft_(draft) {}

  int selected() const { return selected_; }  ///< the one that is followed; -1 if none is selected
  /// Selects one of `count` alone, or none for -1, and returns whether the selection was another before.
  bool select(int index, int count);
  bool isSelected(int index) const { return index >= 0 && (index == selected_ || beside_.contains(index)); }
  /// Makes another one the one that is followed; all that are selected stay so.
  void follow(int index);
  /// Adds one to the selection, or takes it out.
  void toggle(int index);
  /// Selects all of `count`.
  void selectAll(int count);
  /// Selects these, beside those that are selected with `add`.
  void selectThese(const std::vector<int>& indexes, bool add);
  /// Returns those of the first `count` that are selected, in rising order.
  std::vector<std::size_t> group(int count) const;
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
  /// Reports whether a drag goes on, or a key is held down.
  bool moving() const { return drag_ != 0 || nudge_ != 0; }
  void keyReleased(const QKeyEvent& event);

  /// Returns where a drag ends that keeps to one axis, the one along which it has gone farther on the screen.
  static QPointF straightened(QPointF from, QPointF to, QPointF gonePx);

  enum class Command { none, type, add, remove, cancel };
  /// Returns what a key other than an arrow asks for in all such editors.
  static Command commandOf(const QKeyEvent& event);

 private:
  Draft& draft_;
  int selected_ = -1;
  std::set<int> beside_;             ///< the others that are selected
  MergeToken drag_ = 0, nudge_ = 0;  ///< 0: neither
};

}  // namespace trimtab::views
