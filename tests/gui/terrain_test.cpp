// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAction>
#include <QCheckBox>
#include <QDialogButtonBox>
#include <QDockWidget>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QProgressBar>
#include <QPushButton>
#include <QTableView>
#include <QTimer>
#include <QToolButton>
#include <atomic>
#include <chrono>
#include <fstream>
#include <future>
#include <thread>

#include "app/workbench/dialogs/bake_dialog.h"
#include "app/workbench/window/job_bar.h"
#include "gui_support.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/format/database.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/synthetic/sample.h"
#include "views/panels/terrain_panel.h"

namespace trimtab::test {
namespace {

class TerrainDock : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    w().dock(QStringLiteral("terrain"))->raise();
  }
  views::TerrainPanel& panel() {
    return *w().dock(QStringLiteral("terrain"))->findChild<views::TerrainPanel*>();
  }
  bool says(const QString& text) { return labelSays(panel(), text); }
  QToolButton* button(const QString& text) {
    for (QToolButton* each : panel().findChildren<QToolButton*>())
      if (each->defaultAction() != nullptr && each->defaultAction()->iconText().contains(text)) return each;
    return nullptr;
  }
  int drawnRows() {
    const QAbstractItemModel& model = *panel().findChild<QTableView*>()->model();
    int rows = 0;
    for (int row = 0; row < model.rowCount(); ++row)
      rows += model.index(row, 7).data().toString() != QStringLiteral("–");
    return rows;
  }
  static QPushButton* accepting(QDialog& dialog) {
    for (QPushButton* each : dialog.findChildren<QPushButton*>())
      if (each->text().contains(QStringLiteral("Bake"))) return each;
    return nullptr;
  }

  ScratchDir dir_;
};

TEST_F(TerrainDock, showsTheLevelsThatThePictureIsMadeOf) {
  ASSERT_TRUE(waitFor([this] { return drawnRows() > 0; }));
  EXPECT_TRUE(says(QStringLiteral("posts")));
  const int rows = drawnRows();
  // At a coarser setting fewer levels are drawn; the dock's button is the menu's command.
  ASSERT_TRUE(w().draft().setText("lod.screen_space_error_px", "200").empty());
  ASSERT_TRUE(waitFor([&] { return drawnRows() > 0 && drawnRows() < rows; })) << drawnRows();
  QToolButton* wire = button(QStringLiteral("Wireframe"));
  ASSERT_NE(wire, nullptr);
  const std::uint64_t before = paints();
  wire->click();
  EXPECT_TRUE(wire->isChecked());
  EXPECT_TRUE(waitFor([&] { return paints() > before; }));
}

TEST_F(TerrainDock, saysOnceThatWhatIsFlownOverIsDamaged) {
  for (const char* file : {"heights.f32", "patches.pages"}) {
    SCOPED_TRACE(file);
    const std::filesystem::path copy = dir_ / (std::string("of-") + file);
    std::filesystem::copy(sampleTerrain(), copy, std::filesystem::copy_options::recursive);
    {
      // Blocks and pages; what a database needs to be opened comes behind them.
      std::fstream damaged(copy / file, std::ios::binary | std::ios::in | std::ios::out);
      for (std::uintmax_t at = 200; at < std::filesystem::file_size(copy / file) * 4 / 10; at += 5000) {
        damaged.seekg(static_cast<std::streamoff>(at));
        const int byte = damaged.get();
        damaged.seekp(static_cast<std::streamoff>(at));
        damaged.put(static_cast<char>(byte ^ 4));
      }
    }
    const bool patches = std::string(file) == "patches.pages";
    ASSERT_TRUE(w().draft().setText("terrain.form", patches ? "patches" : "tiles").empty());
    const auto count = [&](const char* text) { return w().messages().text().count(QLatin1String(text)); };
    const auto before = count("The terrain is damaged");
    w().controllers().terrain->open(QString::fromStdString(copy.string()));
    ASSERT_TRUE(waitFor([&] { return count("The terrain is damaged") > before; }))
        << w().messages().text().toStdString();
    EXPECT_TRUE(w().messages().text().contains(QLatin1String(file)));
    EXPECT_TRUE(w().messages().text().contains(QStringLiteral("checksum")));
    // Each place is said once, however often it is drawn.
    ASSERT_TRUE(settle());
    const auto lines = count(file);
    for (const double pitch : {-5.0, -6.0, -5.0, -6.0}) look(pitch);
    ASSERT_TRUE(settle());
    const QString text = w().messages().text();
    look(-5);
    ASSERT_TRUE(settle());
    EXPECT_EQ(w().messages().text(), text);
    EXPECT_GT(lines, 0);
  }
}

