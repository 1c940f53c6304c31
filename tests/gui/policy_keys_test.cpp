// SPDX-License-Identifier: GPL-3.0-or-later
#include <QApplication>
#include <QComboBox>
#include <QLineEdit>
#include <QTableView>
#include <QWindow>

#include "policy_dock.h"
#include "views/policy/findings_page.h"
#include "views/policy/lever_surface.h"
#include "views/policy/policy_rules_model.h"
#include "views/policy/rules_page.h"
#include "views/policy/scheme_page.h"
#include "views/policy/shares_view.h"
#include "views/policy/terms_model.h"
#include "views/policy/terms_page.h"

namespace trimtab::test {
namespace {

using Lines = std::vector<std::string>;

/// Keys go to the window that has the focus, as a keyboard's do: past the commands of the menus first.
class PolicyKeys : public PolicyDock {
 protected:
  void SetUp() override {
    PolicyDock::SetUp();
    ASSERT_NO_FATAL_FAILURE(activate());
    setPolicy({"altitude low = ramp 5000 4000", "altitude high = points 4000 0 5000 0.5 6000 1",
               "speed fast = ramp 200 400"},
              {"if altitude is low then screen_space_error = 2 # near ground",
               "if altitude is high then screen_space_error = 4",
               "if speed is fast then lod_scale = 2, far_distance = 0.8"});
    w().dock(QStringLiteral("culling"))->raise();
    w().viewport().setFocus();
    begin_ = w().draft().undoStack().index();
  }
  void press(Qt::Key key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QTest::keyClick(QGuiApplication::focusWindow(), key, modifiers);
    QCoreApplication::processEvents();
  }
  void type(const char* text) {
    for (const char* at = text; *at != '\0'; ++at) QTest::keyClick(QGuiApplication::focusWindow(), *at);
  }
  Lines terms() { return w().draft().parameters().policy.terms.line; }
  Lines rules() { return w().draft().parameters().policy.rules.line; }
  int steps() { return w().draft().undoStack().index() - begin_; }
  views::TermPlot& plot() { return *parts().plot; }
  QTableView& ruleTable() { return parts().rules->table(); }
  QTableView& termTable() { return parts().terms->table(); }
  void goToAltitudeTerms() {
    press(Qt::Key_1, Qt::AltModifier);
    ASSERT_TRUE(parts().signalsList->hasFocus()) << "Alt+1 goes to the dock";
    // A letter goes to a signal, and from there to the next one that it begins.
    for (int i = 0; i < 2 && (i == 0 || parts().signalsList->chosen() != Signal::altitude); ++i)
      press(Qt::Key_A);
    ASSERT_EQ(parts().signalsList->chosen(), Signal::altitude) << "a letter goes to a signal";
    press(Qt::Key_Tab);
    ASSERT_TRUE(plot().hasFocus());
  }
  void goToRules() {
    ASSERT_NO_FATAL_FAILURE(goToAltitudeTerms());
    press(Qt::Key_Tab, Qt::ControlModifier);
    ASSERT_TRUE(ruleTable().hasFocus()) << "Ctrl+Tab goes to the next page";
  }
  void undoAll() {
    for (int left = steps(); left > 0; --left) press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(steps(), 0) << "Ctrl+Z undoes each step";
  }

