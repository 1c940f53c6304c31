// SPDX-License-Identifier: GPL-3.0-or-later
#include <QCommandLinkButton>
#include <QFile>
#include <QFileInfo>
#include <QStandardPaths>

#include "app/workbench/controllers/file_kind.h"
#include "app/workbench/controllers/recent_files.h"
#include "app/workbench/controllers/saved_session.h"
#include "app/workbench/docks/changes_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/window/session_keeper.h"
#include "app/workbench/window/welcome.h"
#include "app/workbench/window/workspaces.h"
#include "gui_support.h"
#include "trimtab/policy/policy_file.h"
#include "trimtab/preset/preset.h"

namespace trimtab::test {
namespace {

using workbench::Document;
using workbench::FileKind;
using workbench::fileKindOf;
using workbench::SavedSession;
using workbench::terrainOf;

QString pathIn(const ScratchDir& dir, const std::string& name) {
  return QString::fromStdString((dir / name).string());
}

TEST(SavedSessionFile, comesBackAndMovesWithItsFolder) {
  const ScratchDir dir;
  std::filesystem::create_directories(dir / "here" / "flights");
  SavedSession session;
  session.terrain = "/terrains/alps";
  session.preset = pathIn(dir, "here/mine.json");
  session.imageGenerator = pathIn(dir, "here/viewer.json");
  session.flight = pathIn(dir, "here/flights/low.csv");
  session.flightPositionS = 12.5;
  session.listenPort = 8004;
  session.workspace = "Tune";
  session.eye = {{}, {Degrees{-89.5}, Degrees{180}, Metres{4000}}, {Degrees{359}, Degrees{-90}, Degrees{}}};
  session.views = {
      {"the \"ridge\"", {Degrees{46}, Degrees{8}, Metres{-3}}, {Degrees{1}, Degrees{2}, Degrees{3}}}};
  const auto values = QString::fromStdString(
      R"({"format":"trimtab-preset","name":"C","parameters":{"lod.scale":3},"version":3})");
  session.snapshots = {{{2, "far", values}}};
  session.draft = values;
  const QString file = pathIn(dir, "here/day.session.json");
  ASSERT_TRUE(workbench::writeSession(file, session));
  const auto back = workbench::readSession(file);
  ASSERT_TRUE(back) << toString(back.findings());
  EXPECT_EQ(*back, session);

  std::filesystem::rename(dir / "here", dir / "there");
  const auto moved = workbench::readSession(pathIn(dir, "there/day.session.json"));
  ASSERT_TRUE(moved) << toString(moved.findings());
  EXPECT_EQ(moved->flight, pathIn(dir, "there/flights/low.csv"));
  EXPECT_EQ(moved->terrain, session.terrain) << "outside the folder nothing moves";

  session.preset = "as-published";
  ASSERT_TRUE(workbench::writeSession(pathIn(dir, "there/day.session.json"), session));
  EXPECT_EQ(workbench::readSession(pathIn(dir, "there/day.session.json"))->preset, "as-published");
}

TEST(SavedSessionFile, namesWhatIsWrong) {
  const ScratchDir dir;
  const QString file = pathIn(dir, "bad.session.json");
  const struct {
    const char *text, *says;
  } cases[] = {
      {"", "JSON"},
      {"{\n\"trimtab_session\": 1,\n\"views\": [}", ":3"},
      {"{}", "trimtab_session"},
      {R"({"trimtab_session": 9})", "found 9"},
      {R"({"trimtab_session": 1, "terrain": 7})", "terrain: expected a text, found 7"},
      {R"({"trimtab_session": 1, "listen_port": 99999})", "listen_port: expected a number from 1 to 65535"},
      {R"({"trimtab_session": 1, "listen_port": "8004"})", "listen_port"},
      {R"({"trimtab_session": 1, "flight_position_s": -1})", "flight_position_s"},
      {R"({"trimtab_session": 1, "eye": []})", "eye: expected an object"},
      {R"({"trimtab_session": 1, "eye": {"latitude_deg": 91}})", "eye.latitude_deg"},
      {R"({"trimtab_session": 1, "views": [{"name": "a"}]})", "views[0].height_m"},
      {R"({"trimtab_session": 1, "views": 3})", "views: expected a list"},
      {R"({"trimtab_session": 1, "snapshots": [{"slot": "D", "preset": {}}]})", "snapshots[0].slot"},
      {R"({"trimtab_session": 1, "snapshots": [{"slot": "A", "preset": 1}]})", "snapshots[0].preset"},
      {R"({"trimtab_session": 1, "draft": "x"})", "draft: expected an object"},
      {R"({"trimtab_session": 1, "draft": {"format": "trimtab-preset", "version": 3, "name": "",
           "parameters": {"lod.screen_space_error_px": -1}}})",
       "draft"},
      {R"({"trimtab_session": 1, "snapshots": [{"slot": "A", "preset": {"format": "trimtab-preset",
           "version": 3, "name": "", "parameters": {"lod.screen_space_error_px": -1}}}]})",
       "lod.screen_space_error_px"},
  };
  for (const auto& c : cases) {
    writeFile(dir / "bad.session.json", c.text);
    const auto read = workbench::readSession(file);
    ASSERT_FALSE(read) << c.text;
    EXPECT_NE(toString(read.findings()).find(c.says), std::string::npos)
        << c.text << ": " << toString(read.findings());
  }
  EXPECT_FALSE(workbench::readSession(pathIn(dir, "none.session.json")));
  EXPECT_FALSE(workbench::writeSession(pathIn(dir, "no/folder/x.session.json"), {}));
}