TEST_F(TerrainDock, drawsPatchesWhereThePresetSaysSo) {
  ASSERT_TRUE(w().draft().setText("terrain.form", "patches").empty());
  ASSERT_TRUE(waitFor([this] { return last().patches; }));
  ASSERT_TRUE(waitFor([this] { return says(QStringLiteral("<b>Patches</b>")) && drawnRows() > 0; }));
  EXPECT_TRUE(waitFor([this] { return last().paging.heldBack == 0; }))
      << "all that it wants is there in time";
  EXPECT_TRUE(says(QStringLiteral("512 MB")));
}

TEST_F(TerrainDock, bakesWhatIsAskedForAndOpensIt) {
  ASSERT_TRUE(terrain::writeSample(dir_ / "small.tif", {7, 20, 100, {}}));
  // Another program's manifest, which a bake must leave as it is.
  std::filesystem::create_directories(dir_ / "foreign");
  writeFile(dir_ / "foreign" / "manifest.json", R"({"name": "a web page"})");
  bool refusedWithout = false, refusedForeign = false, acceptedWith = false;
  QTimer::singleShot(0, &w(), [&] {
    auto* dialog = w().findChild<workbench::BakeDialog*>();
    if (dialog == nullptr) return;
    refusedWithout = !accepting(*dialog)->isEnabled();
    dialog->addSources({QString::fromStdString((dir_ / "small.tif").string())});
    for (QLineEdit* line : dialog->findChildren<QLineEdit*>())
      if (line->text().endsWith(QStringLiteral("small-terrain"))) {
        line->setText(QString::fromStdString((dir_ / "foreign").string()));
        refusedForeign = !accepting(*dialog)->isEnabled();
        line->setText(QString::fromStdString((dir_ / "mine").string()));
      }
    acceptedWith = accepting(*dialog)->isEnabled();
    accepting(*dialog)->click();
  });
  button(QStringLiteral("Bake"))->click();
  EXPECT_TRUE(refusedWithout);
  EXPECT_TRUE(refusedForeign);
  ASSERT_TRUE(acceptedWith);
  ASSERT_TRUE(waitFor([this] { return says(QStringLiteral("<b>small</b>")); }))
      << w().messages().text().toStdString();
  EXPECT_TRUE(terrain::isDatabase(dir_ / "mine"));
  EXPECT_FALSE(panel().findChild<QProgressBar*>()->isVisible());
}

TEST_F(TerrainDock, bakesFilesThatDoNotSayWhatTheyAreIn) {
  std::filesystem::create_directories(dir_ / "tiles");
  workbench::BakeDialog dialog;
  dialog.addSources({QString::fromStdString((dir_ / "grid.asc").string())});
  const auto named = [&dialog](const char* name) {
    for (auto* line : dialog.findChildren<QLineEdit*>())
      if (line->accessibleName() == QLatin1String(name)) return line;
    return static_cast<QLineEdit*>(nullptr);
  };
  EXPECT_FALSE(dialog.options().reading.heightUnit);
  EXPECT_FALSE(dialog.options().reading.ignoreChecksums);
  ASSERT_NE(named("Unit of heights"), nullptr);
  named("Unit of heights")->setText("cubits");
  EXPECT_FALSE(accepting(dialog)->isEnabled());
  named("Unit of heights")->setText("foot");
  EXPECT_TRUE(accepting(dialog)->isEnabled());
  EXPECT_EQ(dialog.options().reading.heightUnit, 0.3048);
  for (auto* box : dialog.findChildren<QCheckBox*>())
    if (box->text().contains(QLatin1String("DTED"))) box->click();
  EXPECT_TRUE(dialog.options().reading.ignoreChecksums);
  named("Image to drape")->setText(QString::fromStdString((dir_ / "nowhere").string()));
  EXPECT_FALSE(accepting(dialog)->isEnabled());
  named("Image to drape")->setText(QString::fromStdString((dir_ / "tiles").string()));
  EXPECT_TRUE(accepting(dialog)->isEnabled()) << "a folder of images";
  EXPECT_EQ(dialog.options().imagery, dir_ / "tiles");
}

TEST_F(TerrainDock, tellsWhatABakeFoundThoughItSucceeded) {
  ASSERT_TRUE(terrain::writeSample(dir_ / "small.tif", {7, 20, 100, {}}));
  writeFile(dir_ / "hole.asc",
            "ncols 2\nnrows 2\nxllcenter 128.35\nyllcenter 36.63\ncellsize 0.001\nNODATA_value -9999\n"
            "-9999 -9999\n-9999 -9999\n");
  writeFile(dir_ / "hole.prj",
            R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],)"
            R"(PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]])");
  terrain::BakeOptions options;
  options.sources = {dir_ / "small.tif", dir_ / "hole.asc"};
  options.output = dir_ / "mine";
  w().controllers().terrain->job().bake(options);
  ASSERT_TRUE(
      waitFor([this] { return says(QStringLiteral("<b>")) && !w().controllers().terrain->job().running(); }));
  EXPECT_TRUE(terrain::isDatabase(dir_ / "mine")) << w().messages().text().toStdString();
  EXPECT_TRUE(w().messages().text().contains(QStringLiteral("voids alone")))
      << w().messages().text().toStdString();
}

