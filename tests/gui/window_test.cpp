// SPDX-License-Identifier: GPL-3.0-or-later
#include <arpa/inet.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <QAction>
#include <QComboBox>
#include <QDockWidget>
#include <QEventLoop>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTimer>
#include <algorithm>

#include "app/workbench/docks/host_dock.h"
#include "app/workbench/window/workspaces.h"
#include "gui_support.h"
#include "trimtab/measure/trace.h"
#include "views/panels/culling_panel.h"
#include "views/panels/plots_panel.h"

namespace trimtab::test {
namespace {

double cpuSeconds() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + double(t.tv_nsec) * 1e-9;
}

/// Runs the event loop alone, without the polling that a test does.
void idle(int ms) {
  QEventLoop loop;
  QTimer::singleShot(ms, &loop, &QEventLoop::quit);
  loop.exec();
}

class WorkbenchWindow : public Bench {};

TEST_F(WorkbenchWindow, idleCostsNothing) {
  ASSERT_TRUE(settle());
  const QString hud = w().viewport().overlayContents().hud;
  EXPECT_TRUE(hud.contains("triangles")) << "figures are of the picture they stand on: " << hud.toStdString();
  const std::uint64_t before = paints();
  constexpr double kIdle = 0.01;
  double least = 1;
  for (int i = 0; i < 3 && least >= kIdle; ++i) {
    const double cpu = cpuSeconds();
    constexpr int kSeconds = 2;
    idle(kSeconds * 1000);
    least = std::min(least, (cpuSeconds() - cpu) / kSeconds);
  }
  EXPECT_EQ(paints(), before) << "no host, no input: no repaint";
  EXPECT_LT(least, kIdle) << "share of a core";
}

TEST_F(WorkbenchWindow, anEmptySkySaysThatTheEyeIsNotOverTheTerrain) {
  ASSERT_TRUE(settle());
  EXPECT_FALSE(w().viewport().overlayContents().hud.contains("not over the terrain"));
  GeodeticPosition away = w().viewport().camera().position();
  away.longitude = Degrees{away.longitude.value() + 20};
  w().viewport().camera().place(away, {});
  w().feed().look(w().viewport().camera());
  ASSERT_TRUE(settle());
  EXPECT_TRUE(w().viewport().overlayContents().hud.contains("not over the terrain"));
}

TEST_F(WorkbenchWindow, manyChangesMakeOnePaintAndHiddenNone) {
  ASSERT_TRUE(settle());
  std::uint64_t before = paints();
  for (int i = 0; i < 100; ++i) w().viewport().invalidate();
  ASSERT_TRUE(settle());
  EXPECT_EQ(paints(), before + 1);
  w().hide();
  before = paints();
  for (int i = 0; i < 10; ++i) w().viewport().invalidate();
  QTest::qWait(100);
  EXPECT_EQ(paints(), before);
  w().show();
  EXPECT_TRUE(waitFor([&] { return paints() > before; }));
}

/// Measures how long each image of a widget takes until it is on the display, and how long the widget then
/// waits until the next one, though that is asked for at once.
class ImageGaps : public QObject {
 public:
  struct Gap {
    double tookMs, waitedMs;
  };
  explicit ImageGaps(workbench::Viewport& viewport) {
    viewport.installEventFilter(this);
    since_.start();
    connect(&viewport, &workbench::Viewport::painted, this, [this, &viewport] {
      if (tookMs_ > 0) gaps.push_back({tookMs_, paintMs_ - shownMs_});
      shownMs_ = elapsedMs();
      tookMs_ = shownMs_ - paintMs_;
      viewport.invalidate();
      if (gaps.size() >= kImages) loop_.quit();
    });
    QTimer::singleShot(kPatienceMs, &loop_, &QEventLoop::quit);
    viewport.invalidate();
    loop_.exec();  // QTest::qWaitFor would sleep between events
  }
  std::vector<Gap> gaps;
  static constexpr std::size_t kImages = 12;