  int begin_ = 0;
};

TEST_F(PolicyKeys, movePointsAndTermsOfThePlot) {
  ASSERT_NO_FATAL_FAILURE(goToAltitudeTerms());
  const Lines before = terms();
  press(Qt::Key_Home);
  EXPECT_EQ(plot().selected(), 0) << "Home is the plot's here, not the camera's";
  press(Qt::Key_Tab);
  EXPECT_EQ(plot().selected(), 1);
  press(Qt::Key_Right);
  press(Qt::Key_Right, Qt::ShiftModifier);
  EXPECT_NE(terms()[0], before[0]) << "arrows move a point";
  EXPECT_EQ(steps(), 2);
  press(Qt::Key_Left, Qt::ControlModifier);
  EXPECT_EQ(terms()[0], "altitude low = ramp 5000 4000") << "Ctrl+Left goes to a point of another term";
  press(Qt::Key_PageDown);
  ASSERT_EQ(plot().term(), 1);
  press(Qt::Key_Tab);
  press(Qt::Key_Up);
  EXPECT_EQ(terms()[1], "altitude high = points 4000 0 5000 0.51 6000 1");
  press(Qt::Key_Insert);
  EXPECT_NE(terms()[1].find("5500"), std::string::npos) << terms()[1];
  press(Qt::Key_Delete);
  EXPECT_EQ(terms()[1], "altitude high = points 4000 0 5000 0.51 6000 1");
  press(Qt::Key_C, Qt::ControlModifier);
  press(Qt::Key_PageUp);
  press(Qt::Key_V, Qt::ControlModifier);
  EXPECT_EQ(terms()[0], "altitude low = points 4000 0 5000 0.51 6000 1") << "a shape is copied";
  press(Qt::Key_A);
  EXPECT_EQ(terms().size(), 4u) << "A adds a term";
  press(Qt::Key_D, Qt::ControlModifier);
  EXPECT_EQ(terms().size(), 5u) << "Ctrl+D duplicates it";
  press(Qt::Key_Delete, Qt::ControlModifier);
  press(Qt::Key_Delete, Qt::ControlModifier);
  EXPECT_LE(terms().size(), 4u) << "Ctrl+Delete removes it";
  undoAll();
  EXPECT_EQ(terms(), before);
}

TEST_F(PolicyKeys, typeTermsInTheirTable) {
  ASSERT_NO_FATAL_FAILURE(goToAltitudeTerms());
  const Lines before = terms();
  press(Qt::Key_Return);
  ASSERT_NE(qobject_cast<QLineEdit*>(QApplication::focusWidget()), nullptr) << "Enter types the numbers";
  press(Qt::Key_A, Qt::ControlModifier);
  type("6000 3000");
  press(Qt::Key_Return);
  EXPECT_EQ(terms()[0], "altitude low = ramp 6000 3000");
  ASSERT_TRUE(waitFor([&] { return termTable().hasFocus(); }));
  press(Qt::Key_Left);
  ASSERT_EQ(termTable().currentIndex().column(), views::TermsModel::kShape);
  press(Qt::Key_F2);
  ASSERT_TRUE(waitFor([] { return QApplication::activePopupWidget() != nullptr; }));
  auto* const shapes = QApplication::activePopupWidget()->findChild<QAbstractItemView*>();
  ASSERT_NE(shapes, nullptr);
  QTest::keyClick(shapes, Qt::Key_End);
  QTest::keyClick(shapes, Qt::Key_Return);
  EXPECT_TRUE(waitFor([&] { return terms()[0].starts_with("altitude low = sigmoid "); })) << terms()[0];
  ASSERT_TRUE(waitFor([&] {
    return termTable().hasFocus() && termTable().findChild<QComboBox*>() == nullptr;
  })) << "the list of shapes closes";
  press(Qt::Key_Left);
  press(Qt::Key_F2);
  press(Qt::Key_A, Qt::ControlModifier);
  type("near");
  press(Qt::Key_Return);
  EXPECT_TRUE(terms()[0].starts_with("altitude near = ")) << terms()[0];
  EXPECT_TRUE(rules()[0].starts_with("if altitude is near then")) << "in the rules too";
  press(Qt::Key_D, Qt::ControlModifier);
  EXPECT_EQ(terms().size(), 4u);
  press(Qt::Key_Delete);
  press(Qt::Key_Insert);
  EXPECT_EQ(terms().size(), 4u);
  undoAll();
  EXPECT_EQ(terms(), before);
}

TEST_F(PolicyKeys, editRules) {
  ASSERT_NO_FATAL_FAILURE(goToRules());
  const Lines before = rules();
  ruleTable().setCurrentIndex(ruleTable().model()->index(0, views::PolicyRulesModel::kOn));
  press(Qt::Key_Space);
  EXPECT_EQ(rules()[0], "off " + before[0]) << "Space switches a rule off";
  press(Qt::Key_Space);
  press(Qt::Key_Right);
  press(Qt::Key_Right);
  ASSERT_EQ(ruleTable().currentIndex().column(), views::PolicyRulesModel::kCondition);
  press(Qt::Key_F2);
  press(Qt::Key_A, Qt::ControlModifier);
  type("altitude is very low");
  press(Qt::Key_Return);
  EXPECT_EQ(rules()[0], "if altitude is very low then screen_space_error = 2 # near ground");
  ASSERT_TRUE(waitFor([&] { return ruleTable().hasFocus(); }));
  press(Qt::Key_D, Qt::ControlModifier);
  EXPECT_EQ(rules().size(), 4u) << "Ctrl+D duplicates a rule";
  press(Qt::Key_Down, Qt::AltModifier);
  EXPECT_EQ(rules()[1], before[1]) << "Alt+Down moves it";
  press(Qt::Key_Up, Qt::AltModifier);
  EXPECT_EQ(rules()[2], before[1]);
  press(Qt::Key_Delete);
  EXPECT_EQ(rules().size(), 3u);
  press(Qt::Key_Insert);
  EXPECT_EQ(rules().size(), 4u);
  undoAll();
  EXPECT_EQ(rules(), before);
}

TEST_F(PolicyKeys, findRules) {
  ASSERT_NO_FATAL_FAILURE(goToRules());
  press(Qt::Key_F3);
  ASSERT_NE(qobject_cast<QLineEdit*>(QApplication::focusWidget()), nullptr) << "F3 asks for a text";
  type("FAR_dist");
  EXPECT_EQ(parts().rules->selected(), 2);
  press(Qt::Key_A, Qt::ControlModifier);
  type("screen");
  EXPECT_EQ(parts().rules->selected(), 0);
  press(Qt::Key_Return);
  EXPECT_EQ(parts().rules->selected(), 1);
  press(Qt::Key_F3);
  EXPECT_EQ(parts().rules->selected(), 0) << "and from the beginning again";
  press(Qt::Key_F3, Qt::ShiftModifier);
  EXPECT_EQ(parts().rules->selected(), 1);
  press(Qt::Key_A, Qt::ControlModifier);
  type("fog");
  EXPECT_TRUE(parts().rules->note().contains(QStringLiteral("fog")));
  EXPECT_EQ(parts().rules->selected(), 1);
  press(Qt::Key_Escape);
  EXPECT_TRUE(ruleTable().hasFocus());
  EXPECT_EQ(parts().rules->note(), QString());
  EXPECT_EQ(steps(), 0);
}

TEST_F(PolicyKeys, reachEveryPage) {
  ASSERT_NO_FATAL_FAILURE(goToRules());
  const auto inside = [](const QWidget& page) {
    const QWidget* focus = QApplication::focusWidget();
    return focus != nullptr && (focus == &page || page.isAncestorOf(focus));
  };
  for (int page = 2; page < parts().tabs->count(); ++page) {
    press(Qt::Key_Tab, Qt::ControlModifier);
    EXPECT_EQ(parts().tabs->currentIndex(), page);
    EXPECT_TRUE(inside(*parts().tabs->currentWidget())) << page;
    if (parts().tabs->currentWidget() != parts().surface) continue;
    auto* lever = qobject_cast<QComboBox*>(QApplication::focusWidget());
    ASSERT_NE(lever, nullptr);
    const int before = lever->currentIndex();
    press(Qt::Key_Down);
    EXPECT_EQ(lever->currentIndex(), before + 1) << "the surface's lever is chosen by keys";
    for (int i = 0; i < 3; ++i) press(Qt::Key_Tab);
    EXPECT_TRUE(parts().surface->surface().hasFocus());
    const auto range = parts().surface->surface().xAxis->range();
    press(Qt::Key_Plus);
    EXPECT_LT(parts().surface->surface().xAxis->range().size(), range.size()) << "plus zooms";
    press(Qt::Key_F);
    EXPECT_NEAR(parts().surface->surface().xAxis->range().size(), range.size(), 1e-6) << "F fits";
  }
  press(Qt::Key_Backtab, Qt::ControlModifier | Qt::ShiftModifier);
  EXPECT_EQ(parts().tabs->currentWidget(), parts().surface);
  press(Qt::Key_1, Qt::AltModifier);
  EXPECT_TRUE(w().dock(QStringLiteral("policy"))->isHidden()) << "from inside, Alt+1 closes the dock";
  press(Qt::Key_1, Qt::AltModifier);
  EXPECT_TRUE(parts().signalsList->hasFocus());
}

TEST_F(PolicyKeys, followAFindingToItsRule) {
  setPolicy({"altitude low = ramp 5000 4000", "altitude unused = ramp 1 2"},
            {"if altitude is low then screen_space_error = 2"});
  ASSERT_NO_FATAL_FAILURE(goToAltitudeTerms());
  press(Qt::Key_Backtab, Qt::ControlModifier | Qt::ShiftModifier);
  ASSERT_EQ(parts().tabs->currentWidget(), parts().findings);
  ASSERT_TRUE(parts().findings->list().hasFocus());
  ASSERT_TRUE(waitFor([&] {
    for (int i = 0; i < parts().findings->list().count(); ++i)
      if (parts().findings->list().item(i)->text().contains(QStringLiteral("unused"))) return true;
    return false;
  }));
  const auto isUnused = [&] {
    const QListWidgetItem* item = parts().findings->list().currentItem();
    return item != nullptr && item->text().contains(QStringLiteral("unused"));
  };
  ASSERT_TRUE(waitFor([&] {
    press(Qt::Key_Home);
    for (int i = 1; i < parts().findings->list().count() && !isUnused(); ++i) press(Qt::Key_Down);
    return isUnused();
  }));
  press(Qt::Key_Return);
  EXPECT_TRUE(plot().hasFocus());
  EXPECT_EQ(plot().term(), 1);
}

}  // namespace
}  // namespace trimtab::test
