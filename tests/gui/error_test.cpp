// SPDX-License-Identifier: GPL-3.0-or-later
#include <QCheckBox>
#include <QComboBox>
#include <QDockWidget>
#include <QListWidget>
#include <QPushButton>
#include <QSettings>
#include <QSignalSpy>
#include <QSpinBox>
#include <QTabWidget>
#include <QTableWidget>
#include <cmath>

#include "app/workbench/dialogs/sweep_choice.h"
#include "app/workbench/docks/answer_page.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/docks/sweep_page.h"
#include "error_dock.h"
#include "trimtab/preset/preset.h"
#include "views/panels/budget_strip.h"
#include "views/panels/plots_panel.h"
#include "views/plots/sweep_plot.h"
#include "views/plots/time_plot.h"

namespace trimtab::test {
namespace {

/// Runs a tiny benchmark with the program itself, once per test program.
const QString& tinyResults() {
  static const ScratchDir dir;
  static const QString file = [] {
    QProcess bench;
    const QString folder = QString::fromStdString((dir / "bench").string());
    bench.setProcessChannelMode(QProcess::MergedChannels);
    bench.start(
        QCoreApplication::applicationDirPath() + "/trimtab-cli",
        {"bench", "--terrain", QString::fromStdString(sampleTerrain().string()), "--flight",
         QString::fromStdString(sampleFlight()), "--preset", "default", "as-published", "--cases",
         "view_frustum,proposed", "--size", "96x64", "--frames", "5", "--repeats", "2", "-o", folder});
    EXPECT_TRUE(bench.waitForFinished(180000));
    EXPECT_EQ(bench.exitCode(), 0) << bench.readAll().toStdString();
    return folder + "/results.json";
  }();
  return file;
}

/// Writes results of these presets: the first one takes 30 ms a frame, and each next one half of that, with
/// twice the FLIP.
QString resultsOf(const std::vector<std::string>& presets, const std::filesystem::path& file) {
  harness::Results results;
  results.terrain = "made up";
  results.widthPx = 640;
  results.heightPx = 360;
  results.budgetMs = 16.7;
  double ms = 60, flip = 0.005;
  for (const std::string& preset : presets) {
    harness::Unit& unit = results.units.emplace_back();
    unit.name = {"circuit", preset, "proposed"};
    harness::MeasuredFrame frame;
    frame.cost.total = ms /= 2;
    frame.repeatsMs = {ms};
    frame.error.flip = flip *= 2;
    // So many that they are sure of what fits.
    for (; frame.row < 60; ++frame.row) unit.frames.push_back(frame);
  }
  std::ofstream(file) << harness::toJson(results);
  return QString::fromStdString(file.string());
}

TEST_F(ErrorDock, theLivePointMovesWithThePictureAndSaysWhatItCosts) {
  raise();
  ASSERT_TRUE(waitFor([&] { return measurements() > 0; }, 90000)) << w().messages().text().toStdString();
  ASSERT_FALSE(dock().plot().tail().empty());
  const auto& first = *dock().lastMeasured();
  EXPECT_TRUE(std::isfinite(first.error.flip));
  EXPECT_GT(first.tookMs, 0);
  EXPECT_TRUE(dock().liveText().contains("Measured in")) << dock().liveText().toStdString();
  EXPECT_TRUE(dock().liveText().contains(" ms at "));
  const QPointF before = dock().plot().livePixel();

  ASSERT_TRUE(w().draft().setText("lod.screen_space_error_px", "32").empty());
  ASSERT_TRUE(measured());
  EXPECT_GT(dock().lastMeasured()->error.flip, 0);
  EXPECT_NE(dock().plot().livePixel(), before);
  EXPECT_GT(dock().plot().tail().size(), 1u);
}

TEST_F(ErrorDock, aPictureThatStandsIsMeasuredOnceAndAHiddenDockMeasuresNothing) {
  raise();
  ASSERT_TRUE(waitFor([&] { return measurements() > 0; }, 90000));
  ASSERT_TRUE(settle());
  // What was under way is dropped: the first point after that is of the picture that stands.
  dock().restartLive();
  ASSERT_TRUE(waitFor([&] { return !dock().plot().tail().empty(); }));
  const auto paint = [&](double pitchDeg) {
    const std::uint64_t before = paints();
    look(pitchDeg);
    return waitFor([&] { return paints() > before; });
  };
  w().viewport().invalidate();  // painted again, the same picture
  EXPECT_TRUE(rests());

  w().dock("plots")->raise();
  ASSERT_TRUE(waitFor([&] { return !dock().live().isOn(); }));
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(paint(-6 - i));
  EXPECT_TRUE(rests()) << "hidden";
  // Switched off first: a dock that comes to the front measures soon.
  dock().liveSwitch().setChecked(false);
  raise();
  ASSERT_TRUE(comesToFront("errors"));
  ASSERT_TRUE(paint(-3));
  EXPECT_TRUE(rests()) << "switched off";
  EXPECT_TRUE(dock().plot().tail().empty());
}

TEST_F(ErrorDock, whatNobodySawOfAStandingPictureIsMeasuredAgain) {
  raise();
  ASSERT_TRUE(waitFor([&] { return measurements() > 0; }, 90000));
  ASSERT_TRUE(settle());
  ASSERT_TRUE(waitFor([&] { return !dock().live().busy(); }));
  const auto under = [&] { return waitFor([&] { return dock().live().busy(); }, 20000); };
  const auto over = [&] { return waitFor([&] { return !dock().live().busy(); }, 90000); };
  dock().liveSwitch().setChecked(false);
  EXPECT_TRUE(dock().plot().tail().empty());
  dock().liveSwitch().setChecked(true);
  EXPECT_TRUE(waitFor([&] { return !dock().plot().tail().empty(); }, 20000)) << "switched off and on";
  ASSERT_TRUE(over());

  dock().restartLive();
  ASSERT_TRUE(under());
  w().dock("plots")->raise();
  ASSERT_TRUE(over());
  EXPECT_TRUE(dock().plot().tail().empty());
  raise();
  EXPECT_TRUE(waitFor([&] { return !dock().plot().tail().empty(); }, 20000)) << "hidden meanwhile";
  ASSERT_TRUE(over());

  dock().restartLive();
  ASSERT_TRUE(under());
  dock().restartLive();
  ASSERT_TRUE(over());
  EXPECT_TRUE(dock().plot().tail().empty()) << "of the picture before";
  EXPECT_TRUE(waitFor([&] { return !dock().plot().tail().empty(); }, 20000));
}

TEST_F(ErrorDock, measuringLeavesThePictureAsItIs) {
  ASSERT_TRUE(settle());
  // Compare only above the line of text, which shows milliseconds.
  const auto picture = [&] {
    const QImage image = w().viewport().grabFramebuffer();
    return image.copy(0, 0, image.width(), image.height() * 3 / 4);
  };
  const QImage before = picture();
  raise();
  ASSERT_TRUE(measured(1));
  ASSERT_TRUE(settle());
  w().dock("plots")->raise();
  ASSERT_TRUE(settle());
  EXPECT_TRUE(picture() == before);
}

TEST_F(ErrorDock, aPlotOfFlipHasItMeasuredWhileItIsInSight) {
  views::PlotsPanel& plots = *w().panels().plots;
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  w().dock("plots")->show();
  w().dock("plots")->raise();
  ASSERT_TRUE(waitFor([&] { return !dock().live().isOn(); })) << "nobody wants it yet";
  plots.plot().addSignal(0, views::Trace::flip);
  ASSERT_TRUE(dock().live().isOn());
  // Each image is a frame of the plots.
  const auto newest = [&] {
    w().viewport().invalidate();
    return plots.buffer().value(views::Trace::flip, plots.buffer().end() - 1);
  };
  EXPECT_TRUE(
      waitFor([&] { return dock().lastMeasured() && newest() == float(dock().lastMeasured()->error.flip); }));
  w().dock("policy")->show();
  w().dock("plots")->hide();
  EXPECT_TRUE(waitFor([&] { return !dock().live().isOn(); })) << "nobody sees the plot";
  EXPECT_TRUE(waitFor([&] { return std::isnan(newest()); })) << "what was measured is of another image";
}

TEST_F(ErrorDock, showsMeasuredResultsAndTheCursorTakesTheViewToTheRow) {
  ASSERT_FALSE(tinyResults().isEmpty());
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  raise();
  dock().liveSwitch().setChecked(false);
  ASSERT_TRUE(dock().openResults(tinyResults())) << w().messages().text().toStdString();
  dock().pages().setCurrentIndex(2);
  ASSERT_EQ(dock().plot().points().size(), 4u);
  EXPECT_TRUE(dock().report().endsWith("report.html"));
  const double before = dock().plot().points()[0].error;
  dock().errorChoice().setCurrentIndex(dock().errorChoice().findData("ssim"));
  EXPECT_NE(dock().plot().points()[0].error, before);

  const harness::Unit& unit = dock().results()->units.front();
  ASSERT_EQ(unit.frames.size(), 5u);
  const Flight& flight = w().feed().playback().flight();
  dock().timeline().setFocus();
  QTest::keyClick(&dock().timeline(), Qt::Key_Home);
  for (std::size_t i = 1; i < 4; ++i) {
    QTest::keyClick(&dock().timeline(), Qt::Key_Right);
    const harness::MeasuredFrame& frame = unit.frames[i];
    const AircraftState& row = flight.states[frame.row];
    EXPECT_EQ(row.time, frame.timeS);
    ASSERT_TRUE(settle());
    const AircraftState& eye = session().input().state;
    EXPECT_NEAR(eye.position.latitude.value(), row.position.latitude.value(), 1e-12);
    EXPECT_NEAR(eye.position.longitude.value(), row.position.longitude.value(), 1e-12);
    EXPECT_NEAR(eye.position.height.value(), row.position.height.value(), 1e-9);
    EXPECT_EQ(w().feed().source(), workbench::Feed::Source::flight);
  }
  // The other way round: the cursor moves with the flight.
  w().panels().flight->seek(unit.frames[2].timeS - flight.states.front().time);
  EXPECT_TRUE(
      waitFor([&] { return std::abs(dock().timeline().cursorTime() - unit.frames[2].timeS) < 1e-9; }));
}

TEST_F(ErrorDock, theAnswerNamesTheBestPresetUnderTheBudgetOfTheDraft) {
  EXPECT_TRUE(dock().answer().text().contains("Nothing has been measured"));
  ASSERT_FALSE(tinyResults().isEmpty());
  raise();
  dock().liveSwitch().setChecked(false);
  ASSERT_TRUE(dock().openResults(tinyResults()));
  EXPECT_EQ(dock().pages().currentWidget(), &dock().answer());
  QTableWidget& table = dock().answer().table();
  ASSERT_EQ(table.rowCount(), 4);
  EXPECT_TRUE(dock().answer().text().contains(QString("96 × 64 px"))) << dock().answer().text().toStdString();
  const int verdict = table.columnCount() - 1;

  ASSERT_TRUE(w().draft().setText("measure.budget_ms", "1000").empty());
  EXPECT_TRUE(dock().answer().text().contains("the best under 1,000 ms"))
      << dock().answer().text().toStdString();
  table.sortByColumn(verdict, Qt::AscendingOrder);
  EXPECT_TRUE(table.item(0, verdict)->text().contains("best"));
  EXPECT_TRUE(table.item(1, verdict)->text().contains("may fit")) << "a few frames are not sure of it";
  EXPECT_EQ(table.item(0, 4)->text(), "–") << "and have no 99th percentile";
  EXPECT_TRUE(table.item(0, 4)->toolTip().contains("100 frames"));
  EXPECT_EQ(table.item(0, 5)->text(), "0") << "share over the budget";
  table.sortByColumn(2, Qt::DescendingOrder);
  EXPECT_GE(QLocale().toDouble(table.item(0, 2)->text()), QLocale().toDouble(table.item(3, 2)->text()));

  // Of made-up times it is known what fits, whatever the machine.
  const ScratchDir dir;
  ASSERT_TRUE(dock().openResults(resultsOf({"default", "as-published"}, dir / "slow.json")));
  ASSERT_TRUE(w().draft().setText("measure.budget_ms", "14.9").empty());
  EXPECT_TRUE(dock().answer().answer()->best.empty()) << "the faster one takes 15 ms";
  table.sortByColumn(verdict, Qt::AscendingOrder);
  EXPECT_EQ(table.item(0, verdict)->text(), "over budget");
  ASSERT_TRUE(w().draft().setText("measure.budget_ms", "15.1").empty());
  EXPECT_EQ(dock().answer().answer()->best, std::vector<std::size_t>{1});
  ASSERT_TRUE(w().draft().setText("measure.budget_ms", "30.1").empty());
  EXPECT_EQ(dock().answer().answer()->best, std::vector<std::size_t>{0})
      << "of both it has the smaller error";
}

TEST_F(ErrorDock, aSweepOfOneParameterIsALineAndOfTwoAMap) {
  const ScratchDir dir;
  ASSERT_TRUE(w().draft().setText("measure.budget_ms", "16.7").empty());
  ASSERT_TRUE(
      dock().openResults(resultsOf({"mine lod.screen_space_error_px=1", "mine lod.screen_space_error_px=2",
                                    "mine lod.screen_space_error_px=4"},
                                   dir / "line.json")));
  EXPECT_EQ(dock().pages().currentWidget(), &dock().sweep());
  const QCPGraph& times = dock().sweep().plot().times();
  ASSERT_EQ(times.data()->size(), 3);
  EXPECT_EQ(times.data()->at(1)->value, 15);
  EXPECT_TRUE(dock().sweep().text().contains("px=2")) << dock().sweep().text().toStdString();

  const std::string two = "mine lod.screen_space_error_px=1 lod.level_spread=";
  ASSERT_TRUE(dock().openResults(resultsOf({two + "1", two + "2"}, dir / "map.json")));
  QTableWidget& map = dock().sweep().map();
  ASSERT_EQ(map.rowCount(), 1);
  ASSERT_EQ(map.columnCount(), 2);
  EXPECT_TRUE(map.item(0, 0)->text().contains("✕")) << map.item(0, 0)->text().toStdString();
  EXPECT_TRUE(map.item(0, 1)->text().contains("★ 15")) << map.item(0, 1)->text().toStdString();
  EXPECT_NE(map.item(0, 0)->background(), map.item(0, 1)->background());

  ASSERT_TRUE(dock().openResults(resultsOf({"default"}, dir / "none.json")));
  EXPECT_EQ(dock().pages().currentWidget(), &dock().answer());
  EXPECT_EQ(dock().sweep().sweeps(), 0u);
}

TEST_F(ErrorDock, theDialogProposesValuesToSweepAndSaysWhatIsWrongWithThem) {
  workbench::BenchDialog dialog("/nowhere");
  workbench::SweepChoice& sweep = dialog.sweep();
  EXPECT_TRUE(sweep.sweeps().isEmpty());
  EXPECT_EQ(sweep.presets(), 1);
  sweep.choose(0, "lod.screen_space_error_px");
  EXPECT_EQ(sweep.presets(), 5) << sweep.sweeps().join(' ').toStdString();
  EXPECT_EQ(sweep.fault(), "");
  sweep.choose(0, "lod.screen_space_error_px", "1, 2, 4");
  sweep.choose(1, "fuzzy.hysteresis", "0, 0.05");
  EXPECT_EQ(sweep.presets(), 6);
  EXPECT_EQ(dialog.choice().sweeps,
            (QStringList{"lod.screen_space_error_px=1,2,4", "fuzzy.hysteresis=0,0.05"}));
  for (const char* bad : {"1, x", "1,,2", "1, 1", "-5"}) {
    sweep.choose(1, "fuzzy.hysteresis", bad);
    EXPECT_FALSE(sweep.fault().isEmpty()) << bad;
  }
  sweep.choose(1, "lod.screen_space_error_px", "1");
  EXPECT_TRUE(sweep.fault().contains("same"));
}

TEST_F(ErrorDock, theDialogBeginsWithWhatWasMeasuredLast) {
  const ScratchDir dir;
  const QString own = QString::fromStdString((dir / "own.json").string());
  writeFile(dir / "own.json", exportText(defaultParameters(), "own", {}, ExportFormat::json));
  {
    workbench::BenchDialog first("/nowhere");
    auto& list = *first.findChild<QListWidget*>();
    const auto press = [&](const char* text) {
      for (auto* button : first.findChildren<QPushButton*>())
        if (button->text().remove('&') == QLatin1String(text)) button->click();
    };
    press("All");
    EXPECT_EQ(first.choice().presets.size(), list.count());
    press("None");
    EXPECT_TRUE(first.choice().presets.isEmpty());
    list.item(list.count() - 1)->setCheckState(Qt::Checked);
    first.findChildren<QSpinBox*>().front()->setValue(7);
    first.accept();
    QSettings().setValue("bench/presets", QStringList{workbench::BenchChoice::kDraft, own, "/gone.json"});
  }
  const workbench::BenchChoice again = workbench::BenchDialog("/nowhere").choice();
  EXPECT_EQ(again.presets, (QStringList{workbench::BenchChoice::kDraft, own}));
  EXPECT_EQ(again.frames, 7);
  QSettings().remove("bench");
  EXPECT_EQ(workbench::BenchDialog("/nowhere").choice().presets,
            (QStringList{"default", workbench::BenchChoice::kDraft}));
}

TEST_F(ErrorDock, theStripBelowTheViewSaysHowTheBudgetIsKept) {
  look(-9);
  EXPECT_TRUE(waitFor([&] { return w().strip().text().contains("of the last minute"); }))
      << w().strip().text().toStdString();
  EXPECT_TRUE(w().strip().text().contains("longest: ")) << w().strip().text().toStdString();
}

TEST_F(ErrorDock, resultsOfAnotherFlightLeaveTheOpenOneWhereItIs) {
  ASSERT_TRUE(w().controllers().flight->open(
      QString::fromStdString((sourceDir() / "resources/flights/kansai-valley.csv").string())));
  raise();
  dock().liveSwitch().setChecked(false);
  ASSERT_TRUE(dock().openResults(tinyResults()));
  w().panels().flight->seek(2);
  dock().timeline().setFocus();
  for (const int key : {Qt::Key_Home, Qt::Key_Right, Qt::Key_Right})
    QTest::keyClick(&dock().timeline(), Qt::Key(key));
  EXPECT_EQ(w().panels().flight->position(), 2);
  const QString said = w().messages().text();
  EXPECT_EQ(said.count("but the flight kansai-valley.csv is open"), 1) << said.toStdString();
  EXPECT_TRUE(said.contains("yecheon-circuit"));
}

TEST_F(ErrorDock, aRecordedTraceIsMeasuredLikeAnyFlight) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  const ScratchDir dir;
  const QString trace = QString::fromStdString((dir / "own trace.csv").string());
  ASSERT_TRUE(w().controllers().trace->start(trace));
  w().panels().flight->play();
  ASSERT_TRUE(waitFor([&] { return w().feed().playback().position() > 1; }));
  w().panels().flight->pause();
  w().controllers().trace->stop();
  ASSERT_TRUE(w().controllers().flight->open(trace)) << w().messages().text().toStdString();
  raise();
  dock().liveSwitch().setChecked(false);
  workbench::BenchChoice choice;
  choice.presets = QStringList{"default"};
  choice.cases = QStringList{"proposed"};
  choice.size = "96x64";
  choice.frames = 3;
  choice.repeats = 1;
  choice.folder = QString::fromStdString((dir / "bench").string());
  QSignalSpy ended(&dock(), &workbench::ErrorDock::finished);
  dock().measure(choice);
  ASSERT_TRUE(waitFor([&] { return !ended.isEmpty(); }, 180000));
  ASSERT_TRUE(ended.takeFirst().front().toBool()) << w().messages().text().toStdString();
  EXPECT_EQ(dock().results()->units.front().name.flight, "own trace");
  EXPECT_EQ(dock().results()->units.front().frames.size(), 3u);
  EXPECT_TRUE(QFileInfo::exists(trace));
  QTest::keyClick(&dock().timeline(), Qt::Key_Home);
  QTest::keyClick(&dock().timeline(), Qt::Key_Right);
  EXPECT_FALSE(w().messages().text().contains("but the flight"));
}

TEST_F(ErrorDock, measuresPresetsAndTheDraftAsAProgramOfItsOwn) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  raise();
  dock().liveSwitch().setChecked(false);
  ASSERT_TRUE(w().draft().setText("lod.screen_space_error_px", "48").empty());
  const ScratchDir dir;
  workbench::BenchChoice choice;
  choice.presets = {"default", workbench::BenchChoice::kDraft};
  choice.cases = QStringList{"proposed"};
  choice.size = "96x64";
  choice.frames = 3;
  choice.repeats = 1;
  choice.folder = QString::fromStdString((dir / "bench").string());
  QSignalSpy ended(&dock(), &workbench::ErrorDock::finished);
  dock().measure(choice);
  EXPECT_TRUE(dock().running());
  ASSERT_TRUE(waitFor([&] { return !ended.isEmpty(); }, 180000));
  ASSERT_TRUE(ended.takeFirst().front().toBool()) << w().messages().text().toStdString();
  ASSERT_EQ(dock().results()->units.size(), 2u);
  EXPECT_EQ(dock().results()->units[1].name.preset, "draft");
  EXPECT_LT(dock().results()->units[1].frames[1].counts.triangles,
            dock().results()->units[0].frames[1].counts.triangles);

  choice.folder += "2";
  choice.frames = 600;
  dock().measure(choice);
  dock().cancel();
  ASSERT_TRUE(waitFor([&] { return !ended.isEmpty(); }));
  EXPECT_FALSE(ended.takeFirst().front().toBool());
  EXPECT_EQ(dock().results()->units.size(), 2u) << "the results before stay";
}

TEST_F(ErrorDock, refusesResultsThatAreNone) {
  const ScratchDir dir;
  std::ofstream(dir / "results.json") << "{\"units\": 3}";
  drop(dir / "results.json");
  EXPECT_FALSE(dock().results());
  EXPECT_TRUE(w().messages().text().contains("results cannot be opened"));
  EXPECT_FALSE(dock().openResults("/nowhere/results.json"));
}

}  // namespace
}  // namespace trimtab::test