 private:
  double elapsedMs() const { return double(since_.nsecsElapsed()) * 1e-6; }
  /// The last paint before an image is the one that draws it.
  bool eventFilter(QObject*, QEvent* event) override {
    if (event->type() == QEvent::Paint) paintMs_ = elapsedMs();
    return false;
  }
  static constexpr int kPatienceMs = 20'000;
  QEventLoop loop_;
  QElapsedTimer since_;
  double tookMs_ = 0, paintMs_ = 0, shownMs_ = 0;
};

TEST_F(WorkbenchWindow, aControlThatTheMouseHoldsGoesBeforeTheImages) {
  ASSERT_TRUE(settle());
  QWidget& control = *w().statusBar();
  constexpr double kTimerMs = 3;  // whole milliseconds, one is not waited for, and a timer may end one early
  constexpr double kMostMs = 100;
  {
    QTest::mousePress(&control, Qt::LeftButton);
    const ImageGaps held(w().viewport());
    ASSERT_GE(held.gaps.size(), held.kImages) << "the images follow nevertheless";
    for (const ImageGaps::Gap& gap : held.gaps)
      EXPECT_GE(gap.waitedMs, std::min(gap.tookMs, kMostMs) - kTimerMs);
  }
  QTest::mouseRelease(&control, Qt::LeftButton);
  ASSERT_TRUE(settle());
  const ImageGaps free(w().viewport());
  ASSERT_GE(free.gaps.size(), free.kImages);
  EXPECT_TRUE(std::ranges::any_of(free.gaps, [](const ImageGaps::Gap& gap) {
    return gap.waitedMs < gap.tookMs - kTimerMs;
  })) << "nobody holds anything: the next image comes at once";
}

TEST_F(WorkbenchWindow, frozenCullingKeepsItsTilesWhileTheViewFliesOnAndSaysSo) {
  ASSERT_TRUE(settle());
  const auto drawn = [&] { return last().visible.reason; };
  const auto before = drawn();
  trigger("Freeze culling");
  ASSERT_TRUE(settle());
  EXPECT_TRUE(w().viewport().overlayContents().banner.contains("FROZEN"));
  w().viewport().camera().look(Degrees{120}, Degrees{0});
  w().feed().look(w().viewport().camera());
  ASSERT_TRUE(settle());
  EXPECT_EQ(drawn(), before);
  trigger("Freeze culling");
  ASSERT_TRUE(settle());
  EXPECT_TRUE(w().viewport().overlayContents().banner.isEmpty());
  EXPECT_NE(drawn(), before);
}

TEST_F(WorkbenchWindow, theCullingCaseIsSwitchedLiveAndCanBeUndone) {
  ASSERT_TRUE(settle());
  const QImage proposed = w().viewport().grabFramebuffer();
  const auto triangles = [&] { return last().visible.triangles; };
  const auto fewest = triangles();
  ASSERT_NO_FATAL_FAILURE(trigger("No culling"));
  EXPECT_EQ(w().draft().parameters().culling.cullingCase, CullingCase::none);
  ASSERT_TRUE(settle());
  EXPECT_GT(triangles(), fewest);
  EXPECT_EQ(last().visible.outsideFrustum, 0u);
  w().draft().undoStack().undo();
  ASSERT_TRUE(settle());
  EXPECT_EQ(triangles(), fewest);
}

TEST_F(WorkbenchWindow, aClickDescribesThePickedNodeAndEndsPicking) {
  ASSERT_TRUE(settle());
  auto& panel = *w().panels().culling;
  const auto says = [&panel](const QString& text) { return labelSays(panel, text); };
  const auto pickAt = [&](double down) {
    for (QPushButton* button : panel.findChildren<QPushButton*>())
      if (button->text().contains("Pick")) button->click();
    ASSERT_TRUE(panel.picking());
    workbench::Viewport& view = w().viewport();
    QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(view.width() / 2, int(view.height() * down)));
    EXPECT_TRUE(waitFor([&] { return !panel.picking(); }));
  };
  pickAt(0.75);
  EXPECT_TRUE(says("Stated error")) << "the ground is below the middle";
  EXPECT_TRUE(says("drawn"));
  pickAt(0.1);
  EXPECT_TRUE(says("Nothing is picked")) << "the sky is no node";
}

