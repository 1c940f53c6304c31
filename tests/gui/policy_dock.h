// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QDockWidget>
#include <QTabWidget>

#include "gui_support.h"
#include "tests/views/policy/policy_flight.h"
#include "views/policy/levers_view.h"
#include "views/policy/policy_panel.h"
#include "views/policy/signals_list.h"
#include "views/policy/term_plot.h"

namespace trimtab::test {

/// The dock Policy in the real window.
class PolicyDock : public Bench {
 protected:
  views::PolicyPanel& panel() { return *w().panels().policy; }
  const views::PolicyPanel::Parts& parts() { return panel().parts(); }
  double lever(Lever which) { return session().decision().policy[which]; }
  double requestedErrorPx() { return w().controllers().frame->shown()->levers.drawn.errorPx; }
  void setPolicy(const std::vector<std::string>& terms, const std::vector<std::string>& rules) {
    test::setPolicy(w().draft(), terms, rules);
    ASSERT_FALSE(w().draft().isBroken()) << toString(w().draft().findings());
  }
};

}  // namespace trimtab::test
