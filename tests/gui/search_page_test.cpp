// SPDX-License-Identifier: GPL-3.0-or-later
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>

#include "app/workbench/controllers/flight_controller.h"
#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/search_page.h"
#include "app/workbench/window/workspaces.h"
#include "gui_support.h"

namespace trimtab::test {
namespace {

class SearchPage : public Bench {
 protected:
  workbench::SearchPage& page() { return *w().panels().search; }
  QPushButton& button(const QString& text) {
    for (QPushButton* button : page().findChildren<QPushButton*>())
      if (button->text() == text) return *button;
    ADD_FAILURE() << text.toStdString();
    return *page().findChild<QPushButton*>();
  }
  /// Starts a small search without a limit.
  void run() {
    for (QLineEdit* line : page().findChildren<QLineEdit*>())
      if (line->text() == QStringLiteral("1280x720")) line->setText(QStringLiteral("96x64"));
    page().findChild<QDoubleSpinBox*>()->setValue(0);
    for (QSpinBox* number : page().findChildren<QSpinBox*>())
      number->setValue(number->maximum() > 100000 ? 400 : 3);
    ended_ = good_ = false;
    QObject::connect(
        &page(), &workbench::SearchPage::finished, &page(),
        [this](bool good) { ended_ = true, good_ = good; }, Qt::SingleShotConnection);
    page().run();
  }
  bool ends() {
    EXPECT_TRUE(waitFor([this] { return ended_; }, 180000));
    return good_;
  }

 private:
  bool ended_ = false, good_ = false;
};

TEST_F(SearchPage, findsPresetsAlongTheFlightAndFliesTheOneThatIsChosen) {
  page().run();
  EXPECT_FALSE(page().running());
  EXPECT_TRUE(labelSays(page(), "Ctrl+L opens one")) << "it needs a flight";
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  run();
  ASSERT_TRUE(ends()) << w().messages().text().toStdString();
  ASSERT_TRUE(page().report());
  EXPECT_TRUE(labelSays(page(), "No limit was asked for"));
  QTableWidget& table = *page().findChild<QTableWidget*>();
  ASSERT_GT(table.rowCount(), 1);
  // The first row is the preset that the search began from: there is nothing to use.
  table.selectRow(0);
  EXPECT_FALSE(button(QStringLiteral("&Use preset")).isEnabled());
  table.selectRow(table.rowCount() - 1);
  ASSERT_TRUE(button(QStringLiteral("&Use preset")).isEnabled());
  const TuningParameters before = w().draft().parameters();
  w().workspaces().show(workbench::Workspaces::kMeasure);
  workbench::raiseDock(page());
  // A screenshot to look at if TRIMTAB_SHOTS names a folder.
  if (const QString folder = qEnvironmentVariable("TRIMTAB_SHOTS"); !folder.isEmpty())
    page().window()->grab().save(folder + QStringLiteral("/search.png"));
  button(QStringLiteral("&Use preset")).click();
  EXPECT_FALSE(differences(before, w().draft().parameters()).empty()) << "it is flown";
  w().draft().undoStack().undo();
  EXPECT_TRUE(differences(before, w().draft().parameters()).empty()) << "and taken back";
}

TEST_F(SearchPage, saysWhatIsWrongAndKeepsNothingRunningWhenCancelled) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  run();
  ASSERT_TRUE(page().running());
  page().cancel();
  EXPECT_FALSE(ends());
  EXPECT_FALSE(page().running());
  for (QLineEdit* line : page().findChildren<QLineEdit*>())
    if (line->text().startsWith(QStringLiteral("lod."))) line->setText(QStringLiteral("lod.sclae"));
  run();
  EXPECT_FALSE(ends());
  EXPECT_TRUE(w().messages().text().contains(QStringLiteral("lod.sclae")));
}

}  // namespace
}  // namespace trimtab::test
