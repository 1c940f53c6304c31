// SPDX-License-Identifier: GPL-3.0-or-later
#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>

#include "gui_support.h"
#include "hand.h"
#include "trimtab/policy/policy_file.h"
#include "trimtab/preset/policy_lines.h"
#include "views/policy/policy_panel.h"
#include "views/policy/rule_map_dialog.h"

namespace trimtab::test {
namespace {

using views::RuleMapDialog;

/// A first-order Sugeno system as people have it: its inputs are in m/s and degrees, its output in percent.
std::string fisOf(const char* slope) {
  return std::string(
             "[System]\nName='detail'\nType='sugeno'\nVersion=2.0\nNumInputs=2\nNumOutputs=1\nNumRules=3\n"
             "AndMethod='prod'\nOrMethod='probor'\nImpMethod='prod'\nAggMethod='sum'\n"
             "DefuzzMethod='wtaver'\n[Input1]\nName='Ground speed'\nRange=[0 200]\nNumMFs=2\n"
             "MF1='slow':'trimf',[-200 0 200]\nMF2='fast':'trimf',[0 200 400]\n[Input2]\nName='Bank'\n"
             "Range=[-45 45]\nNumMFs=1\nMF1='steep':'gaussmf',[10 45]\n[Output1]\nName='Detail'\n"
             "Range=[0 100]\nNumMFs=3\nMF1='much':'linear',[") +
         slope +
         " 0 90]\nMF2='some':'constant',[75]\nMF3='little':'constant',[60]\n"
         "[Rules]\n1 0, 1 (1) : 1\n2 0, 2 (1) : 1\n0 1, 3 (1) : 1\n";
}

class RuleMap : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    ASSERT_NO_FATAL_FAILURE(activate());
    hand_.emplace(w());
    hand_->workIn({QStringLiteral("ruleMap")});
  }
  RuleMapDialog* shown() {
    for (auto* dialog : w().findChildren<RuleMapDialog*>())
      if (dialog->isVisible()) return dialog;
    return nullptr;
  }
  template <class Widget>
  Widget& named(const char* name) {
    for (auto* each : shown()->template findChildren<Widget*>())
      if (each->accessibleName() == QLatin1String(name)) return *each;
    ADD_FAILURE() << name;
    return *shown()->template findChild<Widget*>();
  }
  std::string result() { return named<QLabel>("What comes of the file").text().toStdString(); }
  std::string says() { return named<QPlainTextEdit>("What the reader says").toPlainText().toStdString(); }
  bool mayImport() {
    for (auto* each : shown()->findChildren<QPushButton*>())
      if (plain(each->text()) == QLatin1String("Import")) return each->isEnabled();
    return false;
  }
  bool showsLabel(const QString& text) {
    for (auto* each : shown()->findChildren<QLabel*>())
      if (each->isVisible() && each->text() == text) return true;
    return false;
  }
  void typeIn(const char* name, const char* text) {
    auto& line = named<QLineEdit>(name);
    line.setFocus();
    line.selectAll();
    hand_->type(QLatin1String(text));
  }
  void shoot(const char* name) {
    const QString folder = qEnvironmentVariable("TRIMTAB_SHOTS");
    if (folder.isEmpty()) return;
    QTest::qWait(300);
    shown()->grab().save(QStringLiteral("%1/%2.png").arg(folder, QLatin1String(name)));
  }
  std::size_t rules() { return w().draft().parameters().policy.rules.line.size(); }
  std::optional<Hand> hand_;
  const ScratchDir dir_;
};

