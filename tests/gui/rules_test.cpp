// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAction>
#include <QDockWidget>
#include <QTableView>
#include <QTemporaryDir>
#include <QToolButton>
#include <cstdlib>

#include "gui_support.h"
#include "trimtab/host/flight.h"
#include "views/controls/parameter_line.h"
#include "views/controls/parameter_table.h"
#include "views/editors/rule_viewer.h"
#include "views/editors/rules_editor.h"
#include "views/model/rules_model.h"
#include "views/panels/rules_panel.h"
#include "views/plots/surface_plot.h"
#include "views/policy/policy_panel.h"
#include "views/policy/scheme_page.h"
#include "views/policy/signals_list.h"

namespace trimtab::test {
namespace {

class Rules : public Bench {
 protected:
  views::PolicyPanel& policy() { return *w().panels().policy; }
  views::SchemePage& scheme() { return *policy().parts().scheme; }
  views::RulesPanel& panel() { return scheme().rules(); }
  views::SurfacePlot& surface() { return scheme().surface(); }
  QDockWidget& dock(const char* name) { return *w().dock(QString::fromLatin1(name)); }
  void type(int row, int column, const char* text) {
    QAbstractItemModel* const model = panel().editor().table().model();
    EXPECT_TRUE(model->setData(model->index(row, column), QString::fromLatin1(text), Qt::EditRole));
  }
  /// Saves a screenshot to look at if TRIMTAB_SHOTS names a folder.
  void shoot(const char* name) {
    const char* folder = std::getenv("TRIMTAB_SHOTS");
    if (folder == nullptr) return;
    QTest::qWait(300);
    w().grab().save(QStringLiteral("%1/%2.png").arg(QLatin1String(folder), QLatin1String(name)));
  }
};

TEST_F(Rules, anEditedRuleDecidesTheNextFrameAndTheViewerShowsIt) {
  dock("policy").raise();
  policy().showEditorOf("fuzzy.rules");
  w().draft().setValue("fuzzy.combination", ChoiceIndex{2});
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  const double climb = climbsThrough(*readFlight(sampleFlight()), 4500);
  for (int second = 0; second < 40; second += 2) {
    w().feed().seekHere(climb + second);
    const std::uint64_t before = paints();
    ASSERT_TRUE(waitFor([&] { return paints() > before; }));
  }
  EXPECT_GT(surface().track().size(), 10u);
  ASSERT_TRUE(waitFor([this] { return panel().viewer().lines().size() == 5; }));
  for (int rule = 0; rule < 4; ++rule) type(rule, views::RulesModel::kOutput, "0.75");
  EXPECT_TRUE(waitFor([this] { return std::abs(session().decision().totalMembership - 0.75) < 1e-12; }));
  EXPECT_TRUE(waitFor([this] { return panel().viewer().lines().last() == QStringLiteral("Total 0.750"); }));
  shoot("rules");
  scheme().showSurface();
  shoot("surface");
  w().draft().undoStack().undo();
  EXPECT_EQ(w().draft().parameters().scheme.rules.rule[3].output, 0);
}

TEST_F(Rules, thePresetDockLeadsToTheEditorOfAList) {
  auto* const parameters = w().findChild<views::ParameterTable*>();
  dock("preset").raise();
  for (const auto& [key, name] : {std::pair{"fuzzy.rules", "policy"},
                                  {"fuzzy.bands_px", "culling"},
                                  {"fuzzy.pitch.curve_deg", "policy"},
                                  {"policy.terms", "policy"}}) {
    parameters->line(key)->editor()->parentWidget()->findChild<QToolButton*>()->click();
    EXPECT_TRUE(waitFor([&] { return !dock(name).visibleRegion().isEmpty(); })) << key;
  }
  EXPECT_TRUE(policy().parts().signalsList->chosen()) << "policy.terms leads to a signal's terms";
}

TEST_F(Rules, filesComeAndGo) {
  const QTemporaryDir dir;
  const QString file = dir.filePath(QStringLiteral("rules.fll"));
  w().draft().setText("fuzzy.rules", "low*1=1.5 high*1=0.5");
  EXPECT_TRUE(panel().exportFile(file).empty());
  w().draft().resetAll();
  EXPECT_TRUE(panel().importFile(file).empty());
  EXPECT_EQ(w().draft().active()->scheme.combination, Combination::rules);
  EXPECT_EQ(w().draft().active()->scheme.rules.size, 2u);
  int found = 0;
  for (const QAction* action : commands())
    found += action->text().remove(QLatin1Char('&')).endsWith(QStringLiteral("port rules..."));
  EXPECT_EQ(found, 2);
}

}  // namespace
}  // namespace trimtab::test
