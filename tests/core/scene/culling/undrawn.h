#pragma once

namespace trimtab::test {

/// While it lives, nothing is drawn into a viewport of that size: for frames of which only the visible set is
/// looked at. Maps of other sizes are drawn as ever. Functions of the program's own stand before GL's
/// (undrawn.cpp, to be linked); one at a time.
class Undrawn {
 public:
  Undrawn(int widthPx, int heightPx);
  ~Undrawn();
  Undrawn(const Undrawn&) = delete;
  Undrawn& operator=(const Undrawn&) = delete;

  /// Calls that were left out since the start.
  static unsigned long calls();
};

}  // namespace trimtab::test