TEST(FileKinds, areToldByNameAndFirstLine) {
  const ScratchDir dir;
  const auto kindOf = [&](const std::string& name, const std::string& text) {
    writeFile(dir / name, text);
    return fileKindOf(pathIn(dir, name));
  };
  EXPECT_EQ(kindOf("results.json", "{}"), FileKind::results);
  EXPECT_EQ(kindOf("a.workspace.json", "{}"), FileKind::workspace);
  EXPECT_EQ(kindOf("a.session.json", "{}"), FileKind::session);
  EXPECT_EQ(kindOf("a.JSON", "{}"), FileKind::preset);
  EXPECT_EQ(kindOf("manifest.json", "{}"), FileKind::terrain);
  EXPECT_EQ(terrainOf(pathIn(dir, "a.tif")), pathIn(dir, "a.tif"));
  EXPECT_EQ(terrainOf(pathIn(dir, "manifest.json")), QString::fromStdString(dir.path().string()))
      << "which is what a file manager opens of a baked database";
  EXPECT_EQ(kindOf("a.fll", ""), FileKind::rules);
  EXPECT_EQ(kindOf("a.FIS", ""), FileKind::rules);
  EXPECT_EQ(kindOf("a.pcap", ""), FileKind::flight);
  EXPECT_EQ(kindOf("a.csv", "# a comment\ntime_s,latitude_deg,longitude_deg,heading_deg\n"),
            FileKind::flight);
  EXPECT_EQ(kindOf("a.csv", "time_s,head_heading_deg,head_pitch_deg\n"), FileKind::head_log);
  EXPECT_EQ(kindOf("a.txt", "timestamp viewpoint yaw pitch roll\n"), FileKind::head_log);
  EXPECT_EQ(kindOf("a.csv", ""), FileKind::flight);
  EXPECT_EQ(kindOf("a.tif", ""), FileKind::terrain);
  EXPECT_EQ(fileKindOf(QString::fromStdString(dir.path().string())), FileKind::terrain);
  EXPECT_EQ(fileKindOf(pathIn(dir, "gone.json")), FileKind::terrain) << "which says that it is not there";
}

TEST(ShippedFlights, areThoseOfTheTreeOrBesideAnInstalledProgram) {
  EXPECT_EQ(QFileInfo(workbench::shippedFlights().value(0)).dir().dirName(), "flights");
  EXPECT_EQ(workbench::shippedFlights().size(), 3);
  // Where an installation has them, seen from the program.
  const std::filesystem::path share = programDir().parent_path() / "share";
  ASSERT_FALSE(std::filesystem::exists(share));
  std::filesystem::create_directories(share / "trimtab/flights");
  writeFile(share / "trimtab/flights/one.csv", "");
  const QStringList installed = workbench::shippedFlights();
  std::filesystem::remove_all(share);
  ASSERT_EQ(installed.size(), 1);
  EXPECT_EQ(QFileInfo(installed.first()).fileName(), "one.csv");
}

class WorkbenchSession : public Bench {
 protected:
  workbench::SessionKeeper& sessions() { return w().sessions(); }
  const workbench::FlightDock& flight() { return w().controllers().flight->flightDock(); }
  ScratchDir dir;
};