TEST_F(TerrainDock, keepsTheTerrainWhenABakeIsCancelledOrRefused) {
  ASSERT_TRUE(terrain::writeSample(dir_ / "large.tif", {7, 150, 60, {}}));
  terrain::BakeOptions options;
  options.sources = {dir_ / "large.tif"};
  options.output = dir_ / "never";
  const std::uint64_t before = paints();
  w().controllers().terrain->job().bake(options);
  ASSERT_TRUE(waitFor([this] { return panel().findChild<QProgressBar*>()->isVisible(); }));
  for (QPushButton* each : panel().findChildren<QPushButton*>())
    if (each->text().contains(QStringLiteral("Cancel"))) each->click();
  EXPECT_TRUE(waitFor([this] { return !w().controllers().terrain->job().running(); }));
  EXPECT_FALSE(terrain::isDatabase(dir_ / "never"));
  writeFile(dir_ / "text.tif", "no raster");
  options.sources = {dir_ / "text.tif"};
  w().controllers().terrain->job().bake(options);
  ASSERT_TRUE(waitFor([this] { return w().messages().text().contains(QStringLiteral("text.tif")); }));
  EXPECT_TRUE(w().controllers().terrain->database() != nullptr);
  w().viewport().invalidate();
  EXPECT_TRUE(waitFor([&] { return paints() > before; }));
}

TEST(TerrainJob, waitsForNoCancelledWorkButEndsItBeforeTheNext) {
  using Opened = Result<std::shared_ptr<const terrain::Database>>;
  const auto late = std::chrono::seconds(20);
  std::promise<void> begun, go, thirdBegun;
  std::atomic<bool> firstEnded{false}, inOrder{false}, secondBegun{false}, thirdEnded{false};
  std::vector<std::string> told;
  {
    workbench::TerrainJob job;
    QObject::connect(&job, &workbench::TerrainJob::failed, &job,
                     [&](const Findings& findings) { told.push_back(toString(findings)); });
    // This work does not ask for a long time whether to go on.
    job.start("first", {}, [&](const terrain::Progress&) -> Opened {
      begun.set_value();
      go.get_future().wait_for(late);
      firstEnded = true;
      return Finding{Severity::note, "first", "", "", ""};
    });
    begun.get_future().wait();
    job.cancel();
    EXPECT_FALSE(job.running());
    EXPECT_FALSE(firstEnded) << "cancelling waited for it";
    job.start("second", {}, [&](const terrain::Progress& progress) -> Opened {
      secondBegun = true;
      inOrder = firstEnded.load();
      return Finding{Severity::note, progress(0, "") ? "second" : "stopped", "", "", ""};
    });
    EXPECT_TRUE(job.running());
    EXPECT_FALSE(firstEnded);
    QTest::qWait(50);
    EXPECT_FALSE(secondBegun);
    go.set_value();
    ASSERT_TRUE(waitFor([&] { return !job.running(); }));
    EXPECT_TRUE(inOrder);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("second"), std::string::npos);
    // Destroying it while a job runs stops the job and waits for its end.
    job.start("third", {}, [&](const terrain::Progress& progress) -> Opened {
      thirdBegun.set_value();
      while (progress(0, "")) std::this_thread::yield();
      thirdEnded = true;
      return Finding{Severity::note, "third", "", "", ""};
    });
    thirdBegun.get_future().wait();
  }
  EXPECT_TRUE(thirdEnded);
}

TEST(JobBar, showsHowFarAJobIsAndCancelsIt) {
  using Opened = Result<std::shared_ptr<const terrain::Database>>;
  std::atomic<bool> ended{false};
  workbench::TerrainJob job;
  workbench::JobBar bar(job);
  EXPECT_FALSE(bar.isVisible());
  job.start("Opening", {}, [&](const terrain::Progress& progress) -> Opened {
    while (progress(0.4, "reading heights")) std::this_thread::yield();
    ended = true;
    return Finding{Severity::note, "job", "", "", ""};
  });
  const auto* const done = bar.findChild<QProgressBar*>();
  ASSERT_TRUE(waitFor([&] { return bar.isVisible() && done->value() == 40; }));
  EXPECT_EQ(bar.findChild<QLabel*>()->text(), "reading heights");
  QTest::mouseClick(bar.findChild<QPushButton*>(), Qt::LeftButton);
  EXPECT_TRUE(waitFor([&] { return !bar.isVisible() && !job.running() && ended; }));
}

}  // namespace
}  // namespace trimtab::test