TEST_F(WorkbenchWindow, theTraceCommandIsCheckedWhileATraceIsRecorded) {
  const ScratchDir dir;
  QAction* const record = command("Record trace");
  ASSERT_NE(record, nullptr);
  auto& trace = *w().controllers().trace;
  EXPECT_FALSE(trace.start("/proc/nowhere/trace.csv"));
  EXPECT_FALSE(record->isChecked());
  writeFile(dir / "trace.csv", "the old one");
  writeFile(dir / "cut.csv.part", "a trace\nthat was cut off");
  EXPECT_FALSE(trace.start(QString::fromStdString((dir / "cut.csv").string())));
  EXPECT_TRUE(w().messages().text().contains("cut.csv.part"));
  EXPECT_EQ(readFile(dir / "cut.csv.part"), "a trace\nthat was cut off");
  ASSERT_TRUE(trace.start(QString::fromStdString((dir / "trace.csv").string())));
  EXPECT_TRUE(record->isChecked());
  EXPECT_EQ(readFile(dir / "trace.csv"), "the old one") << "until the new one is whole";
  const views::PlotMarks& marks = w().panels().plots->marks();
  EXPECT_TRUE(marks.lasts(views::PlotMarks::Kind::recording)) << "the plots show it";
  record->trigger();
  EXPECT_FALSE(record->isChecked());
  EXPECT_FALSE(marks.lasts(views::PlotMarks::Kind::recording));
  EXPECT_TRUE(trace.recorded().endsWith("trace.csv"));
  EXPECT_TRUE(isTraceFile(dir / "trace.csv"));
  EXPECT_FALSE(std::filesystem::exists(dir / "trace.csv.part"));
}

TEST_F(WorkbenchWindow, mouseAndKeysFlyTheCameraWhileNoHostDoes) {
  ASSERT_TRUE(settle());
  workbench::Viewport& view = w().viewport();
  const Attitude before = view.camera().attitude();
  const QPoint middle = view.rect().center();
  QTest::mousePress(&view, Qt::LeftButton, {}, middle);
  QTest::mouseMove(&view, middle + QPoint(-120, 0));
  QMouseEvent drag(QEvent::MouseMove, middle + QPoint(-120, 40), view.mapToGlobal(middle + QPoint(-120, 40)),
                   Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&view, &drag);
  QTest::mouseRelease(&view, Qt::LeftButton, {}, middle + QPoint(-120, 40));
  EXPECT_NE(view.camera().attitude(), before);
  EXPECT_EQ(session().input().state.attitude, view.camera().attitude());
  const GeodeticPosition place = view.camera().position();
  QTest::keyPress(&view, Qt::Key_W);
  ASSERT_TRUE(waitFor([&] { return view.camera().position() != place; }));
  QTest::keyRelease(&view, Qt::Key_W);
  ASSERT_TRUE(settle()) << "a released key stops the camera";
}

TEST_F(WorkbenchWindow, aFixedRenderSizeIsDrawnAtThatSizeAndScaledIntoTheWindow) {
  ASSERT_TRUE(w().draft().setText("view.render_size", "fixed").empty());
  ASSERT_TRUE(w().draft().setText("view.width_px", "640").empty());
  ASSERT_TRUE(w().draft().setText("view.height_px", "640").empty());
  ASSERT_TRUE(settle());
  const QImage shown = w().viewport().grabFramebuffer();
  const QColor edge = shown.pixelColor(2, shown.height() / 2),
               middle = shown.pixelColor(shown.width() / 2, shown.height() / 2);
  EXPECT_EQ(edge, QColor(Qt::black)) << "a square picture leaves bars beside it";
  EXPECT_NE(middle, QColor(Qt::black));
}

TEST_F(WorkbenchWindow, aWindowOfAnotherShapeDoesNotStretchThePicture) {
  w().controllers().frame->setFills(false);
  // 60 by 36 degrees has square pixels at tan 30 : tan 18; a view twice as high is narrower than any layout
  // of the docks.
  ASSERT_TRUE(w().draft().setText("view.horizontal_fov_deg", "40").empty());
  ASSERT_TRUE(w().draft().setText("view.vertical_fov_deg", "70").empty());
  ASSERT_TRUE(settle());
  const QImage shown = w().viewport().grabFramebuffer();
  const QRgb bar = shown.pixel(1, shown.height() / 2);
  EXPECT_EQ(QColor(bar), QColor(Qt::black));
  int left = 0;
  while (left < shown.width() / 2 && shown.pixel(left, shown.height() / 2) == bar) ++left;
  const double width = shown.width() - 2 * left;
  const double wanted = std::tan(20 * M_PI / 180) / std::tan(35 * M_PI / 180);
  EXPECT_NEAR(width / shown.height(), wanted, 0.02);
  w().controllers().frame->setFills(true);
}

