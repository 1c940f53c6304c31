// SPDX-License-Identifier: GPL-3.0-or-later
#include <QAction>
#include <QDockWidget>
#include <QLabel>
#include <QPushButton>
#include <QRegularExpression>
#include <QStatusBar>
#include <QUdpSocket>
#include <cmath>

#include "app/link/link.h"
#include "app/workbench/docks/changes_dock.h"
#include "app/workbench/docks/flight_dock.h"
#include "gui_support.h"
#include "trimtab/host/encoder.h"
#include "trimtab/host/flight.h"
#include "views/controls/bar_list.h"
#include "views/model/live.h"
#include "views/panels/budget_strip.h"
#include "views/panels/culling_panel.h"
#include "views/panels/plots_panel.h"

namespace trimtab::test {
namespace {

using workbench::Feed;

/// A window in which a flight, a host or the camera is the pilot, and an observer looks on.
class Observer : public Bench {
 protected:
  void SetUp() override {
    Bench::SetUp();
    QObject::connect(w().controllers().frame.get(), &workbench::FrameController::frameShown, &w(),
                     [this](const views::LiveFrame& frame) { told_ = frame; });
  }
  void openFlight() {
    ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
    flight_ = *readFlight(sampleFlight());
  }
  bool drawsOn() {
    const std::uint64_t before = paints();
    return waitFor([&] { return paints() > before + 3; });
  }
  void playFlight() {
    openFlight();
    w().panels().flight->play();
    ASSERT_TRUE(drawsOn());
  }
  void seek(double altitudeFt) { w().feed().seekHere(climbsThrough(flight_, altitudeFt)); }
  GeodeticPosition camera() { return w().viewport().camera().position(); }
  /// Holds a key of the camera down for some images.
  void fly(Qt::Key key) {
    QTest::keyPress(&w().viewport(), key);
    const std::uint64_t before = paints();
    EXPECT_TRUE(waitFor([&] { return paints() > before + 2; }));
    QTest::keyRelease(&w().viewport(), key);
    EXPECT_TRUE(settle());
  }
  bool statusSays(const QString& text) { return labelSays(*w().statusBar(), text); }
  bool drawsTerrain() { return w().viewport().overlayContents().notice.isEmpty(); }

