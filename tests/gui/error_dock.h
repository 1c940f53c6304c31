// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

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
};

}  // namespace trimtab::test
