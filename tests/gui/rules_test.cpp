// SPDX-License-Identifier: GPL-3.0-or-later
#include <QDockWidget>
#include <QToolButton>

#include "gui_support.h"
#include "views/controls/parameter_line.h"
#include "views/controls/parameter_table.h"
#include "views/policy/policy_panel.h"
#include "views/policy/signals_list.h"

namespace trimtab::test {
namespace {

class Rules : public Bench {
 protected:
  views::PolicyPanel& policy() { return *w().panels().policy; }
  QDockWidget& dock(const char* name) { return *w().dock(QString::fromLatin1(name)); }
};

TEST_F(Rules, thePresetDockLeadsToTheEditorOfAList) {
  auto* const parameters = w().findChild<views::ParameterTable*>();
  dock("preset").raise();
  for (const auto& [key, name] : {std::pair{"fuzzy.bands_px", "culling"},
                                  {"fuzzy.pitch.curve_deg", "policy"},
                                  {"policy.terms", "policy"}}) {
    parameters->line(key)->editor()->parentWidget()->findChild<QToolButton*>()->click();
    EXPECT_TRUE(waitFor([&] { return !dock(name).visibleRegion().isEmpty(); })) << key;
  }
  EXPECT_TRUE(policy().parts().signalsList->chosen()) << "policy.terms leads to a signal's terms";
}

}  // namespace
}  // namespace trimtab::test