  Flight flight_;
  views::LiveFrame told_;  ///< what the docks were shown last
};

TEST_F(Observer, aHostThatNeverComesLeavesTheImageAndTheCameraOfAPausedFlight) {
  openFlight();
  w().controllers().flight->playOrPause();
  ASSERT_TRUE(waitFor([&] { return w().feed().playback().position() > 0.2; }));
  w().controllers().flight->playOrPause();
  listen();
  w().feed().closeHost();
  trigger("Wireframe");
  ASSERT_TRUE(settle());
  EXPECT_TRUE(drawsTerrain()) << w().viewport().overlayContents().notice.toStdString();
  const GeodeticPosition before = camera();
  fly(Qt::Key_PageUp);
  EXPECT_GT(camera().height.value(), before.height.value());
  EXPECT_EQ(session().input().state.position, camera());
}

TEST_F(Observer, aHostThatNeverComesLeavesTheImageOfTheFreeCamera) {
  listen();
  trigger("Wireframe");
  ASSERT_TRUE(settle());
  EXPECT_TRUE(drawsTerrain()) << w().viewport().overlayContents().notice.toStdString();
  EXPECT_TRUE(statusSays("listening"));
  w().feed().closeHost();
  EXPECT_FALSE(statusSays("listening"));
  EXPECT_TRUE(statusSays("free camera"));
}

TEST_F(Observer, aHostWhoseDatagramsLeadToNothingIsToldWhyInTheHostDock) {
  AircraftState state;
  state.position = {Degrees{36.6}, Degrees{128.3}, Metres{1500}};
  std::vector<std::byte> other = encodeCigiHost(state, 1, 0);
  constexpr std::size_t kEntityControl = 24, kEntityLow = kEntityControl + 3;
  ASSERT_EQ(std::to_integer<int>(other[kEntityControl]), 2);
  other[kEntityLow] = std::byte{1};
  const struct {
    std::vector<std::byte> bytes;
    const char* says;
  } hosts[] = {{std::vector<std::byte>(72, std::byte{0x55}), "72 bytes of none of them"}, {other, "entity"}};
  w().dock("host")->show();
  w().dock("host")->raise();
  ASSERT_TRUE(comesToFront("host"));
  const QLabel* const link = labelNamed(*w().dock("host"), "Link");
  ASSERT_NE(link, nullptr);
  for (const auto& host : hosts) {
    const std::uint16_t port = listen();
    EXPECT_TRUE(waitFor([&] { return link->text().contains("nothing yet"); }));
    QUdpSocket socket;
    for (int i = 0; i < 25; ++i)
      socket.writeDatagram(reinterpret_cast<const char*>(host.bytes.data()), qint64(host.bytes.size()),
                           QHostAddress::LocalHost, port);
    EXPECT_TRUE(
        waitFor([&] { return link->text().contains("25") && link->text().contains(host.says); }, 5000))
        << link->text().toStdString();
    EXPECT_FALSE(link->text().contains('\n')) << "one line";
    // The whole text is seen, however narrow the dock is.
    EXPECT_TRUE(waitFor([&] { return link->height() >= link->heightForWidth(link->width()); }));
    if (const QString shots = qEnvironmentVariable("TRIMTAB_SHOTS"); !shots.isEmpty())
      w().grab().save(shots + "/host-" + QString::number(host.bytes.size()) + ".png");
    w().feed().closeHost();
  }
}

TEST_F(Observer, frozenTheDecisionAndTheVisibleSetStayWhateverFlies) {
  openFlight();
  seek(3500);
  ASSERT_TRUE(settle());
  const FrameDecision decided = session().decision();
  const auto visible = last().visible.reason;
  const std::uint64_t triangles = last().visible.triangles;
  trigger("Freeze culling");
  seek(7500);
  ASSERT_TRUE(settle());
  ASSERT_NE(session().decision(), decided) << "the flight leads on";
  EXPECT_EQ(told_.decision, decided);
  EXPECT_EQ(w().controllers().frame->shown()->decision, decided);
  EXPECT_EQ(last().visible.reason, visible);
  EXPECT_EQ(last().visible.triangles, triangles);
  w().controllers().flight->flightDock().play();
  ASSERT_TRUE(waitFor([&] { return w().feed().playback().position() > climbsThrough(flight_, 7500) + 0.2; }));
  w().controllers().flight->flightDock().pause();
  ASSERT_TRUE(settle());
  EXPECT_EQ(told_.decision, decided);
  EXPECT_EQ(last().visible.triangles, triangles);
  trigger("Freeze culling");
  ASSERT_TRUE(settle());
  EXPECT_EQ(told_.decision, session().decision());
  EXPECT_NE(last().visible.triangles, triangles);
}

TEST_F(Observer, frozenADecisionOutlivesItsHostAndTheCameraClimbsBesideIt) {
  const std::uint16_t port = listen();
  Result<Flight> flight = readFlight(sampleFlight());
  ASSERT_TRUE(flight);
  link::PlayOptions options;
  options.to = {"127.0.0.1", port};
  options.startS = climbsThrough(*flight, 3500);
  auto host = link::FeedPlayer::start(*flight, options);
  ASSERT_TRUE(host) << toString(host.findings());
  ASSERT_TRUE(waitFor([&] { return w().feed().source() == Feed::Source::host; }));
  ASSERT_TRUE(waitFor([&] { return w().viewport().lastResult() && told_.decision == session().decision(); }));
  trigger("Freeze culling");
  // Pages that are still on their way when it freezes come in later.
  std::uint64_t triangles = 0, unchanged = 0;
  const auto counted = QObject::connect(&w().viewport(), &workbench::Viewport::painted, &w(), [&] {
    unchanged = last().visible.triangles == triangles ? unchanged + 1 : 0;
    triangles = last().visible.triangles;
  });
  ASSERT_TRUE(waitFor([&] { return unchanged > 20; }));
  QObject::disconnect(counted);
  const FrameDecision decided = told_.decision;
  const std::uint64_t packets = session().packets();
  EXPECT_TRUE(waitFor([&] { return session().packets() > packets + 20; })) << "the host flies on";
  EXPECT_EQ(told_.decision, decided);

  const GeodeticPosition before = camera();
  QTest::keyPress(&w().viewport(), Qt::Key_PageUp);
  EXPECT_TRUE(waitFor([&] { return camera().height.value() > before.height.value(); }))
      << "a host does not keep the keys";
  QTest::keyRelease(&w().viewport(), Qt::Key_PageUp);
  host->reset();
  w().feed().closeHost();
  w().viewport().camera().place({before.latitude, before.longitude, Metres{9000}}, {});
  w().feed().look(w().viewport().camera());
  ASSERT_TRUE(settle());
  EXPECT_EQ(told_.decision, decided) << "it is of the moment that was frozen, not of the camera";
  EXPECT_EQ(last().visible.triangles, triangles);
  trigger("Freeze culling");
  ASSERT_TRUE(settle());
  EXPECT_NE(told_.decision, decided);
}

TEST_F(Observer, frozenKeysAndHomeFlyTheViewBesideAPausedFlight) {
  openFlight();
  seek(4500);
  ASSERT_TRUE(settle());
  const GeodeticPosition pilot = session().input().state.position;
  trigger("Freeze culling");
  ASSERT_TRUE(settle());
  const QImage before = w().viewport().grabFramebuffer();
  const GeodeticPosition from = camera();
  EXPECT_EQ(from, pilot) << "the view does not jump";
  fly(Qt::Key_PageUp);
  EXPECT_GT(camera().height.value(), from.height.value());
  EXPECT_NE(w().viewport().grabFramebuffer(), before);
  const GeodeticPosition high = camera();
  trigger("Place the camera");
  EXPECT_NE(camera(), high);
  EXPECT_EQ(session().input().state.position, pilot) << "the pilot's eye stays";
  trigger("Freeze culling");
  ASSERT_TRUE(settle());
  EXPECT_EQ(w().controllers().frame->shown()->eye, pilot);
  EXPECT_FALSE(w().viewport().cameraEnabled());
}

TEST_F(Observer, aClosedFlightLeavesAFreeCameraWhereItWas) {
  openFlight();
  seek(4500);
  ASSERT_TRUE(settle());
  const GeodeticPosition there = session().input().state.position;
  trigger("Close flight");
  EXPECT_FALSE(w().feed().playback().loaded());
  EXPECT_EQ(w().feed().source(), Feed::Source::camera);
  EXPECT_TRUE(w().controllers().flight->flightDock().file().isEmpty());
  EXPECT_EQ(camera(), there);
  ASSERT_TRUE(settle());
  EXPECT_TRUE(drawsTerrain());
  fly(Qt::Key_PageUp);
  EXPECT_GT(camera().height.value(), there.height.value());
}

TEST_F(Observer, theLegendAndTheDockNameAReasonAlike) {
  w().dock("culling")->raise();
  trigger("Colour by reason");
  ASSERT_TRUE(settle());
  const auto& legend = w().viewport().overlayContents().legend;
  ASSERT_EQ(legend.size(), 5);
  for (const auto* list : w().panels().culling->findChildren<views::BarList*>()) {
    if (!list->accessibleName().startsWith("Nodes")) continue;
    for (const auto& entry : legend)
      EXPECT_TRUE(list->accessibleDescription().contains(entry.text)) << entry.text.toStdString();
    return;
  }
  FAIL() << "no list of reasons";
}

/// The number before " ms" in a text; empty if there is none.
QString msIn(const QString& text) {
  static const QRegularExpression kMs(QStringLiteral("([0-9.,–]+)(?: of [0-9.,]+)? ms"));
  return kMs.match(text).captured(1);
}

TEST_F(Observer, theLineAtTheFootOfTheImageAndTheStatusBarHaveOneNumber) {
  const QLabel* const status = labelNamed(*w().statusBar(), "Frame time and budget");
  ASSERT_NE(status, nullptr);
  int images = 0;
  double decideMs = 0;
  const auto compare = [&] {
    ++images;
    decideMs = std::max(decideMs, w().controllers().frame->lastCost().decide);
    const QString hud = msIn(w().viewport().overlayContents().hud);
    ASSERT_FALSE(hud.isEmpty());
    ASSERT_EQ(hud.toStdString(), msIn(status->text()).toStdString())
        << w().viewport().overlayContents().hud.toStdString() << " / " << status->text().toStdString();
  };
  playFlight();
  QObject ends;
  QObject::connect(w().controllers().frame.get(), &workbench::FrameController::painted, &ends, compare);
  ASSERT_TRUE(waitFor([&] { return images > 30; }));
  EXPECT_GT(decideMs, 0) << "what an image's decisions take is in both";
  trigger("Freeze culling");
  ASSERT_TRUE(waitFor([&] { return images > 40; }));
}

TEST_F(Observer, frozenImagesCountInNoStatistic) {
  playFlight();
  auto& snapshots = w().panels().changes->snapshots();
  snapshots.keep(0);
  snapshots.switchTo(0);
  ASSERT_TRUE(drawsOn());
  trigger("Freeze culling");
  const std::uint64_t frames = w().panels().plots->buffer().end();
  const std::size_t images = w().strip().minute().images(), kept = snapshots.images(0);
  ASSERT_GT(images, 0u);
  ASSERT_TRUE(drawsOn());
  ASSERT_TRUE(w().draft().setText("lod.screen_space_error_px", "7").empty());
  ASSERT_TRUE(drawsOn());
  EXPECT_EQ(w().strip().minute().images(), images);
  EXPECT_EQ(w().panels().plots->buffer().end(), frames);
  EXPECT_EQ(snapshots.images(0), kept);
  w().draft().undoStack().undo();
  trigger("Freeze culling");
  ASSERT_TRUE(drawsOn());
  EXPECT_GT(w().strip().minute().images(), images);
  EXPECT_GT(w().panels().plots->buffer().end(), frames);
}

TEST_F(Observer, frozenAnEditDecidesTheSameMomentAgain) {
  openFlight();
  seek(3500);
  ASSERT_TRUE(settle());
  trigger("Freeze culling");
  seek(7500);
  ASSERT_TRUE(settle());
  const double frozenFt = told_.decision.altitudeFt;
  const std::uint64_t triangles = last().visible.triangles;
  ASSERT_TRUE(w().draft().setText("lod.screen_space_error_px", "40").empty());
  ASSERT_TRUE(settle());
  EXPECT_EQ(told_.decision.altitudeFt, frozenFt);
  EXPECT_LT(last().visible.triangles, triangles);
  w().draft().undoStack().undo();
  ASSERT_TRUE(settle());
  EXPECT_EQ(last().visible.triangles, triangles);
}

TEST_F(Observer, detachedThePilotDecidesAndCullsOnAsIfNobodyLooked) {
  openFlight();
  seek(7500);
  ASSERT_TRUE(settle());
  const auto there = last().visible.reason;
  const std::uint64_t triangles = last().visible.triangles;
  const FrameDecision decided = told_.decision;
  seek(4000);
  ASSERT_TRUE(settle());
  trigger("Detach");
  ASSERT_TRUE(settle());
  EXPECT_TRUE(w().viewport().overlayContents().banner.contains("DETACHED"));
  const GeodeticPosition outside = camera();
  fly(Qt::Key_S);
  EXPECT_NE(camera(), outside);
  seek(7500);
  ASSERT_TRUE(settle());
  EXPECT_EQ(told_.decision, session().decision());
  EXPECT_EQ(told_.decision.altitudeFt, decided.altitudeFt);
  EXPECT_EQ(told_.decision.band, decided.band);
  EXPECT_EQ(last().visible.reason, there);
  EXPECT_EQ(last().visible.triangles, triangles);
  EXPECT_NE(camera(), session().input().state.position);
  trigger("Detach");
  ASSERT_TRUE(settle());
  EXPECT_EQ(last().visible.reason, there);
  EXPECT_TRUE(w().viewport().overlayContents().banner.isEmpty());
  EXPECT_TRUE(w().viewport().overlayContents().inset.isEmpty());
}

TEST_F(Observer, detachedTheInsetIsThePilotsImage) {
  ASSERT_TRUE(settle());
  const GeodeticPosition seat = camera();
  const QImage whole = w().viewport().grabFramebuffer();
  trigger("Detach");
  ASSERT_TRUE(settle());
  EXPECT_NE(camera(), seat);
  const QRect inset = w().viewport().overlayContents().inset;
  ASSERT_GT(inset.width(), 100);
  const QImage seen = w().viewport().grabFramebuffer().copy(inset.adjusted(4, 30, -4, -30));
  const QRectF part(4.0 / inset.width(), 30.0 / inset.height(), 1 - 8.0 / inset.width(),
                    1 - 60.0 / inset.height());
  const QRect from(int(part.x() * whole.width()), int(part.y() * whole.height()),
                   int(part.width() * whole.width()), int(part.height() * whole.height()));
  const QImage expected =
      whole.copy(from).scaled(seen.size(), Qt::IgnoreAspectRatio, Qt::SmoothTransformation);
  double difference = 0;
  for (int y = 0; y < seen.height(); ++y)
    for (int x = 0; x < seen.width(); ++x)
      difference += std::abs(qGray(seen.pixel(x, y)) - qGray(expected.pixel(x, y)));
  EXPECT_LT(difference / (double(seen.width()) * seen.height()), 6) << "grey levels of 255";
  trigger("Detach");
  EXPECT_EQ(camera(), seat) << "back in the seat";
}

TEST_F(Observer, detachingColoursTheNodesByReasonAndComingBackEndsIt) {
  QAction* const byReason = command("Colour by reason");
  ASSERT_NE(byReason, nullptr);
  trigger("Detach");
  EXPECT_TRUE(byReason->isChecked());
  trigger("Detach");
  EXPECT_FALSE(byReason->isChecked());
  trigger("Colour by level");
  trigger("Detach");
  EXPECT_FALSE(byReason->isChecked()) << "what was chosen stays";
}

TEST_F(Observer, aPickedNodeIsOutlinedWhileTheDockThatDescribesItShows) {
  ASSERT_TRUE(settle());
  auto& panel = *w().panels().culling;
  w().dock("culling")->raise();
  ASSERT_TRUE(waitFor([&] { return panel.isVisible(); }));
  const auto pickAt = [&](double down) {
    for (QPushButton* button : panel.findChildren<QPushButton*>())
      if (button->text().contains("Pick")) button->click();
    workbench::Viewport& view = w().viewport();
    QTest::mouseClick(&view, Qt::LeftButton, {}, QPoint(view.width() / 2, int(view.height() * down)));
    ASSERT_TRUE(waitFor([&] { return !panel.picking(); }));
    ASSERT_TRUE(settle());
  };
  const auto& shown = w().viewport().overlayContents();
  pickAt(0.75);
  ASSERT_FALSE(shown.outline.isEmpty());
  QRectF around;
  for (const QLineF& edge : shown.outline) around |= QRectF(edge.p1(), edge.p2()).normalized();
  EXPECT_TRUE(around.contains(0.5, 0.75)) << "the box holds the pixel that was picked";
  w().dock("culling")->hide();
  EXPECT_TRUE(waitFor([&] { return shown.outline.isEmpty(); }));
  w().dock("culling")->show();
  w().dock("culling")->raise();
  EXPECT_TRUE(waitFor([&] { return !shown.outline.isEmpty(); }));
  pickAt(0.02);
  EXPECT_TRUE(shown.outline.isEmpty()) << "the sky is no node";
}

}  // namespace
}  // namespace trimtab::test
