#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <atomic>
#include <fstream>
#include <iostream>

#include "app/link/link.h"
#include "ig_support.h"
#include "tests/csv_cells.h"
#include "trimtab/host/flight.h"

namespace trimtab {
namespace {

using test::IgProcess;

class IgLink : public ::testing::Test {
 protected:
  IgLink() { writePreset(defaultParameters()); }

  void writePreset(const ValidatedParameters& parameters) const {
    ASSERT_TRUE(writeAtomically(dir_ / "preset.json", test::exported(parameters)));
  }
  IgProcess listen(std::vector<std::string> more = {},
                   const std::filesystem::path& terrain = test::smallTerrain()) const {
    std::vector<std::string> arguments{
        "--preset", (dir_ / "preset.json").string(), "--terrain",  terrain.string(), "--listen", "0",
        "--trace",  (dir_ / "trace.csv").string(),   "--headless", "--size",         "320x200",  "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return IgProcess(arguments);
  }
  /// Rows written so far.
  std::size_t written() const {
    const std::string part = test::readFile(dir_ / "trace.csv.part");
    const auto lines = std::count(part.begin(), part.end(), '\n');
    return lines > 0 ? static_cast<std::size_t>(lines - 1) : 0;
  }
  /// Plays the flight's rows as they are and waits until the IG has a row for each.
  void play(const IgProcess& ig, const Flight& flight, WireProtocol protocol, std::size_t rowsAfter) const {
    link::PlayOptions options;
    options.to.port = ig.port();
    options.protocol = protocol;
    options.rateHz = 0;
    auto player = link::FeedPlayer::start(flight, options);
    ASSERT_TRUE(player) << toString(player.findings());
    EXPECT_TRUE(ig.until([&] { return (*player)->finished() && written() >= rowsAfter; }))
        << written() << " rows of " << rowsAfter << ", sent " << (*player)->sent() << "\n"
        << ig.err();
    EXPECT_EQ((*player)->sent(), flight.states.size());
  }
  std::vector<TraceRow> rows() const {
    const Result<std::vector<TraceRow>> read = readTrace(dir_ / "trace.csv");
    EXPECT_TRUE(read) << toString(read.findings());
    return read ? *read : std::vector<TraceRow>{};
  }

  test::ScratchDir dir_;
};

TEST_F(IgLink, decidesEveryPacketOnceAsDecideDoes) {
  const Flight flight = test::weavingFlight(300);
  for (const WireProtocol protocol : {WireProtocol::cigi3, WireProtocol::native_fdm}) {
    IgProcess ig = listen();
    ASSERT_NE(ig.port(), 0) << ig.err();
    play(ig, flight, protocol, flight.states.size());
    ig.signal(SIGINT);
    ASSERT_EQ(ig.end(), 0) << ig.err();

    const std::vector<TraceRow> trace = rows();
    ASSERT_EQ(trace.size(), flight.states.size());
    const std::vector<FrameDecision> decisions = test::decided(trace, defaultParameters());
    std::size_t drawn = 0;
    for (std::size_t i = 0; i < trace.size(); ++i) {
      const AircraftState& sent = flight.states[i];
      const AircraftState& got = trace[i].input.state;
      EXPECT_NEAR(got.position.latitude.value(), sent.position.latitude.value(), 1e-9) << i;
      EXPECT_NEAR(got.position.height.value(), sent.position.height.value(), 1e-6) << i;
      EXPECT_NEAR(got.attitude.pitch.value(), sent.attitude.pitch.value(), 1e-4) << i;
      if (i > 0) {
        EXPECT_GT(got.packet, trace[i - 1].input.state.packet) << i;
      }
      EXPECT_EQ(trace[i].decision, decisions[i]) << i;
      drawn += trace[i].frame.has_value();
    }
    const nlohmann::json summary = ig.summary();
    EXPECT_EQ(summary["packets"], flight.states.size());
    EXPECT_EQ(summary["host"]["bad"], 0);
    EXPECT_EQ(summary["frames"], drawn) << "headless, a picture is drawn for a packet and for nothing else";
    EXPECT_EQ(summary["host"]["lost"].is_null(), protocol == WireProtocol::native_fdm)
        << "it carries no frame numbers";
    // Reported, not asserted: how fast this machine is, is no property of the code.
    std::cout << "kernel to decoded p99 " << summary["decoded_p99_ms"] << " ms; to finished picture p99 "
              << summary["picture_p99_ms"] << " ms, or " << summary["picture_p99_frames"]
              << " median frames; frame median " << summary["frame_median_ms"] << " ms" << std::endl;
  }
}

TEST_F(IgLink, watchTakesAChangedExportAndKeepsTheLastGoodOne) {
  const auto level = [](double from) {
    Flight flight;
    for (int i = 0; i < 20; ++i) {
      AircraftState state = test::weavingFlight(1).states[0];
      state.time = from + i * 0.02;
      state.packet = static_cast<std::uint64_t>(state.time * 100);
      state.position.height = Feet{5000}.as<Metres>();
      state.attitude.pitch = Degrees{0};
      flight.states.push_back(state);
    }
    return flight;
  };
  IgProcess ig = listen({"--watch"});
  ASSERT_NE(ig.port(), 0) << ig.err();
  play(ig, level(0), WireProtocol::native_fdm, 20);

  const auto lower = test::edited([](TuningParameters& p) { p.altitude.curve.point[1].y = 0.35; });
  writePreset(lower);
  ASSERT_TRUE(ig.says("loaded again")) << ig.err();
  play(ig, level(1), WireProtocol::native_fdm, 40);

  std::string damaged =
      test::exported(test::edited([](TuningParameters& p) { p.altitude.curve.point[1].y = 0.8; }));
  const std::size_t digit = damaged.find("0.8");
  ASSERT_NE(digit, std::string::npos);
  damaged[digit + 2] = '7';
  ASSERT_TRUE(writeAtomically(dir_ / "preset.json", damaged));
  ASSERT_TRUE(ig.says("the last good preset stays")) << ig.err();
  EXPECT_NE(ig.err().find("checksum"), std::string::npos) << ig.err();
  play(ig, level(2), WireProtocol::native_fdm, 60);

  test::writeFile(dir_ / "preset.json", damaged.substr(0, damaged.size() / 2));
  ASSERT_TRUE(ig.says("the last good preset stays", 2)) << ig.err();
  std::filesystem::remove(dir_ / "preset.json");
  play(ig, level(3), WireProtocol::native_fdm, 80);

  writePreset(defaultParameters());
  ASSERT_TRUE(ig.says("loaded again", 2)) << ig.err();
  play(ig, level(4), WireProtocol::native_fdm, 100);

  ig.signal(SIGINT);
  ASSERT_EQ(ig.end(), 0) << ig.err();
  const std::vector<TraceRow> trace = rows();
  ASSERT_EQ(trace.size(), 100u);
  const double totals[] = {1.1, 0.85, 0.85, 0.85, 1.1};
  for (std::size_t i = 0; i < trace.size(); ++i)
    EXPECT_NEAR(trace[i].decision.totalMembership, totals[i / 20], 1e-4) << i;
  EXPECT_EQ(ig.summary()["preset_reloads"], 2);
  EXPECT_EQ(ig.summary()["presets_refused"], 2);
}

TEST_F(IgLink, watchFollowsALinkToAnotherTerrainAndKeepsTheLastGoodOne) {
  const std::filesystem::path link = dir_ / "terrain", broken = dir_ / "broken";
  const auto lead = [&](const std::filesystem::path& to) {
    std::filesystem::create_directory_symlink(to, dir_ / "next");
    std::filesystem::rename(dir_ / "next", link);
  };
  std::filesystem::copy(test::smallTerrain(), dir_ / "other", std::filesystem::copy_options::recursive);
  std::filesystem::create_directory(broken);
  test::writeFile(broken / "manifest.json", "{");
  lead(test::smallTerrain());
  IgProcess ig = listen({"--watch", "--health", (dir_ / "health.csv").string()}, link);
  ASSERT_NE(ig.port(), 0) << ig.err();
  play(ig, test::weavingFlight(20), WireProtocol::cigi3, 20);
  lead(dir_ / "other");
  ASSERT_TRUE(ig.says("terrain: loaded again")) << ig.err();
  // What it was opened from is not needed any more, and the new one is read when it is drawn.
  play(ig, test::weavingFlight(20), WireProtocol::cigi3, 40);
  lead(broken);
  ASSERT_TRUE(ig.says("the last terrain stays")) << ig.err();
  play(ig, test::weavingFlight(20), WireProtocol::cigi3, 60);
  const auto opened = [&](const std::string& folder) {
    for (const auto& entry :
         std::filesystem::directory_iterator("/proc/" + std::to_string(ig.pid()) + "/fd")) {
      std::error_code gone;
      if (std::filesystem::read_symlink(entry.path(), gone).string().find(folder) != std::string::npos)
        return true;
    }
    return false;
  };
  EXPECT_TRUE(opened((dir_ / "other").string()));
  EXPECT_FALSE(opened(test::smallTerrain().string())) << "the terrain before is closed";
  ig.signal(SIGINT);
  ASSERT_EQ(ig.end(), 0) << ig.err();
  EXPECT_EQ(ig.summary()["terrain_reloads"], 1);
  EXPECT_EQ(ig.summary()["terrains_refused"], 1);
  std::istringstream health(test::readFile(dir_ / "health.csv"));
  std::string head, row;
  ASSERT_TRUE(std::getline(health, head) && std::getline(health, row)) << "the first row is there at once";
  const std::vector<std::string> names = test::csvCells(head), cells = test::csvCells(row);
  ASSERT_EQ(names.size(), cells.size()) << head << '\n' << row;
  for (const char* column : {"memory_kb", "handles", "threads", "gl_objects", "gl_programs", "gl_textures"}) {
    const auto at = std::find(names.begin(), names.end(), column) - names.begin();
    ASSERT_LT(at, std::ssize(names)) << column;
    EXPECT_GT(std::stod(cells[static_cast<std::size_t>(at)]), 0) << column << '\n' << row;
  }
}

TEST_F(IgLink, watchReadsAChangedPresetWhileItDraws) {
  IgProcess ig = listen({"--watch", "--frames", "1"});
  ASSERT_NE(ig.port(), 0) << ig.err();
  ASSERT_EQ(::mkfifo((dir_ / "pipe").c_str(), 0600), 0);
  std::filesystem::rename(dir_ / "pipe", dir_ / "preset.json");
  // Open as soon as the program reads, which goes on for as long as there are bytes, at most five seconds.
  int held = -1;
  ASSERT_TRUE(ig.until([&] {
    return (held = ::open((dir_ / "preset.json").c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC)) >= 0;
  }));
  ::signal(SIGPIPE, SIG_IGN);
  std::atomic<bool> ended{false};
  std::thread writer([&] {
    while (!ended && ::write(held, " ", 1) == 1) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  });
  link::PlayOptions how;
  how.to.port = ig.port();
  how.loop = true;
  const auto player = link::FeedPlayer::start(test::weavingFlight(60), how);
  ASSERT_TRUE(player);
  EXPECT_EQ(ig.end(), 0) << ig.err();
  ended = true;
  writer.join();
  ::close(held);
  EXPECT_EQ(ig.summary()["frames"], 1);
  EXPECT_EQ(ig.summary()["presets_refused"], 0) << "the image was drawn before the file was read";
}

TEST_F(IgLink, watchSeesAnExportThatChangesWhileTheProgramMakesItselfReady) {
  IgProcess ig = listen({"--watch"});
  // Opened between the preset and the first frame.
  ASSERT_TRUE(ig.until([&] { return std::filesystem::exists(dir_ / "trace.csv.part"); })) << ig.err();
  writePreset(test::edited([](TuningParameters& p) { p.altitude.curve.point[1].y = 0.35; }));
  EXPECT_TRUE(ig.says("loaded again")) << ig.err();
}

TEST_F(IgLink, sleepsWhenNobodySends) {
  IgProcess ig = listen({"--watch"});
  ASSERT_NE(ig.port(), 0) << ig.err();
  play(ig, test::weavingFlight(10), WireProtocol::cigi3, 10);
  const double share = ig.share(2, 0.01);
  std::cout << "idle: " << share * 100 << " % of a core" << std::endl;
  EXPECT_LT(share, 0.01);
  ig.signal(SIGINT);
  EXPECT_EQ(ig.end(), 0);
}

TEST_F(IgLink, bytesThatAreNoPacketsChangeNothingButACounter) {
  IgProcess ig = listen();
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(ig.port());
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  for (const std::string& bytes :
       {std::string("hello"), std::string(408, '\xff'), std::string(1400, '\0'), std::string()})
    ::sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  ::close(socket);
  play(ig, test::weavingFlight(20), WireProtocol::cigi3, 20);
  ig.signal(SIGINT);
  ASSERT_EQ(ig.end(), 0) << ig.err();
  EXPECT_EQ(rows().size(), 20u);
  EXPECT_EQ(ig.summary()["host"]["bad"], 0) << "the host sent none of them";
  const nlohmann::json stray = ig.summary()["host"]["other_senders"][0];
  EXPECT_GE(stray["bad"], 3) << ig.out();
  EXPECT_TRUE(stray["first_bad"]["hex"].get<std::string>().starts_with("68")) << ig.out();
}

TEST_F(IgLink, sendsStartsOfFrameToASynchronousHost) {
  const int host = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(::bind(host, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  socklen_t size = sizeof address;
  ::getsockname(host, reinterpret_cast<sockaddr*>(&address), &size);
  const timeval patience{20, 0};
  ::setsockopt(host, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  IgProcess ig =
      listen({"--protocol", "cigi3", "--reply", "127.0.0.1:" + std::to_string(ntohs(address.sin_port))});
  for (int i = 0; i < 5; ++i) {
    unsigned char bytes[64];
    ASSERT_EQ(::recv(host, bytes, sizeof bytes, 0), 24) << ig.err();
    EXPECT_EQ(bytes[0], 101) << "Start of Frame";
    EXPECT_EQ(bytes[1], 24);
    EXPECT_EQ(bytes[2], 3) << "CIGI 3";
  }
  ::close(host);
  ig.signal(SIGINT);
  EXPECT_EQ(ig.end(), 0) << ig.err();
}

}  // namespace
}  // namespace trimtab
