// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/resource.h>
#include <unistd.h>

#include <QAbstractButton>
#include <QDockWidget>
#include <QDoubleSpinBox>
#include <QLineEdit>
#include <QProcess>
#include <QTest>
#include <atomic>
#include <clocale>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <set>
#include <string>

#include "app/workbench/docks/dock_of.h"
#include "app/workbench/docks/message_panel.h"
#include "app/workbench/viewport/gl_setup.h"
#include "app/workbench/window/workspaces.h"
#include "reaction_eye.h"
#include "tests/shared_scene.h"
#include "tests/support.h"
#include "trimtab/terrain/bake/cache.h"
#include "views/controls/parameter_line.h"
#include "views/controls/parameter_table.h"
#include "views/editors/curve_plot.h"
#include "views/editors/membership_editor.h"
#include "views/policy/policy_panel.h"
#include "views/policy/scheme_page.h"

/// Group `reaction`: how soon the real window answers a person while it draws a flight without pause, what it
/// takes at rest, and how soon the program shows its first image. It needs a display.

namespace trimtab::bench {
namespace {

namespace fs = std::filesystem;
using workbench::MainWindow;

constexpr double kLimitMs = 100, kLeastUpdatesHz = 25, kMostTicks = 1, kStartLimitS = 2;
constexpr int kOpensWithinMs = 300'000, kSettlesMs = 1000, kMovesHz = 120;

/// Returns the editor of a parameter in the dock Preset, which is brought to the front and shows it alone.
QWidget& editorOf(MainWindow& window, const char* key) {
  views::ParameterTable& table = *window.panels().parameters;
  workbench::raiseDock(table);
  table.search().setText(QString::fromLatin1(key));
  QWidget* const editor = table.line(key)->editor();
  if (!QTest::qWaitFor([&] { return !editor->visibleRegion().isEmpty(); }, Eye::kPatienceMs))
    std::cerr << "the editor of " << key << " is not in sight\n";
  QTest::qWait(kSettlesMs);
  return *editor;
}

void measureReactions(Report& report, MainWindow& window, Eye& eye, const std::string& terrain,
                      const std::set<std::string>& wanted) {
  const auto row = [&](const std::string& part, const std::string& input,
                       const std::function<double(int)>& once) {
    std::vector<double> ms;
    eye.forgetImages();
    for (int i = 0; i < (report.quick() ? 20 : 60); ++i) ms.push_back(once(i));
    report.add(valueAtMost(
        kLimitMs, {"reaction." + part,
                   "p95 of the time from " + input + " to the display, while a flight plays over " + terrain,
                   experiment::quantileOf(ms, 0.95), "ms", "the gap between two images meanwhile, median",
                   eye.imageGapMs(), "run"}));
  };
  workbench::Viewport& viewport = window.viewport();
  if (wanted.contains("click")) {
    auto& box = dynamic_cast<QAbstractButton&>(editorOf(window, "culling.back_faces"));
    row("click", "a click on a check box of a dock to its mark", [&](int) {
      const bool on = !box.isChecked();
      const QPoint mark(box.height() / 2, box.height() / 2);
      return eye.reactionMs(
          box, [&] { QTest::mouseClick(&box, Qt::LeftButton, {}, mark); },
          [&box, on] { return box.isChecked() == on; });
    });
  }
  if (wanted.contains("type")) {
    auto& box = dynamic_cast<QDoubleSpinBox&>(editorOf(window, "lod.screen_space_error_px"));
    row("type", "a value that is typed into a parameter's line, and Enter, to the line with it", [&](int i) {
      const int value = i % 2 == 0 ? 3 : 2;
      box.setFocus();
      box.selectAll();
      const auto type = [&] {
        QTest::keyClicks(&box, QString::number(value));
        QTest::keyClick(&box, Qt::Key_Return);
      };
      return eye.reactionMs(box, type, [&window, value] {
        return window.draft().parameters().lod.screenSpaceError.value() == value;
      });
    });
  }
  viewport.setFocus();
  if (wanted.contains("shortcut")) {
    const workbench::FrameController& frame = *window.controllers().frame;
    row("shortcut", "the shortcut of Colour by reason to the image with it", [&](int) {
      const bool on = !frame.overlays().colourByReason;
      return eye.reactionMs(
          viewport, [&] { QTest::keyClick(&viewport, Qt::Key_3, Qt::ControlModifier | Qt::ShiftModifier); },
          [&frame, on] { return frame.overlays().colourByReason == on; });
    });
  }
  if (wanted.contains("workspace")) {
    constexpr int kPlaces[] = {0, 1, 3, 4};
    row("workspace", "the key of a workspace to the image in its new place", [&](int i) {
      const int index = kPlaces[std::size_t(i) % std::size(kPlaces)];
      const auto press = [&viewport, key = Qt::Key(Qt::Key_1 + index)] {
        QTest::keyClick(&viewport, key, Qt::ControlModifier);
      };
      return eye.reactionMs(viewport, press,
                            [&window, index] { return window.workspaces().current() == index; });
    });
    window.workspaces().show(1);
  }
}

/// Returns how often a second the display shows the plot of the altitude curve anew while one of its points
/// follows the mouse.
double updatesHz(MainWindow& window, Eye& eye, int seconds) {
  constexpr double kRadiusPx = 24;
  views::PolicyPanel& policy = *window.panels().policy;
  workbench::raiseDock(policy);
  policy.showEditorOf("fuzzy.altitude.curve_ft");
  QTest::qWait(kSettlesMs);
  views::CurvePlot& plot = policy.parts().scheme->memberships().altitude().plot();
  const auto point = [&] { return window.draft().parameters().altitude.curve.point[1]; };
  const QPoint from = plot.pixelOf(point()).toPoint();
  if (!plot.visibleRegion().contains(from)) std::cerr << "the point to drag is not in sight\n";

  // A plot paints what it held at its last replot; moves that came after that do not show yet.
  CurvePoint drawn = point(), seen = drawn;
  int updates = 0;
  const auto replots = QObject::connect(&plot, &QCustomPlot::beforeReplot, &eye, [&] { drawn = point(); });
  eye.watch(
      plot, [&] { return drawn != seen; }, [&] { ++updates, seen = drawn; });

  QEventLoop loop;
  std::atomic<int> move = 0;
  std::atomic<bool> pending = false;
  const auto follow = [&] {
    pending = false;
    // The mouse runs round a circle once a second, so that each move changes the point.
    const double turn = 2 * std::numbers::pi * move / kMovesHz;
    QTest::mouseMove(&plot, from + QPoint(int(std::lround(kRadiusPx * std::sin(turn))),
                                          int(std::lround(kRadiusPx * (1 - std::cos(turn))))));
  };
  QTest::mousePress(&plot, Qt::LeftButton, {}, from);
  const double began = monotonicSeconds();
  std::thread mouse([&] {
    auto next = std::chrono::steady_clock::now();
    for (int i = 1; i <= seconds * kMovesHz; ++i) {
      next += std::chrono::microseconds(1'000'000 / kMovesHz);
      std::this_thread::sleep_until(next);
      move = i;
      // Moves that nobody has heard yet become one, as Qt does with those of a display.
      if (!pending.exchange(true)) QMetaObject::invokeMethod(&loop, follow, Qt::QueuedConnection);
    }
    QMetaObject::invokeMethod(&loop, &QEventLoop::quit, Qt::QueuedConnection);
  });
  loop.exec();
  const double took = monotonicSeconds() - began;
  mouse.join();
  QTest::mouseRelease(&plot, Qt::LeftButton, {}, from);
  eye.close();
  QObject::disconnect(replots);
  window.draft().undoStack().undo();
  return updates / took;
}

/// Returns the processor time of all threads so far, in clock ticks of a core.
double ticks() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return (seconds(usage.ru_utime) + seconds(usage.ru_stime)) * double(::sysconf(_SC_CLK_TCK));
}

/// Returns the ticks that ten seconds take in which nobody does anything.
double ticksAtRest(MainWindow& window) {
  window.viewport().setFocus();
  const auto nothingPainted = [&] {
    const std::uint64_t before = window.viewport().paints();
    QTest::qWait(2 * kSettlesMs);
    return window.viewport().paints() == before;
  };
  if (!QTest::qWaitFor(nothingPainted, 6 * Eye::kPatienceMs)) std::cerr << "images are still drawn\n";
  QEventLoop loop;
  QTimer::singleShot(10'000, Qt::CoarseTimer, &loop, &QEventLoop::quit);
  const double before = ticks();
  loop.exec();
  return ticks() - before;
}

/// The first start is not counted: it makes and bakes the sample if nobody has yet.
void measureStart(Report& report, const fs::path& home) {
  const QStringList arguments{"--size", "1600x1000", "--screenshot",
                              QString::fromStdString((home / "first.png").string())};
  int failed = 0;
  const double seconds = leastSeconds(report.quick() ? 1 : 5, [&] {
    if (QProcess::execute(QString::fromStdString(test::program("trimtab")), arguments) != 0) ++failed;
  });
  report.add(valueAtMost(
      kStartLimitS, {"reaction.start",
                     "seconds from the start of trimtab, 100 km of the sample baked, until a picture of its "
                     "window with the first image is saved and it has ended",
                     failed == 0 ? seconds : NAN, "s"}));
}

/// Opens the window over Kansai, or the sample where there is none, and waits until the images of a flight
/// follow one another. Returns the terrain's name, or nothing if that fails.
std::string begin(MainWindow& window) {
  const fs::path kansai = test::sharedDir() / "data/fg-kansai-e135n35";
  const bool large = fs::exists(kansai);
  if (!large) std::cerr << "the sample is flown over: needs " << kansai << '\n';
  if (large && !test::openOrBakeInTurn(kansai, terrain::cacheFolder())) std::cerr << "it cannot be baked\n";
  workbench::Options options;
  if (large) options.terrain = QString::fromStdString(kansai.string());
  const fs::path flight = large ? "kansai-valley.csv" : "yecheon-circuit.csv";
  options.flight = QString::fromStdString((test::sourceDir() / "resources/flights" / flight).string());
  options.window = QSize(1920, 1080);
  window.start(options);
  window.feed().playback().setLoop(true);
  window.activateWindow();
  const workbench::Viewport& viewport = window.viewport();
  if (QTest::qWaitFor([&] { return viewport.lastResult() && viewport.paints() > 100; }, kOpensWithinMs) &&
      window.feed().playback().playing() && QTest::qWaitForWindowActive(&window, Eye::kPatienceMs))
    return large ? "Kansai" : "the sample";
  std::cerr << "no flight plays in an active window:\n" << window.messages().text().toStdString() << '\n';
  return {};
}

int measure(Report& report, const fs::path& home) {
  std::set<std::string> wanted;
  for (const char* part : {"click", "type", "shortcut", "workspace", "drag", "drag_paused", "rest", "start"})
    if (report.wants(part)) wanted.insert(part);
  if (wanted.erase("start") > 0) measureStart(report, home);
  if (wanted.empty()) return report.finish();

  MainWindow window;
  Eye eye(window);
  const std::string terrain = begin(window);
  if (terrain.empty()) return 1;
  measureReactions(report, window, eye, terrain, wanted);
  const auto drag = [&](const std::string& part, const std::string& when) {
    if (!wanted.contains(part)) return;
    report.add(valueAtLeast(kLeastUpdatesHz,
                            {"reaction." + part,
                             "updates a second of a membership curve on the display while the mouse drags a "
                             "point of it with 120 moves a second, a flight " +
                                 when + terrain,
                             updatesHz(window, eye, report.quick() ? 2 : 6), "Hz"}));
  };
  drag("drag", "playing over ");
  window.feed().pauseHere();
  drag("drag_paused", "paused over ");
  if (wanted.contains("rest"))
    report.add(valueAtMost(
        kMostTicks,
        {"reaction.rest",
         "clock ticks of a core that the window takes in 10 s at rest, its flight paused over " + terrain,
         ticksAtRest(window), "ticks"}));
  window.draft().undoStack().setClean();
  return report.finish();
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  using namespace trimtab;
  bench::Report report(argc, argv);
  // Settings and what images cost stay in a folder of their own; baked terrain is where tests keep theirs.
  const test::ScratchDir home;
  for (const char* name : {"XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME", "XDG_RUNTIME_DIR", "HOME"})
    ::setenv(name, home.path().c_str(), 1);
  const auto baked = std::filesystem::temp_directory_path() / "trimtab-scene-test";
  std::filesystem::create_directories(baked);
  std::filesystem::create_directories(terrain::cacheFolder().parent_path());
  std::filesystem::create_directory_symlink(baked, terrain::cacheFolder());

  // GL and names are as in the main function of trimtab.
  workbench::prepareGl();
  QApplication app(argc, argv);
  std::setlocale(LC_NUMERIC, "C");
  workbench::nameApplication();
  if (const QString missing = workbench::checkGl(); !missing.isEmpty()) {
    std::cerr << missing.toStdString() << '\n';
    return 1;
  }
  return bench::measure(report, home.path());
}