TEST_F(WorkbenchSession, aFileOpensAllOfItAgain) {
  workbench::FreeCamera& camera = w().viewport().camera();
  const GeodeticPosition ridge{camera.position().latitude, camera.position().longitude, Metres{2500}};
  w().controllers().flight->placeCamera(ridge, {Degrees{123}, Degrees{-20}, Degrees{}});
  sessions().keepView("ridge");
  w().controllers().document->open("as-published");
  w().workspaces().show(3);
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  w().controllers().flight->flightDock().seek(30);
  const QString file = pathIn(dir, "day.session.json");
  ASSERT_TRUE(sessions().saveTo(file)) << w().messages().text().toStdString();

  w().controllers().document->open("default");
  w().workspaces().show(0);
  w().controllers().flight->flightDock().close();
  sessions().forgetView(0);
  w().controllers().flight->placeCamera();
  EXPECT_TRUE(sessions().views().empty());
  const auto* before = w().controllers().terrain->database().get();
  w().openAny(file);
  ASSERT_TRUE(waitFor([&] { return w().controllers().terrain->database().get() != before; }));
  EXPECT_TRUE(w().controllers().document->document().title().contains("as-published"));
  EXPECT_EQ(w().workspaces().current(), 3);
  EXPECT_EQ(flight().file(), QFileInfo(QString::fromStdString(sampleFlight())).absoluteFilePath());
  EXPECT_NEAR(flight().position(), 30, 0.5);
  ASSERT_EQ(sessions().views().size(), 1u);
  EXPECT_EQ(sessions().views()[0].name, "ridge");
  EXPECT_EQ(camera.position(), ridge);
  EXPECT_EQ(camera.attitude().heading.value(), 123);
}

TEST_F(WorkbenchSession, holdsTheUnsavedEditsOfAPresetsFileAndLeavesTheFileAlone) {
  Document& document = w().controllers().document->document();
  const QString preset = pathIn(dir, "mine.json"), file = pathIn(dir, "day.session.json");
  ASSERT_TRUE(w().controllers().document->saveTo(preset));
  const std::string bytes = readFile(dir / "mine.json");
  ASSERT_TRUE(w().draft().setText("lod.screen_space_error_px", "7").empty());
  ASSERT_TRUE(w().draft().setText("weather.step", "rain_heavy").empty());
  const TuningParameters edited = w().draft().parameters();
  ASSERT_TRUE(sessions().saveTo(file)) << w().messages().text().toStdString();
  EXPECT_TRUE(w().draft().isDirty()) << "the preset itself is not saved";

  w().draft().undoStack().setClean();
  ASSERT_TRUE(w().controllers().document->open("default"));
  ASSERT_TRUE(sessions().open(file)) << w().messages().text().toStdString();
  EXPECT_EQ(document.file(), preset);
  EXPECT_TRUE(differences(w().draft().parameters(), edited).empty());
  EXPECT_TRUE(w().isWindowModified()) << "changed against its file";
  EXPECT_TRUE(w().draft().isChanged("lod.screen_space_error_px"));
  EXPECT_EQ(readFile(dir / "mine.json"), bytes);
  document.keepCopyNow();
  EXPECT_TRUE(QFile::exists(QStandardPaths::writableLocation(QStandardPaths::AppLocalDataLocation) +
                            QStringLiteral("/recovery/%1.json").arg(QCoreApplication::applicationPid())))
      << "a crash does not lose them either";
  w().draft().undoStack().undo();
  EXPECT_FALSE(w().draft().isDirty()) << "one step leads back to the file";
  EXPECT_NE(w().draft().parameters().lod.screenSpaceError.value(), 7);

  // Without edits there is nothing to hold.
  ASSERT_TRUE(sessions().saveTo(file));
  EXPECT_FALSE(workbench::readSession(file)->draft);
}

TEST_F(WorkbenchSession, holdsAPresetThatHasNoFileYet) {
  const QString file = pathIn(dir, "day.session.json");
  w().controllers().document->startFrom("low-level");
  const TuningParameters begun = w().draft().parameters();
  ASSERT_TRUE(w().draft().setText("lod.screen_space_error_px", "7").empty());
  ASSERT_TRUE(sessions().saveTo(file));
  w().draft().undoStack().setClean();
  ASSERT_TRUE(w().controllers().document->open("default"));
  ASSERT_TRUE(sessions().open(file));
  EXPECT_EQ(w().controllers().document->document().title(), "untitled");
  EXPECT_EQ(w().draft().preset().base, "low-level");
  EXPECT_EQ(w().draft().parameters().lod.screenSpaceError.value(), 7);
  EXPECT_TRUE(w().draft().isDirty());
  w().draft().undoStack().undo();
  EXPECT_TRUE(differences(w().draft().parameters(), begun).empty());

  // Without edits too: no file says what it began as.
  ASSERT_TRUE(sessions().saveTo(file));
  ASSERT_TRUE(w().controllers().document->open("default"));
  ASSERT_TRUE(sessions().open(file));
  EXPECT_TRUE(differences(w().draft().parameters(), begun).empty());
  EXPECT_FALSE(w().draft().isDirty());
}

