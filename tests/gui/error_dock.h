// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "app/workbench/docks/error_dock.h"
#include "gui_support.h"

namespace trimtab::test {

/// The window with the dock of run time against error.
class ErrorDock : public Bench {
 protected:
  workbench::ErrorDock& dock() { return w().controllers().errors->dock(); }
  void raise() {
    w().dock("errors")->show();
    w().dock("errors")->raise();
    ASSERT_TRUE(waitFor([&] { return !dock().liveSwitch().isChecked() || dock().live().isOn(); }));
  }
  std::uint64_t measurements() { return dock().live().measurements(); }
  bool measured(std::uint64_t more = 1) {
    const std::uint64_t before = measurements();
    return waitFor([&] { return measurements() >= before + more; }, 90000);
  }
  /// Whether nothing is measured for longer than the pause between two measurements: a second, or four times
  /// as long as the last one took.
  bool rests() {
    const auto& last = dock().lastMeasured();
    const int pauseMs = std::max(1000, last ? int(4 * last->tookMs) : 0);
    const std::uint64_t before = measurements();
    return !waitFor([&] { return dock().live().busy() || measurements() > before; }, pauseMs + 300);
  }
};

}  // namespace trimtab::test
