// SPDX-License-Identifier: GPL-3.0-or-later
#include <QSignalSpy>
#include <QtWidgets>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <tuple>

#include "app/workbench/controllers/recent_files.h"
#include "app/workbench/docks/answer_page.h"
#include "app/workbench/docks/error_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "app/workbench/viewport/split_view.h"
#include "app/workbench/window/palette.h"
#include "app/workbench/window/workspaces.h"
#include "gui_support.h"
#include "hand.h"
#include "tests/app/ig_support.h"
#include "trimtab/preset/preset.h"
#include "views/controls/parameter_of.h"
#include "views/editors/band_edit.h"
#include "views/editors/band_scale.h"
#include "views/editors/curve_plot.h"
#include "views/editors/membership_editor.h"
#include "views/panels/plots_panel.h"
#include "views/plots/time_plot.h"
#include "views/policy/policy_panel.h"
#include "views/policy/rules_page.h"

namespace trimtab::test {
namespace {

/// Does in one window what an engineer does in a day, task by task; methods of the program only look at what
/// came of it. TRIMTAB_SHOTS names a folder for a screenshot of each task and of each workspace, and for
/// those of the README; TRIMTAB_SHOT_SIZE is WxH, TRIMTAB_SHOT_THEME light or dark.
class Tour : public Bench {
 protected:
  void SetUp() override {
    QCoreApplication::setAttribute(Qt::AA_DontUseNativeDialogs);
    if (const QString theme = qEnvironmentVariable("TRIMTAB_SHOT_THEME"); !theme.isEmpty())
      QSettings().setValue(QStringLiteral("window/appearance"), theme == QLatin1String("dark") ? 2 : 1);
    window = std::make_unique<workbench::MainWindow>();
    hand_.emplace(w());
  }
  void takeTheTour() {
    using Task = std::tuple<const char*, int, void (Tour::*)()>;
    const Task tasks[] = {{"first-minute", 2, &Tour::firstMinute},
                          {"curve-and-parameter", 6, &Tour::curveAndParameter},
                          {"band-of-the-depth-map", 6, &Tour::bandOfTheDepthMap},
                          {"freeze-and-detach", 6, &Tour::freezeAndDetach},
                          {"head-sweep", 6, &Tour::headSweep},
                          {"heavy-rain", 5, &Tour::heavyRain},
                          {"plots", 9, &Tour::plots},
                          {"compare-two-presets", 7, &Tour::compareTwoPresets},
                          {"measure-a-flight", 11, &Tour::measureAFlight},
                          {"switch-off-a-rule", 6, &Tour::switchOffARule},
                          {"export-and-again", 5, &Tour::exportAndAgain},
                          {"record-and-replay", 9, &Tour::recordAndReplay}};
    QString table = QStringLiteral("task | clicks and keys | at most\n");
    int number = 0;
    for (const auto& [name, most, run] : tasks) {
      SCOPED_TRACE(name);
      shot_ = QStringLiteral("tour-%1-%2.png").arg(++number, 2, 10, QLatin1Char('0')).arg(name);
      hand_->begin();
      (this->*run)();
      shoot();
      EXPECT_TRUE(hand_->answered()) << "a dialog has not come";
      const auto count = hand_->steps().size();
      EXPECT_LE(count, most) << hand_->steps().join(QStringLiteral(", ")).toStdString();
      table += QStringLiteral("%1 | %2 | %3\n").arg(name).arg(count).arg(most);
      if (last().visible.triangles == 0) break;  // nothing works without an image
    }
    std::cout << table.toStdString() << std::flush;
    shootWorkspaces();
    shootPages();
  }
  /// Saves a screenshot of each workspace as it ships, while the flight plays.
  void shootWorkspaces() {
    if (qEnvironmentVariable("TRIMTAB_SHOTS").isEmpty()) return;
    front("plots");
    hand_->press(*w().panels().plots, "Details");
    hand_->press(*w().panels().plots, "Pause");
    ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
    w().feed().seekHere(545);  // on final approach, with the airfield ahead
    w().feed().playHere();
    EXPECT_FALSE(w().controllers().errors->splitView().overViewport()) << "left as it was before comparing";
    for (int i = 0; w().workspaces().ships(i); ++i) {
      w().workspaces().show(i);
      w().workspaces().reset();
      QTest::qWait(2500);
      const QString name = w().workspaces().names()[i].toLower();
      shot_ = QStringLiteral("workspace-%1-%2.png").arg(i + 1).arg(name);
      shoot();
    }
  }
  /// Saves what the README shows: docks by themselves, and a frozen visible set from outside.
  void shootPages() {
    if (qEnvironmentVariable("TRIMTAB_SHOTS").isEmpty()) return;
    workspace("Tune");
    const auto shootDock = [this](const char* dock, const char* page, const char* file) {
      front(dock);
      hand_->press(*w().dock(dock), page);
      QTest::qWait(1500);
      const QString name = QString::fromLatin1(file);
      EXPECT_TRUE(w().dock(dock)->grab().save(qEnvironmentVariable("TRIMTAB_SHOTS") + '/' + name)) << file;
    };
    EXPECT_TRUE(w().draft().setText("culling.occlusion", "depth_map").empty());
    shootDock("policy", "Terms", "policy.png");
    shootDock("culling", "Culling", "culling.png");
    shootDock("culling", "Depth map", "depth-map.png");
    w().feed().pauseHere();
    trigger("Colour by reason");
    trigger("Freeze culling");
    EXPECT_TRUE(waitFor([this] { return banner().contains("FROZEN"); }) && settle());
    workbench::FreeCamera& camera = w().viewport().camera();
    // From 4 km behind the eye and 1.5 km above it, the frustum lies ahead.
    const double heading = camera.attitude().heading.in<Radians>(), behindDeg = 4000 / 111000.0;
    GeodeticPosition place = camera.position();
    place.latitude = place.latitude - Degrees{behindDeg * std::cos(heading)};
    place.longitude =
        place.longitude - Degrees{behindDeg * std::sin(heading) / std::cos(place.latitude.in<Radians>())};
    place.height = place.height + Metres{1500};
    camera.place(place, {camera.attitude().heading, Degrees{-20}, Degrees{0}});
    w().viewport().invalidate();
    EXPECT_TRUE(settle());
    shot_ = QStringLiteral("frozen.png");
    shoot();
  }
  /// Saves the task's screenshot: at its end, unless the task has more to show before.
  void shoot() {
    const QString folder = qEnvironmentVariable("TRIMTAB_SHOTS");
    if (folder.isEmpty() || shot_.isEmpty()) return;
    EXPECT_TRUE(w().grab().save(folder + QLatin1Char('/') + shot_)) << folder.toStdString();
    shot_.clear();
  }
  /// Presses the keys that the menus show beside a command.
  void keysOf(const char* text) {
    const QAction* const action = command(QString::fromLatin1(text));
    ASSERT_TRUE(action != nullptr && action->isEnabled() && !action->shortcut().isEmpty()) << text;
    hand_->key(action->shortcut()[0]);
  }
  /// Clicks the button of a workspace, unless it is the current one.
  void workspace(const QString& name) {
    if (w().workspaces().names()[w().workspaces().current()] != name) hand_->press(*w().menuBar(), name);
  }
  /// Clicks the tab of a dock, unless the dock is in front.
  void front(const char* name) {
    QDockWidget& dock = *w().dock(QString::fromLatin1(name));
    if (!workbench::isInFront(dock)) hand_->press(w(), dock.windowTitle());
    EXPECT_TRUE(comesToFront(name)) << name;
  }
  void turnTheView() {
    const QPoint middle = w().viewport().rect().center();
    const Attitude before = sight();
    hand_->drag(w().viewport(), middle, middle + QPoint(-120, 20), "the view");
    EXPECT_NE(sight(), before);
  }
  /// Clicks the box at the left of a row.
  void clickBox(QAbstractItemView& list, const QModelIndex& item, const QString& what) {
    const QRect row = list.visualRect(item);
    hand_->click(*list.viewport(), {row.left() + 10, row.center().y()}, what);
  }
  Attitude sight() { return w().viewport().camera().attitude(); }
  QString banner() { return w().viewport().overlayContents().banner; }