TEST_F(WorkbenchSession, holdsTheEditsOfAPresetWhoseFileIsGone) {
  const QString preset = pathIn(dir, "mine.json"), file = pathIn(dir, "day.session.json");
  ASSERT_TRUE(w().controllers().document->saveTo(preset));
  ASSERT_TRUE(w().draft().setText("lod.screen_space_error_px", "7").empty());
  ASSERT_TRUE(sessions().saveTo(file));
  w().draft().undoStack().setClean();
  ASSERT_TRUE(w().controllers().document->open("as-published"));
  std::filesystem::remove(dir / "mine.json");
  ASSERT_TRUE(sessions().open(file));
  EXPECT_EQ(w().draft().parameters().lod.screenSpaceError.value(), 7);
  EXPECT_TRUE(w().draft().isDirty());
  EXPECT_TRUE(w().messages().text().contains("mine.json")) << "which is missing";
}

TEST_F(WorkbenchSession, ofAnEarlierVersionOpensItsPresetAsItIs) {
  writeFile(dir / "old.session.json", R"({"trimtab_session": 1, "preset": "as-published", "terrain": ")" +
                                          sampleTerrain().string() + R"("})");
  ASSERT_TRUE(sessions().open(pathIn(dir, "old.session.json"))) << w().messages().text().toStdString();
  EXPECT_EQ(w().controllers().document->document().title(), "as-published");
  EXPECT_FALSE(w().draft().isDirty());
}

TEST_F(WorkbenchSession, keepsTheLastOneForTheNextStart) {
  sessions().keepView("start");
  ASSERT_TRUE(w().draft().setText("lod.screen_space_error_px", "7").empty());
  w().panels().changes->snapshots().keep(1);
  w().panels().changes->snapshots().rename(1, "coarse");
  ASSERT_NO_FATAL_FAILURE(restart());
  EXPECT_TRUE(sessions().views().empty()) << "nobody asked for it yet";
  ASSERT_TRUE(QFileInfo::exists(workbench::SessionKeeper::lastFile()));
  ASSERT_TRUE(sessions().open(workbench::SessionKeeper::lastFile()));
  ASSERT_EQ(sessions().views().size(), 1u);
  EXPECT_EQ(sessions().views()[0].name, "start");
  views::Snapshots& snapshots = w().panels().changes->snapshots();
  EXPECT_FALSE(snapshots.isKept(0));
  ASSERT_TRUE(snapshots.isKept(1));
  EXPECT_EQ(snapshots.name(1), "coarse");
  EXPECT_NE(w().draft().parameters().lod.screenSpaceError.value(), 7) << "unsaved edits are the preset's";
  snapshots.switchTo(1);
  EXPECT_EQ(w().draft().parameters().lod.screenSpaceError.value(), 7);
}

TEST_F(WorkbenchSession, viewsAreKeptReplacedAndForgotten) {
  workbench::FreeCamera& camera = w().viewport().camera();
  const GeodeticPosition first = camera.position();
  sessions().keepView("a");
  sessions().keepView("b");
  camera.place({first.latitude, first.longitude, first.height + Metres{100}}, camera.attitude());
  sessions().keepView("b");
  ASSERT_EQ(sessions().views().size(), 2u);
  sessions().goToView(0);
  EXPECT_EQ(camera.position(), first);
  trigger("b");
  EXPECT_EQ(camera.position().height, first.height + Metres{100});
  sessions().forgetView(0);
  sessions().forgetView(7);
  ASSERT_EQ(sessions().views().size(), 1u);
  EXPECT_EQ(sessions().views()[0].name, "b");
}

TEST_F(WorkbenchSession, aViewThatIsKeptInFlightIsThePilots) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  const GeodeticPosition left = w().viewport().camera().position();
  w().panels().flight->play();
  ASSERT_TRUE(waitFor([&] { return flight().position() > 1; }));
  w().panels().flight->pause();
  ASSERT_FALSE(w().viewport().cameraEnabled());
  sessions().keepView("cockpit");
  ASSERT_EQ(sessions().views().size(), 1u);
  EXPECT_EQ(sessions().views()[0].position, workbench::seatOf(session()).position);
  EXPECT_NE(sessions().views()[0].position, left);
  sessions().goToView(0);
  EXPECT_EQ(w().viewport().camera().position(), left) << "the flight moves the view";
  EXPECT_TRUE(w().messages().text().contains("detach it"));
}

