// SPDX-License-Identifier: GPL-3.0-or-later
#include "views/policy/rules_page.h"

#include <QLineEdit>

#include "policy_flight.h"
#include "tests/views/application.h"
#include "views/policy/policy_rules_model.h"

namespace trimtab::views {
namespace {

class RulesPageTest : public testing::Test {
 protected:
  void SetUp() override {
    test::setSmallPolicy(draft_);
    test::expose(page_, {640, 400});
  }
  RulesPage& page() { return page_; }
  QTableView& rules() { return page_.table(); }

  Draft draft_;
  PolicyDraft policy_{draft_};
  RulesPage page_{policy_};
};

TEST_F(RulesPageTest, aRuleThatAloneSetsALeverSaysThatItIsASwitch) {
  page().select(0);
  EXPECT_EQ(page().note(), QString()) << "both rules set the error";
  page().select(1);
  EXPECT_TRUE(page().note().contains(QStringLiteral("Rule 2 is a switch"))) << page().note().toStdString();
  draft_.setValue("policy.rules", TextLines{{"if speed is fast then screen_space_error = 4",
                                             "off if speed is fast then screen_space_error = 2"}});
  page().select(0);
  EXPECT_TRUE(page().note().contains(QStringLiteral("Rule 1 is a switch"))) << "the other one is off";
}

TEST_F(RulesPageTest, wordsOfRulesAreCompletedWhileOneTypes) {
  const auto edit = [&](int column, const char* text) {
    rules().setFocus();
    rules().setCurrentIndex(rules().model()->index(0, column));
    rules().edit(rules().currentIndex());
    auto* line = rules().viewport()->findChild<QLineEdit*>();
    line->selectAll();
    QTest::keyClicks(line, QString::fromLatin1(text));
    return line;
  };
  QLineEdit* line = edit(PolicyRulesModel::kCondition, "Height");
  QWidget* words = QApplication::activePopupWidget();
  ASSERT_NE(words, nullptr) << "a signal is found by the name that the list has for it";
  QTest::keyClick(words, Qt::Key_Down);
  QTest::keyClick(words, Qt::Key_Return);
  EXPECT_EQ(line->text(), QStringLiteral("above_ground"));
  QTest::keyClicks(line, QStringLiteral(" is very hi"));
  words = QApplication::activePopupWidget();
  ASSERT_NE(words, nullptr) << "the terms of the signal";
  QTest::keyClick(words, Qt::Key_Down);
  QTest::keyClick(words, Qt::Key_Return);
  EXPECT_EQ(line->text(), QStringLiteral("above_ground is very high"));
  EXPECT_EQ(QApplication::activePopupWidget(), nullptr);
  QTest::keyClick(line, Qt::Key_Return);
  EXPECT_TRUE(test::eventually([&] {
    return draft_.parameters().policy.rules.line[0].starts_with("if above_ground is very high then");
  }));
  QCoreApplication::processEvents();
  line = edit(PolicyRulesModel::kSettings, "lod_sc");
  words = QApplication::activePopupWidget();
  ASSERT_NE(words, nullptr);
  QTest::keyClick(words, Qt::Key_Return);
  EXPECT_EQ(QApplication::activePopupWidget(), nullptr) << "Enter without a choice belongs to the editor";
  EXPECT_NE(page().note(), QString()) << "which refuses half a word";
  QTest::keyClick(line, Qt::Key_Escape);
}

}  // namespace
}  // namespace trimtab::views