  void firstMinute() {
    const QStringList sides = qEnvironmentVariable("TRIMTAB_SHOT_SIZE", "1280x720").split(QLatin1Char('x'));
    workbench::Options options;
    options.terrain = QString::fromStdString(sampleTerrain().string());
    options.window = QSize(sides.value(0).toInt(), sides.value(1).toInt());
    options.welcome = true;
    hand_->inDialog([this](QWidget& welcome) { hand_->press(welcome, "Close"); });
    w().start(options);
    ASSERT_TRUE(waitFor([&] { return hand_->answered() && w().viewport().lastResult() != nullptr; }))
        << w().messages().text().toStdString();
    workspace("Tune");
    const std::uint64_t painted = paints();
    turnTheView();
    EXPECT_EQ(session().input().state.attitude, sight());
    EXPECT_TRUE(waitFor([&] { return paints() > painted; }));
  }
  void curveAndParameter() {
    views::CurvePlot& plot = w().findChild<views::MembershipEditor*>()->altitude().plot();
    hand_->drag(plot, plot.pixelOf({5000, 0.6}).toPoint(), plot.pixelOf({4600, 0.5}).toPoint(), "a point");
    const CurvePoints curve = w().draft().parameters().altitude.curve;
    EXPECT_NEAR(curve.point[1].x, 4600, 60);
    EXPECT_NEAR(curve.point[1].y, 0.5, 0.03);
    keysOf("Find anything");
    auto* const palette = w().findChild<workbench::Palette*>();
    ASSERT_TRUE(waitFor([&] { return palette->isVisible() && palette->input().hasFocus(); }));
    hand_->type("allowed error");
    hand_->key(Qt::Key_Return);
    ASSERT_TRUE(waitFor([] { return views::parameterOf(QApplication::focusWidget()).startsWith("lod.s"); }));
    hand_->type("4");
    hand_->key(Qt::Key_Return);
    EXPECT_EQ(w().draft().parameters().lod.screenSpaceError.value(), 4);
  }
  void bandOfTheDepthMap() {
    front("culling");
    QDockWidget& dock = *w().dock("culling");
    hand_->press(dock, "Depth map");
    auto& scale = *dock.findChild<views::BandScale*>();
    hand_->drag(scale, scale.pixelOf(1.0).toPoint(), scale.pixelOf(1.2).toPoint(), "an edge");
    auto& table = *dock.findChild<QTableView*>();
    const QModelIndex width = table.model()->index(2, views::kBandWidth);
    hand_->click(*table.viewport(), table.visualRect(width).center(), "a width");
    hand_->type("512");
    hand_->key(Qt::Key_Return);
    const Band& band = w().draft().parameters().scheme.bands.band[2];
    EXPECT_NEAR(band.low, 1.2, 0.03);
    EXPECT_EQ(band.widthPx, 512);
  }
  void freezeAndDetach() {
    ASSERT_TRUE(settle());
    const auto seen = last().visible.reason;
    hand_->press(w(), "Freeze culling");
    EXPECT_TRUE(waitFor([this] { return banner().contains("FROZEN"); }));
    turnTheView();
    EXPECT_TRUE(settle());
    EXPECT_EQ(last().visible.reason, seen) << "frozen";
    hand_->press(w(), "Freeze culling");
    EXPECT_TRUE(waitFor([this] { return banner().isEmpty(); }) && settle());
    EXPECT_NE(last().visible.reason, seen);
    const GeodeticPosition seat = w().viewport().camera().position();
    hand_->press(w(), "Detach");
    EXPECT_TRUE(waitFor([this] { return banner().contains("DETACHED"); }));
    turnTheView();
    EXPECT_TRUE(settle());
    shoot();
    hand_->press(w(), "Detach");
    EXPECT_TRUE(waitFor([this] { return banner().isEmpty(); }));
    EXPECT_EQ(w().viewport().camera().position(), seat) << "back in the seat";
  }
  void headSweep() {
    workspace("Fly");
    QDockWidget& dock = *w().dock("flight");
    hand_->press(dock, "Head motion");
    hand_->choose(dock, "Line of sight", "a sweep");
    EXPECT_TRUE(waitFor([this] { return session().decision().motion.lodScale > 1; }));
    shoot();
    hand_->choose(dock, "Line of sight", "as the host says");
    EXPECT_FALSE(session().input().state.head);
    EXPECT_TRUE(settle()) << "the head rests";
  }
  void heavyRain() {
    workspace("Tune");
    front("weather");
    hand_->choose(*w().dock("weather"), "Weather", "Heavy rain");
    EXPECT_EQ(w().draft().parameters().weather.step, WeatherStep::rain_heavy);
    EXPECT_TRUE(waitFor([this] { return last().counters.precipitationPasses > 0; }));
    shoot();
    keysOf("Undo");
    EXPECT_TRUE(waitFor([this] { return session().decision().weather.density == 0; }));
  }
  void plots() {
    front("plots");
    views::PlotsPanel& panel = *w().panels().plots;
    hand_->press(panel, "Details");
    hand_->press(panel, "Signals");
    auto& search = *panel.signalList().parentWidget()->findChild<QLineEdit*>();
    hand_->click(search, search.rect().center(), "the search");
    hand_->type("band");
    hand_->key(Qt::Key_Return);
    EXPECT_EQ(std::ranges::count(panel.plot().lanes().front().traces, views::Trace::band), 1);
    hand_->choose(panel, "Time shown", "10 s");
    EXPECT_NEAR(panel.plot().span(), 10, 1e-6);
    hand_->press(panel, "Pause");
    EXPECT_TRUE(panel.isPaused());
  }
  void compareTwoPresets() {
    workbench::SplitView& split = w().controllers().errors->splitView();
    using Form = workbench::SplitPicture::Form;
    keysOf("In the viewport");
    EXPECT_TRUE(split.overViewport());
    EXPECT_TRUE(comesToFront(split));
    hand_->choose(split, "Preset on the right", "as-published");
    ASSERT_TRUE(waitFor([&] { return split.comparisons() > 0 && split.upToDate(); }))
        << w().messages().text().toStdString();
    EXPECT_GT(split.heatMap().largest(), 0);
    EXPECT_EQ(split.numbers().verticalHeaderItem(1)->text(), "Right: as-published");
    keysOf("Flicker between both");
    EXPECT_EQ(split.overlay().form(), Form::left);
    keysOf("Flicker between both");
    EXPECT_EQ(split.overlay().form(), Form::right);
    keysOf("Differences");
    EXPECT_EQ(split.overlay().form(), Form::difference);
    shoot();
    keysOf("In the viewport");
    EXPECT_FALSE(split.overViewport());
  }
  void measureAFlight() {
    hand_->inFileDialog(sampleFlight());
    keysOf("Open flight");
    ASSERT_TRUE(w().feed().playback().loaded()) << w().messages().text().toStdString();
    hand_->inDialog([this](QWidget& dialog) {
      // The underlined letters of Size, Frames and Repeats select what these fields have.
      for (const auto& [to, text] : {std::pair{Qt::Key_S, "96x64"}, {Qt::Key_F, "2"}, {Qt::Key_R, "1"}}) {
        hand_->key(Qt::ALT | to);
        hand_->type(text);
      }
      hand_->press(dialog, "Measure");
    });
    workbench::ErrorDock& dock = w().controllers().errors->dock();
    QSignalSpy ended(&dock, &workbench::ErrorDock::finished);
    keysOf("Measure presets along it");
    ASSERT_TRUE(waitFor([&] { return !ended.isEmpty(); }, 180000));
    ASSERT_TRUE(ended.front().front().toBool()) << w().messages().text().toStdString();
    EXPECT_TRUE(comesToFront("errors") && dock.answer().isVisible()) << "the answer is there to read";
    EXPECT_EQ(w().workspaces().current(), workbench::Workspaces::kMeasure) << "where there is the width";
    EXPECT_EQ(dock.answer().table().rowCount(), 4) << "two presets in two culling cases";
  }
  void switchOffARule() {
    workspace("Tune");
    front("policy");
    views::PolicyPanel& panel = *w().panels().policy;
    hand_->pressInMenu(panel, "Start from", "low-level");
    hand_->press(panel, "Rules");
    QTableView& table = panel.parts().rules->table();
    clickBox(table, table.model()->index(0, 0), "a rule");
    const PolicyParameters& policy = w().draft().parameters().policy;
    EXPECT_TRUE(policy.enabled && !w().draft().isBroken());
    ASSERT_FALSE(policy.rules.line.empty());
    EXPECT_TRUE(policy.rules.line.front().starts_with("off ")) << policy.rules.line.front();
  }
  void exportAndAgain() {
    const std::filesystem::path file = dir_ / "tour.json";
    hand_->inDialog([this](QWidget& dialog) { hand_->press(dialog, "OK"); });
    hand_->inFileDialog(file);
    keysOf("Export for an image generator");
    ASSERT_TRUE(std::filesystem::exists(file)) << w().messages().text().toStdString();
    const IgProcess ig({"--preset", file.string(), "--terrain", sampleTerrain().string(), "--listen", "0",
                        "--headless", "--size", "160x90", "--watch"});
    ASSERT_NE(ig.port(), 0) << ig.err();
    keysOf("Export again");
    EXPECT_TRUE(ig.says("loaded again")) << ig.err();
    const auto exported = loadPreset(file.string());
    ASSERT_TRUE(exported) << toString(exported.findings());
    EXPECT_TRUE(differences(exported->parameters, w().draft().parameters()).empty());
  }
  void recordAndReplay() {
    const std::filesystem::path file = dir_ / "tour.csv";
    const QString name = QString::fromStdString(file.string());
    const workbench::FlightPlayback& playback = w().feed().playback();
    keysOf("Play or pause");
    hand_->inFileDialog(file);
    keysOf("Record trace");
    const double from = playback.position();
    ASSERT_TRUE(waitFor([&] { return playback.position() > from + 1; }));
    shoot();
    keysOf("Record trace");
    EXPECT_EQ(w().controllers().trace->recorded(), name);
    EXPECT_EQ(workbench::recentFiles("flight").value(0), name);
    hand_->inFileDialog(file);
    keysOf("Open flight");
    EXPECT_EQ(w().controllers().flight->flightDock().file(), name) << w().messages().text().toStdString();
    keysOf("Play or pause");
    EXPECT_TRUE(waitFor([&] { return playback.playing() && playback.position() > 0.2; }));
  }

  std::optional<Hand> hand_;
  QString shot_;  ///< the name of this task's screenshot; empty once it is saved
  const ScratchDir dir_;
};

TEST_F(Tour, everyTaskOfATuningEngineerTakesFewClicksAndKeys) {
  takeTheTour();
}

}  // namespace
}  // namespace trimtab::test
