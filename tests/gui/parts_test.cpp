// SPDX-License-Identifier: GPL-3.0-or-later
#include <Qt>
#include <limits>

#include "app/workbench/jobs/flight_playback.h"
#include "app/workbench/jobs/free_camera.h"
#include "app/workbench/window/options.h"
#include "tests/support.h"
#include "trimtab/host/flight.h"

namespace trimtab {
namespace {

using workbench::FlightPlayback;
using workbench::FreeCamera;

Flight climb() {
  Flight flight;
  for (int i = 0; i <= 20; ++i) {
    AircraftState state;
    state.time = 100 + i * 0.1;
    state.position = {Degrees{36}, Degrees{128 + i * 1e-4}, Metres{1000.0 + i}};
    flight.states.push_back(state);
  }
  return flight;
}

std::vector<AircraftState> playAll(double stepS, double speed) {
  FlightPlayback playback;
  playback.load(climb());
  playback.setSpeed(speed);
  playback.play(0);
  std::vector<AircraftState> states;
  for (int i = 1; playback.playing() && i < 100000; ++i) playback.advance(i * stepS, states);
  EXPECT_FALSE(playback.playing()) << "it ends";
  return states;
}

TEST(FlightPlayback, fliesTheSameStatesHoweverOftenPicturesAreDrawn) {
  const std::vector<AircraftState> often = playAll(0.003, 1), seldom = playAll(0.08, 1),
                                   fast = playAll(0.05, 7);
  ASSERT_EQ(often.size(), 121u) << "two seconds at 60 Hz, both ends";
  EXPECT_EQ(often, seldom);
  EXPECT_EQ(often, fast);
  for (std::size_t i = 0; i < often.size(); ++i) {
    EXPECT_EQ(often[i].packet, i + 1);
    EXPECT_NEAR(often[i].position.height.value(), 1000 + double(i) / 60 * 10, 0.01);
  }
}

TEST(FlightPlayback, aStallDoesNotSkipAndALoopBeginsAgain) {
  FlightPlayback playback;
  playback.load(climb());
  playback.play(0);
  std::vector<AircraftState> states;
  playback.advance(100, states);
  EXPECT_DOUBLE_EQ(playback.position(), 0.5);
  playback.setLoop(true);
  for (int i = 1; i <= 20; ++i) playback.advance(100 + i * 0.1, states);
  EXPECT_TRUE(playback.playing());
  EXPECT_NEAR(playback.position(), 0.5, 1e-9);
  playback.seek(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(playback.position(), 0);
  playback.seek(1e9);
  EXPECT_EQ(playback.position(), playback.duration());
}

TEST(FreeCamera, movesAlongItsLineOfSightAtItsSpeed) {
  FreeCamera camera;
  const GeodeticPosition start{Degrees{36.6}, Degrees{128.3}, Metres{1000}};
  camera.place(start, {Degrees{90}, Degrees{-30}, Degrees{0}});
  ASSERT_TRUE(camera.press(Qt::Key_W));
  EXPECT_FALSE(camera.press(Qt::Key_Z));
  camera.advance(0.1);
  const double way = length(toEcef(camera.position()) - toEcef(start));
  EXPECT_NEAR(way, camera.speedMps() * 0.1, 1e-6);
  EXPECT_NEAR(camera.position().height.value(), 1000 - way / 2, 1e-3) << "30 degrees down";
  EXPECT_NEAR(camera.position().latitude.value(), 36.6, 1e-6) << "due east";
  EXPECT_GT(camera.position().longitude.value(), 128.3);
  camera.release(Qt::Key_W);
  EXPECT_FALSE(camera.moving());
}

TEST(FreeCamera, keepsItsSensesAtPolesDateLineAndStraightUp) {
  for (const GeodeticPosition& at : {GeodeticPosition{Degrees{90}, Degrees{0}, Metres{100}},
                                     GeodeticPosition{Degrees{-90}, Degrees{180}, Metres{100}},
                                     GeodeticPosition{Degrees{0}, Degrees{179.99999}, Metres{100}}}) {
    FreeCamera camera;
    camera.place(at, {Degrees{90}, Degrees{0}, Degrees{0}});
    camera.changeSpeed(1000);
    camera.press(Qt::Key_W);
    for (int i = 0; i < 10; ++i) camera.advance(1);
    EXPECT_LE(std::abs(camera.position().longitude.value()), 180);
    EXPECT_LE(std::abs(camera.position().latitude.value()), 90);
    EXPECT_TRUE(std::isfinite(camera.position().height.value()));
    camera.look(Degrees{-1000}, Degrees{500});
    EXPECT_EQ(camera.attitude().pitch.value(), 90);
    EXPECT_GE(camera.attitude().heading.value(), 0);
    EXPECT_LT(camera.attitude().heading.value(), 360);
  }
}

TEST(WorkbenchOptions, readWhatTheCommandLineSays) {
  const auto good =
      workbench::parseOptions({"trimtab", "--preset", "as-published", "--listen", "8010", "--after-s", "2.5",
                               "--size", "800x600", "--head", "sweep:180/1s"});
  ASSERT_FALSE(good.exitCode);
  EXPECT_EQ(good.options.head, "sweep:180/1s");
  EXPECT_EQ(good.options.preset, "as-published");
  EXPECT_EQ(good.options.listenPort, 8010);
  EXPECT_EQ(good.options.afterS, 2.5);
  EXPECT_EQ(good.options.window, QSize(800, 600));
}

TEST(WorkbenchOptions, wrongUsageEndsWithTwo) {
  for (const QStringList& wrong : {QStringList{"--nonsense"},
                                   {"--listen", "65536"},
                                   {"--listen", "x"},
                                   {"--after-s", "-1"},
                                   {"--after-s", "nan"},
                                   {"--size", "10x10"},
                                   {"stray"}}) {
    const auto parsed = workbench::parseOptions(QStringList{"trimtab"} + wrong);
    EXPECT_EQ(parsed.exitCode, 2) << wrong.join(' ').toStdString();
  }
  EXPECT_EQ(workbench::parseOptions({"trimtab", "--help"}).exitCode, 0);
  EXPECT_EQ(workbench::parseOptions({"trimtab", "--version"}).exitCode, 0);
}

}  // namespace
}  // namespace trimtab
