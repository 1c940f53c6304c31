// SPDX-License-Identifier: GPL-3.0-or-later
#include <GL/gl.h>

#include <QDockWidget>
#include <QElapsedTimer>
#include <cmath>
#include <fstream>

#include "app/link/link.h"
#include "gui_support.h"
#include "tests/app/ig_support.h"
#include "trimtab/host/flight.h"

/// Everything at once: a flight over UDP with a head that sweeps and weather that changes, all docks open.
/// It lasts a third of a minute unless TRIMTAB_LONG_FLIGHT_S gives other seconds (600 is the whole flight).
namespace trimtab::test {
namespace {

double secondsToFly() {
  const char* text = std::getenv("TRIMTAB_LONG_FLIGHT_S");
  return text ? std::atof(text) : 20;
}

/// Our flight with a head that rests, glances and sweeps 180 degrees in a second, and a new weather every
/// half minute: rain and snow of all severities, fog, clear air.
Flight eventfulFlight() {
  Result<Flight> flight = readFlight(sampleFlight());
  EXPECT_TRUE(flight) << toString(flight.findings());
  for (AircraftState& state : (*flight).states) {
    const double t = state.time - flight->beginS(), phase = std::fmod(t, 4.0);
    const double heading = phase < 1   ? -90 + 180 * phase
                           : phase < 2 ? 90
                           : phase < 3 ? 90 - 180 * (phase - 2)
                                       : -90;
    state.head = Attitude{Degrees{heading / 2}, Degrees{5 * std::sin(t)}, {}};
    const int weather = static_cast<int>(t / 30) % 6;
    state.weather = HostWeather{};
    state.weather->precipitation = weather == 0 || weather == 3 ? Precipitation::none
                                   : weather < 3                ? Precipitation::rain
                                                                : Precipitation::snow;
    state.weather->severity = weather == 0 || weather == 3 ? 0 : 1 + (weather % 3);
    state.visibility = Metres{weather == 0 ? 40000.0 : weather == 3 ? 1500.0 : 8000.0 - 1000 * weather};
  }
  return std::move(flight).value();
}

double residentMiB() {
  std::ifstream status("/proc/self/statm");
  double size = 0, resident = 0;
  status >> size >> resident;
  return resident * 4096 / (1 << 20);
}

class LongFlight : public Bench {};

TEST_F(LongFlight, holdsWithHeadMotionWeatherAndAllDocksOpen) {
  const ScratchDir dir;
  const double seconds = secondsToFly();
  for (const auto& [key, value] : {std::pair{"weather.source", "host"}, {"symbology.enabled", "true"}})
    ASSERT_TRUE(w().draft().setText(key, value).empty()) << key;
  const std::string exported = (dir / "export.json").string(), trace = (dir / "own.csv").string();
  ASSERT_TRUE(w().controllers().document->exportTo(QString::fromStdString(exported), ExportFormat::json,
                                                   "test", "long flight"));
  for (QDockWidget* dock : w().findChildren<QDockWidget*>()) dock->show();
  const std::uint16_t port = listen();
  ASSERT_TRUE(w().controllers().trace->start(QString::fromStdString(trace)));

  unsigned errors = 0;
  QObject::connect(&w().viewport(), &workbench::Viewport::painted, &w(), [&] {
    w().viewport().makeCurrent();
    errors += glGetError() != GL_NO_ERROR;
    w().viewport().doneCurrent();
  });
  const Flight flight = eventfulFlight();
  link::PlayOptions options;
  options.to = {"127.0.0.1", port};
  options.protocol = WireProtocol::cigi3;
  options.speed = std::max(1.0, flight.durationS() / seconds);
  // Use a recorded head if there is one, else the flight's own sweeps.
  if (const auto recorded = sharedDir() / "data/headmotion-mv360/user1_euler.txt";
      std::filesystem::exists(recorded)) {
    Result<HeadLog> log = readHeadLog(recorded);
    ASSERT_TRUE(log) << toString(log.findings());
    options.head = std::move(log).value();
  }
  auto player = link::FeedPlayer::start(flight, options);
  ASSERT_TRUE(player) << toString(player.findings());

  // An event is answered before a second picture is drawn, whatever else goes on; docks take turns in front.
  std::size_t late = 0;
  double third = 0, last = 0;
  std::size_t turn = 0;
  const QList<QDockWidget*> docks = w().findChildren<QDockWidget*>();
  QElapsedTimer flown;
  flown.start();
  while (!(*player)->finished() && double(flown.elapsed()) < (seconds + 60) * 1000) {
    docks[static_cast<qsizetype>(turn++ % static_cast<std::size_t>(docks.size()))]->raise();
    bool answered = false;
    const std::uint64_t before = paints();
    QMetaObject::invokeMethod(
        &w(), [&answered] { answered = true; }, Qt::QueuedConnection);
    ASSERT_TRUE(waitFor([&answered] { return answered; })) << "the window hangs";
    late += paints() - before > 1;
    QTest::qWait(100);
    last = residentMiB();
    if (third == 0 && double(flown.elapsed()) > seconds * 1000 / 3) third = last;
  }
  ASSERT_TRUE((*player)->finished());
  w().controllers().trace->stop();
  // Another program that takes the cores for a moment is no fault of the window's.
  EXPECT_LE(late, 2 + turn / 20) << "events that waited for more than one picture, of " << turn;
  EXPECT_EQ(errors, 0u) << "GL errors";
  // Measuring errors keeps the finest tiles that its references have shown, as far as the terrain goes.
  EXPECT_LT(last - third, 128) << "MiB more at the end than after a third, however long the flight";
  std::cout << "resident after a third " << third << " MiB, at the end " << last << " MiB; " << paints()
            << " pictures, " << session().packets() << " packets" << std::endl;

  const auto own = readTrace(trace);
  ASSERT_TRUE(own) << toString(own.findings());
  std::set<std::string_view> fell;
  bool blurred = false, coarser = false;
  for (const TraceRow& row : *own) {
    fell.insert(toText(row.decision.weather.precipitation));
    blurred |= row.decision.motion.blur.strength > 0;
    coarser |= row.decision.motion.lodScale > 1;
  }
  EXPECT_EQ(fell, (std::set<std::string_view>{"none", "rain", "snow"}));
  EXPECT_TRUE(blurred);
  EXPECT_TRUE(coarser);

  IgProcess replay({"--preset", exported, "--terrain", sampleTerrain().string(), "--flight", trace,
                    "--headless", "--size", "32x32", "--trace", (dir / "replay.csv").string()});
  ASSERT_EQ(replay.end(), 0) << replay.err();
  const auto again = readTrace(dir / "replay.csv");
  ASSERT_TRUE(again) << toString(again.findings());
  ASSERT_EQ(again->size(), own->size());
  for (std::size_t i = 0; i < own->size(); ++i)
    ASSERT_EQ((*again)[i].decision, (*own)[i].decision) << "row " << i;
}

}  // namespace
}  // namespace trimtab::test