TEST_F(WorkbenchSession, aDamagedFileChangesNothing) {
  const QString title = w().windowTitle();
  const int workspace = w().workspaces().current();
  const QString file = pathIn(dir, "bad.session.json");
  writeFile(dir / "bad.session.json", R"({"trimtab_session": 1, "preset": "as-published", "views": 3})");
  EXPECT_FALSE(sessions().open(file));
  EXPECT_EQ(w().windowTitle(), title);
  EXPECT_EQ(w().workspaces().current(), workspace);
  EXPECT_TRUE(w().messages().text().contains("views"));
}

TEST_F(WorkbenchSession, headLogsAndRulesCanBeDropped) {
  writeFile(dir / "head.txt",
            "timestamp yaw_rad pitch_rad roll_rad\n0 0 0 0\n0.1 0.1 0.05 0\n0.2 0.2 0.05 0\n");
  drop(dir / "head.txt");
  EXPECT_EQ(session().head().source(), HeadInput::Source::log) << w().messages().text().toStdString();
  Policy policy;
  policy.terms = {{Signal::altitude, "low", TermShape::ramp, {2000, 1000}}};
  policy.rules = {{"altitude is low", {{Lever::lod_scale, 2}}, 1, true, ""}};
  writeFile(dir / "policy.fll", *toFuzzyLite(policy, "p"));
  drop(dir / "policy.fll");
  EXPECT_FALSE(w().draft().parameters().policy.rules.line.empty()) << w().messages().text().toStdString();
  EXPECT_TRUE(w().draft().isDirty());
}

TEST_F(WorkbenchSession, theImageFillsItsPlaceUnlessTheLetterboxIsChosen) {
  const auto wanted = [&] { return w().viewport().size() * w().viewport().devicePixelRatioF(); };
  const auto drawn = [&] {
    const auto& shown = w().controllers().frame->shown();
    return shown ? QSize(shown->view.widthPx, shown->view.heightPx) : QSize();
  };
  w().resize(1500, 800);
  ASSERT_TRUE(waitFor([&] { return drawn() == wanted(); }));
  const ViewShape filled = w().controllers().frame->shown()->view;
  EXPECT_NEAR(filled.widthPx / (filled.right - filled.left), filled.heightPx / (filled.top - filled.bottom),
              1e-6)
      << "pixels are square";
  QAction* const fills = command("Fill the viewport");
  ASSERT_NE(fills, nullptr);
  EXPECT_TRUE(fills->isChecked());
  fills->trigger();
  const ViewParameters& own = w().draft().active()->view;
  const ViewShape preset = viewShape(own, 1, 1, {});
  ASSERT_TRUE(waitFor([&] { return w().controllers().frame->shown()->view.right == preset.right; }));
  EXPECT_NE(drawn(), wanted());
  fills->trigger();
  ASSERT_TRUE(waitFor([&] { return drawn() == wanted(); }));
}

TEST_F(WorkbenchSession, theWelcomePageTakesOneWayAndCloses) {
  sessions().saveTo(pathIn(dir, "night.session.json"));
  trigger("Welcome page");
  const auto page = [&] { return w().findChild<workbench::Welcome*>(); };
  ASSERT_NE(page(), nullptr);
  QStringList ways;
  for (const auto* way : page()->findChildren<QCommandLinkButton*>()) ways << way->text();
  for (const char* wanted :
       {"night.session.json", "The sample terrain", "The sample flight", "A host", "A flight", "A terrain"})
    EXPECT_TRUE(ways.contains(QString::fromLatin1(wanted)))
        << wanted << " in " << ways.join(", ").toStdString();
  if (const QString shots = qEnvironmentVariable("TRIMTAB_SHOTS"); !shots.isEmpty()) {
    QTest::qWait(500);
    page()->grab().save(shots + "/welcome.png");
  }
  for (auto* way : page()->findChildren<QCommandLinkButton*>())
    if (way->text() == QLatin1String("A host")) {
      way->click();
      break;
    }
  EXPECT_EQ(w().workspaces().names()[w().workspaces().current()], "Connect");
  EXPECT_TRUE(waitFor([&] { return page() == nullptr; }));
}

TEST_F(WorkbenchSession, theWelcomePageFliesTheSampleFlight) {
  trigger("Welcome page");
  for (auto* way : w().findChild<workbench::Welcome*>()->findChildren<QCommandLinkButton*>())
    if (way->text() == QLatin1String("The sample flight")) {
      way->click();
      break;
    }
  EXPECT_TRUE(waitFor([&] { return w().feed().playback().position() > 0.2; }));
  EXPECT_TRUE(waitFor([&] { return w().controllers().terrain->askedFor().isEmpty(); }))
      << "over the terrain that is in the program";
}

}  // namespace
}  // namespace trimtab::test
