#include <iostream>

#include "app/link/link.h"
#include "ig_support.h"
#include "trimtab/host/flight.h"

#include <X11/Xlib.h>  // last: its macros are words that others use

namespace trimtab {
namespace {

using test::IgProcess;

TEST(IgWindow, showsWhatTheHeadlessOneDraws) {
  const test::ScratchDir dir;
  test::writeFile(dir / "flight.csv", flightCsv(test::weavingFlight(8)));
  const auto picture = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--preset",     "default",
                                       "--terrain",    test::smallTerrain().string(),
                                       "--flight",     (dir / "flight.csv").string(),
                                       "--size",       "400x300",
                                       "--screenshot", (dir / name).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    IgProcess ig(arguments);
    EXPECT_EQ(ig.end(), 0) << ig.err();
  };
  picture("window.png", {});
  picture("headless.png", {"--headless"});
  // Two ways to a context may round a channel differently by one step here and there, and by no more.
  const test::Ran compared = test::run("compare -metric AE -fuzz 0.5% " + (dir / "window.png").string() +
                                       " " + (dir / "headless.png").string() + " null:");
  EXPECT_EQ(compared.exitCode, 0) << compared.err << " of 120000 pixels differ";
}

/// Starts a flight in a window and ends it by `end`, which gets the window. Picture and trace must be whole
/// then.
void expectGoodOrderAfter(const std::function<void(::Window)>& end) {
  const test::ScratchDir dir;
  test::writeFile(dir / "flight.csv", flightCsv(test::weavingFlight(2000, 10)));
  IgProcess ig({"--preset", "default", "--terrain", test::smallTerrain().string(), "--flight",
                (dir / "flight.csv").string(), "--realtime", "--size", "160x90", "--trace",
                (dir / "trace.csv").string(), "--screenshot", (dir / "last.png").string()});
  const test::Ran found = test::run("timeout 60 xdotool search --sync --onlyvisible --pid " +
                                    std::to_string(ig.pid()) + " --name trimtab-ig");
  ASSERT_EQ(found.exitCode, 0) << found.err << ig.err();
  ASSERT_TRUE(ig.until([&] {
    std::error_code error;
    return std::filesystem::file_size(dir / "trace.csv.part", error) > 5000 && !error;
  }));
  end(std::stoul(found.out));
  EXPECT_EQ(ig.end(), 0) << ig.err();
  EXPECT_TRUE(std::filesystem::exists(dir / "last.png"));
  const Result<std::vector<TraceRow>> rows = readTrace(dir / "trace.csv");
  ASSERT_TRUE(rows) << toString(rows.findings());
  EXPECT_LT(rows->size(), 2000u) << "the flight was not over";
}

TEST(IgWindow, aKeyEndsItAsASignalDoes) {
  expectGoodOrderAfter([](::Window window) {
    EXPECT_EQ(test::run("xdotool key --window " + std::to_string(window) + " q").exitCode, 0);
  });
}

TEST(IgWindow, theButtonOfTheWindowManagerEndsItToo) {
  expectGoodOrderAfter([](::Window window) {
    Display* const display = XOpenDisplay(nullptr);
    ASSERT_TRUE(display);
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window;
    event.xclient.message_type = XInternAtom(display, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display, "WM_DELETE_WINDOW", False));
    EXPECT_NE(XSendEvent(display, window, False, NoEventMask, &event), 0);
    XCloseDisplay(display);
  });
}

TEST(IgWindow, movesTheEyeBetweenPacketsAndStandsStillWhenTheHostIsSilent) {
  const test::ScratchDir dir;
  IgProcess ig({"--preset", "default", "--terrain", test::smallTerrain().string(), "--listen", "0", "--size",
                "160x90", "--trace", (dir / "trace.csv").string(), "--json"});
  ASSERT_NE(ig.port(), 0) << ig.err();
  link::PlayOptions options;
  options.to.port = ig.port();
  options.rateHz = 0;
  Flight flight = test::weavingFlight(2000, 10);  // at 70 m/s
  flight.states.resize(21);
  auto player = link::FeedPlayer::start(flight, options);
  ASSERT_TRUE(player) << toString(player.findings());
  ASSERT_TRUE(ig.until([&] { return (*player)->finished(); }));
  std::this_thread::sleep_for(
      std::chrono::milliseconds(1500));  // host.silence_after_ms, and a picture under load
  const double share = ig.share(2, 0.01);
  std::cout << "idle in a window: " << share * 100 << " % of a core" << std::endl;
  EXPECT_LT(share, 0.01);
  ig.signal(SIGTERM);
  ASSERT_EQ(ig.end(), 0) << ig.err();
  ASSERT_TRUE(ig.summary().is_object()) << ig.out();
  EXPECT_EQ(ig.summary()["packets"], 21);
  EXPECT_GT(ig.summary()["frames"], 30) << "10 packets a second, and pictures between them";
  const Result<std::vector<TraceRow>> rows = readTrace(dir / "trace.csv");
  ASSERT_TRUE(rows) << toString(rows.findings());
  EXPECT_EQ(rows->size(), 21u) << "the pictures between packets decide nothing";
}

}  // namespace
}  // namespace trimtab
