// SPDX-License-Identifier: GPL-3.0-or-later
#include <QComboBox>
#include <QLineEdit>
#include <QPushButton>
#include <QSpinBox>
#include <QTableWidget>
#include <algorithm>

#include "app/workbench/controllers/flight_controller.h"
#include "app/workbench/docks/experiments_dock.h"
#include "gui_support.h"
#include "views/plots/report_plot.h"

namespace trimtab::test {
namespace {

class ExperimentsDock : public Bench {
 protected:
  workbench::ExperimentsDock& dock() { return *w().panels().experiments; }
  /// Asks for a small and short run through the dock's own fields.
  void choose(const char* command) {
    auto* which = dock().findChildren<QComboBox*>().front();
    which->setCurrentIndex(which->findData(QLatin1String(command)));
    dock().findChild<QLineEdit*>()->setText(QStringLiteral("64x48"));
    dock().findChild<QSpinBox*>()->setValue(1);
  }
  bool runToEnd() {
    bool ended = false, good = false;
    const auto link =
        QObject::connect(&dock(), &workbench::ExperimentsDock::finished, &dock(), [&](bool how) {
          ended = true;
          good = how;
        });
    dock().run();
    EXPECT_TRUE(waitFor([&] { return ended; }, 180000));
    QObject::disconnect(link);
    return good;
  }
};

TEST_F(ExperimentsDock, showsThePublishedRowsBesideOurs) {
  choose("culling");
  ASSERT_TRUE(runToEnd()) << w().messages().text().toStdString();
  ASSERT_TRUE(dock().report());
  EXPECT_EQ(dock().report()->measured.rows.size(), 16u);
  const QList<QTableWidget*> tables = dock().findChildren<QTableWidget*>();
  ASSERT_EQ(tables.size(), 2);
  // Twelve rows are published, and ours has one case more.
  EXPECT_EQ(std::min(tables[0]->rowCount(), tables[1]->rowCount()), 12);
  EXPECT_EQ(std::max(tables[0]->rowCount(), tables[1]->rowCount()), 16);
  for (const QTableWidget* table : tables) {
    EXPECT_EQ(table->horizontalHeaderItem(0)->text(), "altitude ft");
    EXPECT_FALSE(table->item(11, 2)->text().isEmpty());
  }
  EXPECT_EQ(dock().findChildren<QComboBox*>().back()->count(), int(dock().report()->plots.size()));
}

TEST_F(ExperimentsDock, runsOverThePresetAsItStandsAndKeepsTheResultsWhenCancelled) {
  choose("culling");
  ASSERT_TRUE(w().draft().setText("lod.screen_space_error_px", "64").empty());
  ASSERT_TRUE(runToEnd()) << w().messages().text().toStdString();
  const double coarse = dock().report()->measured.number(0, "triangles");
  w().draft().undoStack().undo();
  ASSERT_TRUE(runToEnd());
  EXPECT_GT(dock().report()->measured.number(0, "triangles"), coarse);

  choose("head-motion");
  bool ended = false;
  QObject::connect(&dock(), &workbench::ExperimentsDock::finished, &dock(), [&](bool good) {
    ended = true;
    EXPECT_FALSE(good);
  });
  dock().run();
  ASSERT_TRUE(dock().running());
  dock().cancel();
  ASSERT_TRUE(waitFor([&] { return ended; }));
  EXPECT_FALSE(dock().running());
  EXPECT_EQ(dock().report()->name, "culling");
}

TEST_F(ExperimentsDock, showsWhatEachLeverIsWorthInTheFlight) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  choose("leverage");
  ASSERT_TRUE(runToEnd()) << w().messages().text().toStdString();
  ASSERT_TRUE(dock().report());
  EXPECT_EQ(dock().report()->name, "leverage");
  EXPECT_EQ(dock().report()->measured.rows.size(), 7u);
  EXPECT_EQ(dock().report()->plots.size(), 3u);
  const QList<QTableWidget*> tables = dock().findChildren<QTableWidget*>();
  EXPECT_EQ(std::max(tables[0]->rowCount(), tables[1]->rowCount()), 7);
  EXPECT_EQ(std::min(tables[0]->rowCount(), tables[1]->rowCount()), 0) << "no document has published it";
}

TEST_F(ExperimentsDock, saysWhyAnExperimentFailed) {
  choose("static-lod");
  EXPECT_FALSE(runToEnd());
  EXPECT_TRUE(w().messages().text().contains("baked from scenery")) << w().messages().text().toStdString();
}

}  // namespace
}  // namespace trimtab::test