TEST_F(WorkbenchWindow, floatingADockKeepsThePictureAndAResetOfTheWorkspaceBringsItBack) {
  ASSERT_TRUE(settle());
  const std::size_t tiles = last().visible.tiles.size();
  for (const char* name :
       {"policy", "culling", "decision", "host", "flight", "plots", "preset", "messages"}) {
    QDockWidget* dock = w().dock(name);
    ASSERT_NE(dock, nullptr) << name;
    ASSERT_NE(command(dock->windowTitle()), nullptr) << name << " is in the View menu";
    dock->setFloating(true);
  }
  ASSERT_TRUE(settle());
  EXPECT_GT(last().visible.tiles.size(), tiles / 4);
  const QImage picture = w().viewport().grabFramebuffer();
  EXPECT_NE(picture.pixelColor(picture.width() / 2, 5),
            picture.pixelColor(picture.width() / 2, picture.height() - 60));
  w().workspaces().reset();
  ASSERT_TRUE(settle());
  EXPECT_FALSE(w().dock("policy")->isFloating());
  EXPECT_TRUE(w().dock("policy")->isVisible());
}

TEST_F(WorkbenchWindow, aPortInUseIsSaidAndTheWorkGoesOn) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  socklen_t size = sizeof address;
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  const std::uint16_t taken = ntohs(address.sin_port);
  w().panels().host->setPort(taken);
  EXPECT_FALSE(w().panels().host->connectHost().empty());
  EXPECT_TRUE(w().messages().text().contains(QString::number(taken)));
  EXPECT_EQ(w().feed().receiver(), nullptr);
  ::close(socket);
  EXPECT_TRUE(w().panels().host->connectHost().empty()) << "free again";
}

TEST_F(WorkbenchWindow, theHostDockLetsNobodyInWhoWasNotAllowed) {
  auto& dock = *w().panels().host;
  const auto box = [&](const char* name) -> QComboBox* {
    for (QComboBox* each : dock.findChildren<QComboBox*>())
      if (each->accessibleName() == QLatin1String(name)) return each;
    return nullptr;
  };
  ASSERT_TRUE(box("Interface") && box("Sender"));
  w().feed().closeHost();
  dock.setInterface(QStringLiteral("127.0.0.1"));
  dock.setSender(QStringLiteral("127.0.0.77"));
  EXPECT_TRUE(dock.connectHost().empty()) << w().messages().text().toStdString();
  EXPECT_EQ(w().feed().receiver()->senders().allowed, "127.0.0.77");
  EXPECT_FALSE(box("Sender")->isEnabled()) << "while the link is open";
  w().feed().closeHost();
  dock.setSender(QStringLiteral("first"));
  EXPECT_EQ(box("Sender")->currentIndex(), 1);
  EXPECT_TRUE(dock.connectHost().empty());
  EXPECT_EQ(w().feed().receiver()->senders().allowed, "first");
  w().feed().closeHost();
  dock.setSender(QStringLiteral("any"));
}

TEST_F(WorkbenchWindow, theHostDockListensOnTheInterfaceAndTheGroupThatAreChosen) {
  auto& dock = *w().panels().host;
  const auto field = [&](const char* name) -> QLineEdit* {
    for (QLineEdit* each : dock.findChildren<QLineEdit*>())
      if (each->accessibleName() == QLatin1String(name)) return each;
    return nullptr;
  };
  QComboBox* interfaces = nullptr;
  for (QComboBox* each : dock.findChildren<QComboBox*>())
    if (each->accessibleName() == QLatin1String("Interface")) interfaces = each;
  ASSERT_NE(interfaces, nullptr);
  const int loopback = interfaces->findData(QStringLiteral("127.0.0.1"));
  ASSERT_GT(loopback, 0) << "every machine has it";
  EXPECT_EQ(interfaces->itemData(0), QStringLiteral("0.0.0.0"));
  interfaces->setCurrentIndex(loopback);
  field("Multicast group")->setText(QStringLiteral("10.1.2.3"));
  EXPECT_FALSE(dock.connectHost().empty());
  EXPECT_TRUE(w().messages().text().contains(QStringLiteral("10.1.2.3")));
  field("Multicast group")->setText(QStringLiteral("239.255.42.77"));
  EXPECT_TRUE(dock.connectHost().empty()) << w().messages().text().toStdString();
  EXPECT_FALSE(interfaces->isEnabled()) << "while the link is open";
  w().feed().closeHost();

  // A name is looked up without waiting for it.
  field("Reply address")->setText(QStringLiteral("localhost:4001"));
  emit field("Reply address")->editingFinished();
  EXPECT_TRUE(waitFor([&] { return labelSays(dock, "localhost is 127.0.0.1"); }));
  for (const char* each : {"Multicast group", "Reply address"}) field(each)->clear();
  interfaces->setCurrentIndex(0);
  EXPECT_TRUE(dock.connectHost().empty());  // remembers what the next tests begin with
}

}  // namespace
}  // namespace trimtab::test
