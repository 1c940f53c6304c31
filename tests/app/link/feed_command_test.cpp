#include <chrono>
#include <functional>
#include <thread>

#include "tests/child.h"
#include "trimtab/host/decoder.h"
#include "trimtab/host/encoder.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/head_log.h"
#include "udp_socket.h"

namespace trimtab::test {
namespace {

std::string cli() {
  return "'" + program("trimtab-cli").string() + "'";
}

std::string freePort() {
  return std::to_string(UdpSocket().port());
}

void waitFor(const std::filesystem::path& file, const std::string& text) {
  for (int i = 0; i < 1000 && readFile(file).find(text) == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

std::string aFlight(const ScratchDir& dir) {
  std::string text = "time_s,latitude_deg,longitude_deg,altitude_ft,pitch_deg,roll_deg,heading_deg\n";
  for (int i = 0; i < 20; ++i)
    text += std::to_string(i * 0.1) + ",36.6," + std::to_string(128.3 + i * 1e-4) + ",5000,2,0,90\n";
  writeFile(dir / "flight.csv", text);
  return (dir / "flight.csv").string();
}

TEST(FeedCommand, recordsWhatItPlaysAndTheRecordingPlaysAgain) {
  for (const char* name : {"first.pcap", "first.csv"}) {
    SCOPED_TRACE(name);
    ScratchDir dir;
    const std::string port = freePort(), first = (dir / name).string();
    Background recorder({program("trimtab-cli").string(), "feed", "record", "--listen", port, "-o", first},
                        dir / "err");
    waitFor(dir / "err", "listening");
    const Ran played = run(cli() + " feed play " + aFlight(dir) + " --to 127.0.0.1:" + port +
                           " --protocol cigi3 --rate-hz 50");
    EXPECT_EQ(played.exitCode, 0) << played.err;
    std::this_thread::sleep_for(std::chrono::milliseconds(500));  // the last packets, under load
    EXPECT_EQ(recorder.end(SIGINT), 0) << readFile(dir / "err");
    const auto flight = readFlight(first);
    ASSERT_TRUE(flight) << toString(flight.findings());
    EXPECT_EQ(flight->states.size(), 96U);  // 1.9 s at 50 Hz, both ends
    EXPECT_NEAR(flight->durationS(), 1.9, 1e-3);
    EXPECT_NEAR(flight->states.back().position.longitude.value(), 128.3019, 1e-9);
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(dir.path())) ++files;
    EXPECT_EQ(files, 3U) << "the recording, the flight and the messages: nothing half-made is left";

    Background again({program("trimtab-cli").string(), "feed", "record", "--listen", port, "-o",
                      (dir / "again.csv").string(), "--packets", "50"},
                     dir / "err2");
    waitFor(dir / "err2", "listening");
    EXPECT_EQ(run(cli() + " feed play " + first + " --to " + port + " --protocol native-fdm").exitCode, 0);
    EXPECT_EQ(again.end(), 0) << readFile(dir / "err2");
    const auto second = readFlight(dir / "again.csv");
    ASSERT_TRUE(second) << toString(second.findings());
    EXPECT_GE(second->states.size(), 50U);
  }
}

TEST(FeedCommand, losesNoRecordingHoweverItIsStopped) {
  const std::pair<const char*, int> cases[] = {
      {"out.csv", SIGTERM}, {"out.csv", SIGHUP}, {"out.csv", SIGKILL}, {"out.pcap", SIGKILL}};
  for (const auto& [name, signal] : cases) {
    SCOPED_TRACE(name + std::string(" ") + std::to_string(signal));
    ScratchDir dir;
    const std::string out = (dir / name).string(), port = freePort();
    Background recorder({program("trimtab-cli").string(), "feed", "record", "--listen", port, "-o", out},
                        dir / "err");
    waitFor(dir / "err", "listening");
    const Ran played = run(cli() + " feed play " + aFlight(dir) + " --to " + port +
                           " --protocol cigi3 --rate-hz 0 --speed 5");
    EXPECT_EQ(played.exitCode, 0) << played.err;
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the last packets, under load
    const bool killed = signal == SIGKILL;
    EXPECT_EQ(recorder.end(signal), killed ? 128 + SIGKILL : 0) << readFile(dir / "err");
    EXPECT_EQ(std::filesystem::exists(out), !killed);
    EXPECT_EQ(std::filesystem::exists(out + ".part"), killed);
    const auto flight = readFlight(killed ? out + ".part" : out);
    ASSERT_TRUE(flight) << toString(flight.findings());
    EXPECT_EQ(flight->states.size(), 20U);
    if (!killed) continue;
    const Ran again = run(cli() + " feed record --listen " + freePort() + " --seconds 0.1 -o " + out);
    EXPECT_EQ(again.exitCode, 1);
    EXPECT_NE(again.err.find("plays as it is"), std::string::npos) << again.err;
    EXPECT_TRUE(readFlight(out + ".part")) << "still there";
  }
}

TEST(FeedCommand, keepsWhatItRecordedBeforeTheDiskWasFull) {
  ScratchDir dir;
  const std::string port = freePort(), out = (dir / "out.csv").string();
  // A limit on the size of files does what a full disk does.
  Background recorder(
      {"/bin/bash", "-c", "ulimit -f 8; exec " + cli() + " feed record --listen " + port + " -o " + out},
      dir / "err");
  waitFor(dir / "err", "listening");
  run(cli() + " feed play " + aFlight(dir) + " --to " + port + " --protocol cigi3 --rate-hz 100");
  EXPECT_EQ(recorder.end(), 1) << "it ends by itself";
  EXPECT_NE(readFile(dir / "err").find("datagrams are kept there"), std::string::npos)
      << readFile(dir / "err");
  const auto flight = readFlight(out + ".part");
  ASSERT_TRUE(flight) << toString(flight.findings());
  EXPECT_GT(flight->states.size(), 20U);
  EXPECT_LT(flight->states.size(), 191U);
}

TEST(FeedCommand, leavesAForeignFileBesideItsTargetAsItIs) {
  ScratchDir dir;
  for (const char* notes : {"", "notes"}) {
    writeFile(dir / "out.csv.part", notes);
    const Ran ran = run(cli() + " feed record --listen " + freePort() + " --seconds 0.1 -o " +
                        (dir / "out.csv").string());
    EXPECT_EQ(ran.exitCode, 1);
    EXPECT_NE(ran.err.find("out.csv.part: "), std::string::npos) << ran.err;
    EXPECT_NE(ran.err.find("write to another file"), std::string::npos) << ran.err;
    EXPECT_EQ(readFile(dir / "out.csv.part"), notes);
  }
  const Ran nothing = run(cli() + " feed record --listen " + freePort() + " --seconds 0.1 -o " +
                          (dir / "other.csv").string());
  EXPECT_EQ(nothing.exitCode, 1) << "it heard nothing";
  EXPECT_EQ(trimtab::test::namesIn(dir.path()), std::vector<std::string>{"out.csv.part"});
}

TEST(FeedCommand, refusesATargetBeforeItListens) {
  ScratchDir dir;
  std::filesystem::create_directory(dir / "folder");
  writeFile(dir / "file", "");
  for (const std::string& target : {(dir / "folder").string(), (dir / "file/out.pcap").string(),
                                    std::string("/dev/full"), std::string("/proc/out.pcap")}) {
    const Ran ran = run(cli() + " feed record --listen " + freePort() + " --seconds 0.1 -o " + target);
    EXPECT_EQ(ran.exitCode, 1) << target;
    EXPECT_EQ(ran.err.find("listening"), std::string::npos) << target << '\n' << ran.err;
    EXPECT_NE(ran.err.find(target), std::string::npos) << ran.err;
  }
}

TEST(FeedCommand, hearsOnlyTheInterfaceAndTheSenderThatItWasGiven) {
  for (const bool allowed : {true, false}) {
    ScratchDir dir;
    const std::string port = freePort();
    Background recorder(
        {program("trimtab-cli").string(), "feed", "record", "--listen", port, "--bind", "127.0.0.2", "--from",
         allowed ? "127.0.0.1" : "127.0.0.3", "-o", (dir / "out.csv").string()},
        dir / "err");
    waitFor(dir / "err", "listening");
    const auto playTo = [&](const std::string& address) {
      return run(cli() + " feed play " + aFlight(dir) + " --to " + address + ":" + port +
                 " --protocol native-fdm --speed 8")
          .exitCode;
    };
    EXPECT_EQ(playTo("127.0.0.1"), 0);
    EXPECT_EQ(playTo("127.0.0.2"), 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_EQ(recorder.end(SIGTERM), allowed ? 0 : 1);
    EXPECT_EQ(std::filesystem::exists(dir / "out.csv"), allowed);
    if (!allowed) continue;
    const Result<Flight> heard = readFlight((dir / "out.csv").string()), sent = readFlight(aFlight(dir));
    ASSERT_TRUE(heard && sent);
    EXPECT_GT(heard->states.size(), 0u);
    EXPECT_LE(heard->states.size(), sent->states.size()) << "the other interface is deaf";
  }
}

TEST(FeedCommand, sendsAHeadAsViewControl) {
  ScratchDir dir;
  const std::string port = freePort();
  Background recorder(
      {program("trimtab-cli").string(), "feed", "record", "--listen", port, "-o", (dir / "out.csv").string()},
      dir / "err");
  waitFor(dir / "err", "listening");
  const std::string play = cli() + " feed play " + aFlight(dir) + " --to 127.0.0.1:" + port;
  EXPECT_EQ(run(play + " --protocol cigi3 --rate-hz 50 --head sweep:180/1s/0.5s").exitCode, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // the last packets, under load
  EXPECT_EQ(recorder.end(SIGINT), 0) << readFile(dir / "err");
  const auto flight = readFlight(dir / "out.csv");
  ASSERT_TRUE(flight) << toString(flight.findings());
  const trimtab::HeadLog sweep = trimtab::parseSweep("sweep:180/1s/0.5s").value();
  for (std::size_t i = 0; i < flight->states.size(); ++i) {
    ASSERT_TRUE(flight->states[i].head);
    EXPECT_NEAR(flight->states[i].head->heading.value(),
                trimtab::headAt(sweep, double(i) * 0.02).heading.value(), 0.01);
  }

  const Ran fdm = run(play + " --protocol native-fdm --head sweep:180/1s");
  EXPECT_EQ(fdm.exitCode, 1);
  EXPECT_NE(fdm.err.find("View Control"), std::string::npos) << fdm.err;
  EXPECT_EQ(run(play + " --protocol cigi3 --head absent.csv").exitCode, 1);

  writeFile(dir / "head.csv", "t,Links,Hoch\n0,1,2\n0.02,2,2\n0.04,3,2\n");
  const std::string head = play + " --protocol cigi3 --seconds 0.1 --head " + (dir / "head.csv").string();
  EXPECT_NE(run(head).err.find("--head-columns: expected a map of columns"), std::string::npos)
      << run(head).err;
  const Ran mapped = run(head + " --head-columns head_heading_deg=Links*-1,head_pitch_deg=Hoch");
  EXPECT_EQ(mapped.exitCode, 0) << mapped.err;
}

TEST(FeedCommand, sendsSymbolsWithEachPacket) {
  ScratchDir dir;
  const std::string port = freePort();
  Background recorder({program("trimtab-cli").string(), "feed", "record", "--listen", port, "-o",
                       (dir / "out.pcap").string()},
                      dir / "err");
  waitFor(dir / "err", "listening");
  const std::string play = cli() + " feed play '" + aFlight(dir) + "' --to " + port;
  EXPECT_EQ(run(play + " --protocol cigi3 --rate-hz 50 --symbols").exitCode, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // the last packets, under load
  EXPECT_EQ(recorder.end(SIGINT), 0) << readFile(dir / "err");
  EXPECT_NE(readFile(dir / "err").find("symbol-packets"), std::string::npos) << readFile(dir / "err");
  const auto datagrams = readPcap(dir / "out.pcap");
  ASSERT_TRUE(datagrams) << toString(datagrams.findings());
  HostDecoder decoder;
  for (const CapturedDatagram& d : *datagrams) {
    const auto state = decoder.accept({d.bytes, d.time, d.from});
    ASSERT_TRUE(state && decoder.symbols());
    EXPECT_EQ(*decoder.symbols(), exampleSymbols(state->time));
  }
  EXPECT_EQ(decoder.statistics().refusedPackets, 0U) << decoder.statistics().firstRefusedReason;

  const Ran fdm = run(play + " --protocol native-fdm --symbols");
  EXPECT_EQ(fdm.exitCode, 1);
  EXPECT_NE(fdm.err.find("whose packets define symbols"), std::string::npos) << fdm.err;
}

TEST(FeedCommand, showsALineASecond) {
  ScratchDir dir;
  const std::string port = freePort();
  Background player({program("trimtab-cli").string(), "feed", "play", aFlight(dir), "--to", port,
                     "--protocol", "cigi3", "--loop"},
                    dir / "err");
  const Ran ran = run(cli() + " feed show --listen " + port + " --seconds 2.1");
  EXPECT_EQ(player.end(SIGINT), 0);
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  EXPECT_GE(std::count(ran.out.begin(), ran.out.end(), '\n'), 2);
  for (const char* part :
       {"cigi3", " Hz", "jitter", "lost 0", "bad 0", "age", "latency", "at 36.600000 128.30", "5000.0 ft"})
    EXPECT_NE(ran.out.find(part), std::string::npos) << part << " in\n" << ran.out;
}

TEST(FeedCommand, showsTheFirstBadPacketInHex) {
  const std::string port = freePort();
  ScratchDir dir;
  Background shower({program("trimtab-cli").string(), "feed", "show", "--listen", port, "--packets", "1"},
                    dir / "err");
  waitFor(dir / "err", "listening");
  UdpSocket host;
  host.send(static_cast<std::uint16_t>(std::stoi(port)),
            std::vector<std::byte>{std::byte{0xde}, std::byte{0xad}});
  EXPECT_EQ(shower.end(), 0);
  EXPECT_NE(readFile(dir / "err").find("de ad"), std::string::npos) << readFile(dir / "err");
}

TEST(FeedCommand, saysWhileItListensWhyNothingCanBeUsed) {
  ScratchDir dir;
  const std::string out = (dir / "out.pcap").string();
  const std::vector<std::vector<std::string>> commands{{"show"}, {"record", "-o", out}};
  for (const auto& command : commands) {
    SCOPED_TRACE(command[0]);
    const std::string port = freePort();
    const std::filesystem::path said = dir / command[0];
    std::vector<std::string> arguments{program("trimtab-cli").string(), "feed"};
    arguments.insert(arguments.end(), command.begin(), command.end());
    arguments.insert(arguments.end(), {"--listen", port});
    Background listener(arguments, said);
    waitFor(said, "listening");
    UdpSocket host;
    for (int i = 0; i < 30; ++i)
      host.send(static_cast<std::uint16_t>(std::stoi(port)), encodeCigiStartOfFrame(1, 0, 0));
    waitFor(said, "for someone else");
    const std::string err = readFile(said);
    EXPECT_NE(err.find("warning: UDP port " + port + ": "), std::string::npos) << err;
    EXPECT_NE(err.find("the newest from 127.0.0.1:" + std::to_string(host.port()) +
                       ": byte 0: CIGI packet id: expected 1 (IG Control: a host), found 101"),
              std::string::npos)
        << err;
    listener.end(SIGINT);
  }
}

TEST(FeedCommand, saysThatNothingArrives) {
  ScratchDir dir;
  const std::string showing = freePort(), recording = freePort();
  const std::string begin = "nothing has arrived on UDP port ";
  Background show({program("trimtab-cli").string(), "feed", "show", "--listen", showing}, dir / "show");
  Background record({program("trimtab-cli").string(), "feed", "record", "--listen", recording, "-o",
                     (dir / "none.pcap").string()},
                    dir / "record");
  for (const auto& [file, port] : {std::pair{dir / "show", showing}, std::pair{dir / "record", recording}}) {
    for (int i = 0; i < 3; ++i) waitFor(file, begin);
    EXPECT_NE(readFile(file).find(begin + port + " for 10 s"), std::string::npos) << readFile(file);
  }
}

TEST(FeedCommand, refusesWithTheExitCodeOfItsKind) {
  ScratchDir dir;
  UdpSocket taken;
  const std::string port = std::to_string(taken.port());
  struct Case {
    std::string arguments;
    int exitCode;
    std::string says;
  };
  const Case cases[] = {
      {"play nothing.csv --to 8004 --protocol cigi3", 1, "nothing.csv"},
      {"play " + (sourceDir() / "tests/data/host/bad-flights/heading-text.csv").string() +
           " --to 8004 --protocol cigi3",
       1, "heading-text.csv:3: heading_deg"},
      {"play " + aFlight(dir) + " --to 70000 --protocol cigi3", 2, "1..65535"},
      {"play " + aFlight(dir) + " --to 8004 --protocol dis", 2, "dis"},
      {"play " + aFlight(dir) + " --to 8004", 2, "protocol"},
      {"play " + aFlight(dir) + " --to 8004 --protocol cigi3 --start-s 60", 1, "at most 1.9 s"},
      {"show --listen " + port, 1, "port " + port + " is taken"},
      {"show", 2, "listen"},
      {"record --listen " + freePort() + " -o " + (dir / "no/where.csv").string(), 1, "a folder that exists"},
      {"record --listen " + freePort() + " --seconds 0.1 -o " + (dir / "out.csv").string(), 1,
       "nothing written"},
      {"", 2, "subcommand"},
  };
  for (const Case& c : cases) {
    const Ran ran = run(cli() + " feed " + c.arguments);
    EXPECT_EQ(ran.exitCode, c.exitCode) << c.arguments << '\n' << ran.err;
    EXPECT_NE((ran.err + ran.out).find(c.says), std::string::npos) << c.arguments << '\n' << ran.err;
  }
}

}  // namespace
}  // namespace trimtab::test
