// SPDX-License-Identifier: GPL-3.0-or-later
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>

#include <QDockWidget>
#include <QElapsedTimer>
#include <QProcess>
#include <atomic>
#include <map>
#include <thread>

#include "app/link/link.h"
#include "gui_support.h"
#include "tests/app/ig_support.h"
#include "trimtab/host/flight.h"
#include "views/editors/curve_plot.h"
#include "views/editors/membership_editor.h"
#include "views/panels/plots_panel.h"

namespace trimtab::test {
namespace {

/// Gives every datagram that comes to its port to two others: two programs hear the same host.
class Tee {
 public:
  Tee(std::uint16_t first, std::uint16_t second)
      : socket_(::socket(AF_INET, SOCK_DGRAM, 0)), to_{first, second} {
    sockaddr_in own = address(0);
    socklen_t size = sizeof own;
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&own), size), 0);
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&own), &size);
    port_ = ntohs(own.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~Tee() {
    stop_ = true;
    thread_.join();
    ::close(socket_);
  }
  std::uint16_t port() const { return port_; }

 private:
  static sockaddr_in address(std::uint16_t port) {
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    a.sin_port = htons(port);
    return a;
  }
  void run() {
    char bytes[2048];
    while (!stop_) {
      pollfd wait{socket_, POLLIN, 0};
      if (::poll(&wait, 1, 50) <= 0) continue;
      const ssize_t n = ::recv(socket_, bytes, sizeof bytes, 0);
      for (const std::uint16_t port : to_) {
        const sockaddr_in there = address(port);
        if (n > 0)
          ::sendto(socket_, bytes, static_cast<std::size_t>(n), 0, reinterpret_cast<const sockaddr*>(&there),
                   sizeof there);
      }
    }
  }
  int socket_;
  std::uint16_t port_ = 0;
  const std::array<std::uint16_t, 2> to_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

std::unique_ptr<link::FeedPlayer> play(std::uint16_t port, double startS, double speed = 1) {
  Result<Flight> flight = readFlight(sampleFlight());
  EXPECT_TRUE(flight) << toString(flight.findings());
  link::PlayOptions options;
  options.to = {"127.0.0.1", port};
  options.startS = startS;
  options.speed = speed;
  auto started = link::FeedPlayer::start(*flight, options);
  EXPECT_TRUE(started) << toString(started.findings());
  return std::move(started).value();
}

double climb(double altitudeFt) {
  return climbsThrough(*readFlight(sampleFlight()), altitudeFt);
}

/// Presses the left button at one point of the screen, moves to another in steps, and lets go: events of the
/// X server.
void dragOnScreen(QPoint from, QPoint to) {
  QStringList commands{"mousemove", QString::number(from.x()), QString::number(from.y()), "mousedown", "1"};
  for (int step = 1; step <= 8; ++step) {
    const QPoint at = from + (to - from) * step / 8;
    commands << "mousemove" << QString::number(at.x()) << QString::number(at.y()) << "sleep"
             << "0.02";
  }
  commands << "mouseup"
           << "1";
  QProcess xdotool;
  xdotool.start("xdotool", commands);
  ASSERT_TRUE(waitFor([&] { return xdotool.state() == QProcess::NotRunning; }));
  ASSERT_EQ(xdotool.exitCode(), 0) << xdotool.readAllStandardError().toStdString();
}

class WorkbenchLoop : public Bench {};

TEST_F(WorkbenchLoop, aDraggedBreakpointChangesTheDecisionWithinASecond) {
  const auto host = play(listen(), climb(5000));
  ASSERT_TRUE(waitFor([&] { return w().feed().source() == workbench::Feed::Source::host; }));
  host->pause(true);
  const std::uint64_t packets = session().packets();
  ASSERT_TRUE(waitFor([&] { return session().packets() > packets + 20; })) << "a paused host sends on";
  const FrameDecision before = session().decision();
  EXPECT_NEAR(before.altitudeFt, 5000, 250);

  views::CurvePlot& plot = w().findChild<views::MembershipEditor*>()->altitude().plot();
  const QPoint from = plot.mapToGlobal(plot.pixelOf({5000, 0.6}).toPoint());
  const QPoint to = plot.mapToGlobal(plot.pixelOf({4500, 0.2}).toPoint());
  QElapsedTimer sinceEdit;
  double decidedAfterS = -1;
  QObject::connect(&w().draft(), &views::Draft::valueChanged, &w(), [&] {
    if (!sinceEdit.isValid()) sinceEdit.start();
  });
  QObject::connect(&w().viewport(), &workbench::Viewport::painted, &w(), [&] {
    if (decidedAfterS < 0 && sinceEdit.isValid() &&
        session().decision().altitudeMembership != before.altitudeMembership)
      decidedAfterS = double(sinceEdit.nsecsElapsed()) * 1e-9;
  });
  dragOnScreen(from, to);
  ASSERT_TRUE(waitFor([&] { return decidedAfterS >= 0; })) << "no decision and picture after the drag";
  EXPECT_LT(decidedAfterS, 1.0);

  const CurvePoints curve = w().draft().parameters().altitude.curve;
  ASSERT_EQ(curve.size, 5u);
  EXPECT_NEAR(curve.point[1].x, 4500, 60) << "the breakpoint follows the mouse";
  EXPECT_NEAR(curve.point[1].y, 0.2, 0.03);
  // The line through the dragged point and the next one, by hand.
  const double h = session().decision().altitudeFt;
  const CurvePoint a = curve.point[1], b = curve.point[2];
  EXPECT_NEAR(session().decision().altitudeMembership, a.y + (b.y - a.y) * (h - a.x) / (b.x - a.x), 1e-9);
  EXPECT_EQ(w().draft().undoStack().count(), 1) << "one drag is one step";
  EXPECT_TRUE(w().isWindowModified());
  w().draft().undoStack().undo();
  EXPECT_EQ(w().draft().parameters().altitude.curve, TuningParameters{}.altitude.curve);
}

TEST_F(WorkbenchLoop, theImageGeneratorDecidesAlikeFromTheExportAndReplaysTheTraceToTheBit) {
  ScratchDir dir;
  ASSERT_TRUE(
      w().draft().setText("fuzzy.altitude.curve_ft", "3900:1 4600:0.35 6000:0.3 7000:0.1 8000:0").empty());
  ASSERT_TRUE(w().controllers().document->exportTo(QString::fromStdString((dir / "export.json").string()),
                                                   ExportFormat::json, "test", "loop"));
  IgProcess ig({"--preset", (dir / "export.json").string(), "--terrain", sampleTerrain().string(), "--listen",
                "0", "--headless", "--size", "320x200", "--trace", (dir / "ig.csv").string()});
  const std::uint16_t igPort = ig.port();
  ASSERT_NE(igPort, 0) << ig.err();
  const std::uint16_t ownPort = listen();
  ASSERT_TRUE(w().controllers().trace->start(QString::fromStdString((dir / "own.csv").string())));
  {
    Tee tee(ownPort, igPort);
    // Through every band in some seconds: climb, cruise and descent at many times their speed.
    const auto host = play(tee.port(), climb(3500), 40);
    ASSERT_TRUE(waitFor([&] { return host->finished(); }));
    ASSERT_TRUE(waitFor([&] { return session().packets() >= host->sent() * 9 / 10; }));
  }
  ASSERT_TRUE(settle());
  w().controllers().trace->stop();
  ig.signal(SIGTERM);
  ASSERT_EQ(ig.end(), 0) << ig.err();

  const auto own = readTrace(dir / "own.csv"), theirs = readTrace(dir / "ig.csv");
  ASSERT_TRUE(own) << toString(own.findings());
  ASSERT_TRUE(theirs) << toString(theirs.findings());
  std::map<std::uint64_t, const TraceRow*> byPacket;
  for (const TraceRow& row : *theirs) byPacket[row.input.state.packet] = &row;
  std::size_t joined = 0;
  std::set<int> bands;
  for (const TraceRow& row : *own) {
    const auto match = byPacket.find(row.input.state.packet);
    if (match == byPacket.end()) continue;
    ++joined;
    bands.insert(row.decision.band);
    ASSERT_EQ(row.decision, match->second->decision) << "packet " << row.input.state.packet;
    ASSERT_EQ(row.input.state.position, match->second->input.state.position);
  }
  EXPECT_GT(joined, 300u);
  EXPECT_GE(joined * 10, own->size() * 9) << "both heard nearly all";
  EXPECT_GE(bands.size(), 3u) << "the flight leads through the bands";

  IgProcess replay({"--preset", (dir / "export.json").string(), "--terrain", sampleTerrain().string(),
                    "--flight", (dir / "own.csv").string(), "--headless", "--size", "64x64", "--trace",
                    (dir / "replay.csv").string()});
  ASSERT_EQ(replay.end(), 0) << replay.err();
  const auto again = readTrace(dir / "replay.csv");
  ASSERT_TRUE(again) << toString(again.findings());
  ASSERT_EQ(again->size(), own->size());
  for (std::size_t i = 0; i < own->size(); ++i) {
    ASSERT_EQ((*again)[i].decision, (*own)[i].decision) << "row " << i;
    ASSERT_EQ((*again)[i].before, (*own)[i].before) << "row " << i;
    ASSERT_EQ((*again)[i].input.state.position, (*own)[i].input.state.position) << "row " << i;
    ASSERT_EQ((*again)[i].input.state.attitude, (*own)[i].input.state.attitude) << "row " << i;
  }
}

/// The follower is built as its users build: from its own folder, against nothing but an installed library.
TEST_F(WorkbenchLoop, aProgramOutsideTheTreeWritesTheTraceOfTheWorkbench) {
  ScratchDir dir;
  const std::string prefix = (dir / "prefix").string(), build = (dir / "build").string();
  const Ran built = run("cmake --install " TRIMTAB_BUILD_DIR " --component core --prefix " + prefix +
                        " && cmake -S " + (sourceDir() / "tests/core/install/follower").string() + " -B " +
                        build + " -G Ninja -DCMAKE_PREFIX_PATH=" + prefix + " && cmake --build " + build);
  ASSERT_EQ(built.exitCode, 0) << built.out << built.err;
  ASSERT_TRUE(w().draft().setText("fuzzy.hysteresis", "0.02").empty());
  ASSERT_TRUE(w().controllers().document->exportTo(QString::fromStdString((dir / "export.json").string()),
                                                   ExportFormat::json, "test", "follower"));
  QProcess follower;
  follower.start(QString::fromStdString(build + "/follower"),
                 {QString::fromStdString((dir / "export.json").string()),
                  QString::fromStdString((dir / "theirs.csv").string())});
  ASSERT_TRUE(waitFor([&] { return follower.canReadLine(); }))
      << follower.readAllStandardError().toStdString();
  const std::uint16_t theirPort = follower.readLine().trimmed().toUShort(), ownPort = listen();
  ASSERT_TRUE(w().controllers().trace->start(QString::fromStdString((dir / "own.csv").string())));
  {
    Tee tee(ownPort, theirPort);
    const auto host = play(tee.port(), climb(3500), 40);
    ASSERT_TRUE(waitFor([&] { return host->finished(); }));
  }
  ASSERT_TRUE(waitFor([&] { return follower.state() == QProcess::NotRunning; }));
  ASSERT_EQ(follower.exitCode(), 0) << follower.readAllStandardError().toStdString();
  w().controllers().trace->stop();

  const auto own = readTrace(dir / "own.csv"), theirs = readTrace(dir / "theirs.csv");
  ASSERT_TRUE(own && theirs) << toString(own.findings()) << toString(theirs.findings());
  std::map<std::uint64_t, const TraceRow*> byPacket;
  for (const TraceRow& row : *theirs) byPacket[row.input.state.packet] = &row;
  std::size_t joined = 0;
  for (const TraceRow& row : *own) {
    const auto match = byPacket.find(row.input.state.packet);
    if (match == byPacket.end()) continue;
    ++joined;
    ASSERT_EQ(row.decision, match->second->decision) << "packet " << row.input.state.packet;
    ASSERT_EQ(row.before, match->second->before) << "packet " << row.input.state.packet;
    ASSERT_EQ(row.input.state.position, match->second->input.state.position);
    ASSERT_EQ(row.input.state.attitude, match->second->input.state.attitude);
  }
  EXPECT_GT(joined, 300u);
  EXPECT_GE(joined * 10, own->size() * 9) << "both heard nearly all";
}

TEST_F(WorkbenchLoop, aHostThatFallsSilentIsSaidAndCostsNothing) {
  {
    const auto host = play(listen(), climb(4500));
    ASSERT_TRUE(waitFor([&] { return session().packets() > 30; }));
  }
  const QString silent = "SILENT";
  ASSERT_TRUE(waitFor([&] { return w().messages().text().contains("fell silent"); }));
  w().dock("host")->raise();
  EXPECT_TRUE(waitFor([&] { return labelSays(w(), silent); }));
  using Mark = views::PlotMarks::Kind;
  EXPECT_TRUE(w().panels().plots->marks().lasts(Mark::host_silent)) << "the plots show it too";
  w().dock("decision")->raise();
  EXPECT_TRUE(settle());
  w().feed().closeHost();
  EXPECT_EQ(w().feed().source(), workbench::Feed::Source::camera);
  EXPECT_FALSE(w().panels().plots->marks().lasts(Mark::host_silent));
}

TEST_F(WorkbenchLoop, aFlightPlaysHereAndPausesAndScrubs) {
  ASSERT_TRUE(w().controllers().flight->open(QString::fromStdString(sampleFlight())));
  w().feed().seekHere(climb(6000));
  EXPECT_NEAR(session().decision().altitudeFt, 6000, 60);
  // However slowly images are drawn, some of the flight are among the newest frames of the plots.
  views::PlotsPanel& plots = *w().panels().plots;
  w().feed().playHere();
  const double from = w().feed().playback().position();
  const std::uint64_t first = plots.buffer().end();
  ASSERT_TRUE(waitFor(
      [&] { return w().feed().playback().position() > from + 0.5 && plots.buffer().end() > first + 8; }));
  w().feed().pauseHere();
  const double stopped = w().feed().playback().position();
  ASSERT_TRUE(settle()) << "a paused flight paints nothing";
  EXPECT_EQ(w().feed().playback().position(), stopped);
  EXPECT_EQ(session().input().state.packet, std::uint64_t(std::floor(stopped * 60)) + 1);

  const std::uint64_t frame = plots.buffer().end() - 4;
  EXPECT_EQ(plots.buffer().value(views::Trace::allowed_error_px, frame),
            static_cast<float>(session().parameters()->lod.screenSpaceError.value()));
  EXPECT_EQ(plots.buffer().value(views::Trace::render_scale, frame), 1.0f);
  const double state = plots.buffer().stateTime(frame);
  plots.chooseFrame(frame);
  EXPECT_NEAR(w().feed().playback().flight().states.front().time + w().feed().playback().position(), state,
              1e-9)
      << "a chosen frame takes a paused flight there";
}

}  // namespace
}  // namespace trimtab::test