TEST_F(RuleMap, asksWhichSignalEachInputIsAndMeasuresTheDifference) {
  writeFile(dir_ / "detail.fis", fisOf("-0.2"));
  drop(dir_ / "detail.fis");
  ASSERT_NE(shown(), nullptr) << w().messages().text().toStdString();
  EXPECT_EQ(result(), "Still to be chosen: Ground_speed, Bank, Detail");
  EXPECT_FALSE(mayImport());
  hand_->choose(*shown(), "Signal of Ground_speed", "Speed (kt)");
  typeIn("Scale of Ground_speed", "0.5144");
  EXPECT_TRUE(showsLabel("0 to 388.8 kt, of 0 to 1,500")) << "metres a second are knots";
  hand_->choose(*shown(), "Signal of Bank", "Roll (deg)");
  EXPECT_EQ(result(), "Still to be chosen: Detail");
  hand_->choose(*shown(), "Lever of Detail", "Render scale");
  EXPECT_FALSE(mayImport()) << says();
  shoot("rule-map-refused");
  hand_->press(*shown(), "Accept a difference above 5 %, and keep the rules of the file");
  EXPECT_FALSE(mayImport());
  EXPECT_NE(says().find("render_scale from 0.5 to 1"), std::string::npos) << "percent: " << says();
  EXPECT_NE(named<QLabel>("Difference of the surface").text().indexOf("difference of Detail: at most "), -1);
  typeIn("Scale of Detail", "100");
  EXPECT_TRUE(mayImport()) << says();
  shoot("rule-map");
  hand_->press(*shown(), "Import");
  EXPECT_EQ(shown(), nullptr);
  EXPECT_EQ(rules(), 3U);
  EXPECT_FALSE(w().draft().isBroken()) << toString(w().draft().findings());
  EXPECT_TRUE(w().messages().text().contains("The policy was imported"));

  // It is the policy that the command line makes of the same words.
  const auto mapping = readRuleMapping("Ground_speed=speed*0.5144,Bank=roll,Detail=render_scale*100", "");
  const auto policy = readPolicyFile(fisOf("-0.2"), "detail.fis", RuleFormat::matlab, {*mapping, true});
  ASSERT_TRUE(policy) << toString(policy.findings());
  const auto lines = policyLines(*policy);
  EXPECT_EQ(w().draft().parameters().policy.rules, lines.rules);
  EXPECT_EQ(w().draft().parameters().policy.terms, lines.terms);
  w().draft().undoStack().undo();
  EXPECT_EQ(rules(), 0U) << "one step";
}

TEST_F(RuleMap, offersNoAcceptanceWhereNothingDiffers) {
  writeFile(dir_ / "flat.fis", fisOf("0"));
  drop(dir_ / "flat.fis");
  ASSERT_NE(shown(), nullptr) << w().messages().text().toStdString();
  for (auto* box : shown()->findChildren<QCheckBox*>()) EXPECT_FALSE(box->isVisible());
  hand_->choose(*shown(), "Signal of Ground_speed", "Speed (kt)");
  hand_->choose(*shown(), "Signal of Bank", "Speed (kt)");
  hand_->choose(*shown(), "Lever of Detail", "Render scale");
  typeIn("Scale of Detail", "0");
  EXPECT_FALSE(mayImport());
  EXPECT_EQ(result(), "A scale is a number that is not 0, and an offset a number.");
  typeIn("Scale of Detail", "100");
  EXPECT_FALSE(mayImport());
  EXPECT_NE(says().find("each key for one variable"), std::string::npos) << says();
  hand_->choose(*shown(), "Signal of Bank", "Roll (deg)");
  EXPECT_TRUE(mayImport()) << says();
  hand_->press(*shown(), "Cancel");
  EXPECT_EQ(rules(), 0U);
}

TEST_F(RuleMap, isNotAskedWhereTheNamesSayIt) {
  std::string text = fisOf("0");
  for (const auto& [from, to] :
       {std::pair{"Ground speed", "speed"}, {"Bank", "roll"}, {"Detail", "render_scale"}})
    text.replace(text.find(std::string("'") + from + "'") + 1, std::string(from).size(), to);
  for (const auto& [from, to] :
       {std::pair{"[0 100]", "[0 1]"}, {"0 90]", "0 0.9]"}, {"[75]", "[0.75]"}, {"[60]", "[0.6]"}})
    text.replace(text.find(from), std::string(from).size(), to);
  writeFile(dir_ / "named.fis", text);
  drop(dir_ / "named.fis");
  EXPECT_EQ(shown(), nullptr);
  EXPECT_EQ(rules(), 3U) << w().messages().text().toStdString();

  text.replace(text.find("'prod'"), 6, "'ham1'");
  writeFile(dir_ / "norm.fis", text);
  drop(dir_ / "norm.fis");
  EXPECT_EQ(shown(), nullptr) << "no mapping mends a norm";
  EXPECT_TRUE(w().messages().text().contains("norm.fis is no policy"));
}

}  // namespace
}  // namespace trimtab::test
