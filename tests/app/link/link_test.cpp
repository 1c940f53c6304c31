#include "link_support.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iostream>
#include <random>
#include <thread>

#include "app/link/inbox.h"
#include "tests/support.h"
#include "trimtab/host/encoder.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/motion.h"
#include "udp_socket.h"

namespace trimtab::test {
namespace {

/// Ten minutes of a gentle turn, ten rows a second.
Flight aFlight() {
  Flight flight;
  for (int i = 0; i < 6000; ++i) {
    AircraftState s;
    s.time = 50 + i * 0.1;
    s.position = {Degrees{36.6 + 1e-4 * i}, Degrees{128.3}, Metres{1500.0 + i}};
    s.attitude = {wrapped360(Degrees{0.5 * i}), Degrees{3}, Degrees{-15}};
    flight.states.push_back(s);
  }
  return flight;
}

std::unique_ptr<link::FeedPlayer> playing(std::uint16_t port, link::PlayOptions options = {},
                                          Flight flight = aFlight()) {
  options.to.port = port;
  auto player = link::FeedPlayer::start(std::move(flight), options);
  EXPECT_TRUE(player) << toString(player.findings());
  return std::move(*player);
}

double percentile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1))];
}

struct Protocol {
  WireProtocol wire;
  const char* name;
};

TEST(Link, joinsAMulticastGroupOnTheInterfaceThatIsNamed) {
  link::ReceiverOptions options;
  options.bindAddress = "127.0.0.1";
  options.group = "239.255.42.99";
  const auto receiver = opened(options);
  options.port = receiver->port();
  const auto second = opened(options);
  sendOnLoopback(options.group, receiver->port());
  const auto one = [](const auto& states) { return !states.empty(); };
  EXPECT_EQ(gathered(*receiver, one).size(), 1u);
  EXPECT_EQ(gathered(*second, one).size(), 1u) << "each member of a group gets every datagram";
  sendOnLoopback("239.255.42.98", receiver->port(), 2);
  sendOnLoopback(options.group, receiver->port(), 3);
  EXPECT_EQ(gathered(*receiver, one).size(), 1u) << "of its own group only";
}

TEST(Link, listensOnTheInterfaceThatIsNamed) {
  link::ReceiverOptions options;
  options.bindAddress = "127.0.0.2";
  const auto receiver = opened(options);
  sendOnLoopback("127.0.0.1", receiver->port(), 1);
  sendOnLoopback("127.0.0.2", receiver->port(), 2);
  EXPECT_EQ(gathered(*receiver, [](const auto& states) { return !states.empty(); }).size(), 1u);
}

TEST(Link, refusesAGroupThatIsNone) {
  for (const char* group : {"10.0.0.1", "240.0.0.1", "all", "239.1.2"}) {
    link::ReceiverOptions options;
    options.group = group;
    const auto refused = link::Receiver::open(options);
    ASSERT_FALSE(refused) << group;
    EXPECT_THAT(
        toString(refused.findings()),
        ::testing::HasSubstr(
            std::string("a multicast group, 224.0.0.0 to 239.255.255.255 or ff00::/8, found ") + group));
  }
}

TEST(Link, carriesAFlightAt60HzWithoutLoss) {
  for (const Protocol& protocol :
       {Protocol{WireProtocol::cigi3, "cigi3"}, Protocol{WireProtocol::cigi4, "cigi4"},
        Protocol{WireProtocol::native_fdm, "native-fdm"}}) {
    SCOPED_TRACE(protocol.name);
    std::atomic<int> woken{0};
    link::ReceiverOptions options;
    options.wake = [&woken] { ++woken; };
    const auto receiver = opened(options);
    const auto player = playing(receiver->port(), {.to = {}, .protocol = protocol.wire});
    const auto all = gathered(*receiver, count(240));
    const HostStatistics s = receiver->statistics();
    ASSERT_GE(all.size(), 240U);
    EXPECT_EQ(s.protocol, protocol.wire);
    EXPECT_EQ(s.bad, 0U);
    EXPECT_EQ(s.lost.value_or(0), 0U);
    EXPECT_EQ(s.lost.has_value(), protocol.wire != WireProtocol::native_fdm);
    EXPECT_GE(woken.load(), 240);
    EXPECT_EQ(receiver->dropped(), 0U);
    std::vector<double> latency;
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i].state.packet, all[0].state.packet + i);
      EXPECT_GT(all[i].kernelTime, 0);
      EXPECT_LE(all[i].kernelTime, all[i].decodedTime);
      if (i > 0) {
        EXPECT_LE(all[i - 1].kernelTime, all[i].kernelTime);
      }
      latency.push_back((all[i].decodedTime - all[i].kernelTime) * 1e3);
    }
    // 60 Hz by the player's own clock; the machine's load moves packets, not their average.
    const double span = all.back().kernelTime - all.front().kernelTime;
    EXPECT_NEAR(static_cast<double>(all.size() - 1) / span, 60, 6);
    std::cout << protocol.name << ": kernel to decoded p50 " << percentile(latency, 0.5) << " ms, p99 "
              << percentile(latency, 0.99) << " ms; rate " << s.rateHz << " Hz, jitter " << s.jitterMs
              << " ms\n";
  }
}

TEST(Link, showsTheStatesOfTheFlightBetweenItsRows) {
  const Flight flight = aFlight();
  const auto receiver = opened();
  const auto player =
      playing(receiver->port(), {.to = {}, .protocol = WireProtocol::cigi3, .rateHz = 60, .startS = 20});
  const auto all = gathered(*receiver, count(30));
  ASSERT_GE(all.size(), 30U);
  for (std::size_t i = 0; i < 30; ++i) {
    const AircraftState truth = stateAt(flight, 70 + static_cast<double>(i) / 60);
    EXPECT_LT(distanceM(all[i].state.position, truth.position), 1e-6);
    EXPECT_NEAR(wrapped180(all[i].state.attitude.heading - truth.attitude.heading).value(), 0, 1e-4);
  }
}

TEST(Link, sendsRowsAsTheyAreAtRateZero) {
  Flight flight = aFlight();
  flight.states.resize(12);
  const auto receiver = opened();
  const auto player =
      playing(receiver->port(), {.to = {}, .protocol = WireProtocol::cigi3, .rateHz = 0, .speed = 4}, flight);
  const auto all = gathered(*receiver, count(12));
  ASSERT_EQ(all.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(all[i].state.position, flight.states[i].position);
  const double span = all.back().state.time - all.front().state.time;
  EXPECT_NEAR(span, 1.1 / 4, 1e-3);
  gathered(*receiver, [&](const auto&) { return player->finished(); });
  EXPECT_TRUE(player->finished());
  player->seek(0.55);
  const auto again = gathered(*receiver, count(6));
  ASSERT_EQ(again.size(), 6U) << "rows from 0.6 s on";
  EXPECT_EQ(again[0].state.position, flight.states[6].position);
}

TEST(Link, pausesSeeksLoopsAndEnds) {
  Flight flight = aFlight();
  flight.states.resize(21);  // two seconds
  const auto receiver = opened();
  const auto player =
      playing(receiver->port(),
              {.to = {}, .protocol = WireProtocol::cigi3, .rateHz = 100, .speed = 10, .loop = true}, flight);
  gathered(*receiver, count(60));
  EXPECT_FALSE(player->finished());
  player->pause(true);
  player->seek(1);
  gathered(*receiver, count(3));
  const auto frozen = gathered(*receiver, count(5));
  ASSERT_GE(frozen.size(), 5U) << "a frozen host goes on sending";
  for (const auto& r : frozen) EXPECT_EQ(r.state.position, flight.states[10].position);
  EXPECT_EQ(player->position(), 1);
  player->setLoop(false);
  player->pause(false);
  gathered(*receiver, [&](const auto&) { return player->finished(); });
  EXPECT_TRUE(player->finished());
  EXPECT_EQ(player->position(), 2);
  const std::uint64_t sent = player->sent();
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(player->sent(), sent);
  std::vector<ReceivedState> some;
  receiver->take(some);
  player->setSpeed(1);
  player->seek(0);
  const auto after = gathered(*receiver, count(5));
  ASSERT_GE(after.size(), 5U);
  EXPECT_EQ(after[0].state.position, flight.states[0].position);
  EXPECT_EQ(receiver->statistics().lost, 0U);
}

TEST(Link, namesThePortThatIsTaken) {
  const auto receiver = opened();
  const auto second = link::Receiver::open({.port = receiver->port(), .reply = {}, .wake = {}});
  ASSERT_FALSE(second);
  const std::string text = toString(second.findings());
  EXPECT_THAT(text, testing::HasSubstr("port " + std::to_string(receiver->port()) + " is taken"));
}

TEST(Link, freesThePortAtItsEnd) {
  std::uint16_t port = 0;
  { port = opened()->port(); }
  EXPECT_TRUE(link::Receiver::open({.port = port, .reply = {}, .wake = {}}));
}

TEST(Link, sendsStartOfFrameAt60HzWithTheHostsFrameNumber) {
  UdpSocket host;
  link::ReceiverOptions options;
  options.reply = link::Endpoint{"127.0.0.1", host.port()};
  const auto receiver = opened(options);
  AircraftState s;
  std::uint32_t echoed = 0, previous = 0;
  std::vector<double> times;
  for (std::uint32_t i = 0; i < 60; ++i) {  // as synchronous hosts do: a message for every Start of Frame
    const auto bytes = host.receive(2000);
    ASSERT_EQ(bytes.size(), 24U);
    times.push_back(link::now());
    EXPECT_EQ(std::to_integer<int>(bytes[0]), 101);
    const bool big = wire::get<std::uint16_t>(bytes, 6, ByteOrder::big) == 0x8000;
    const auto frame = wire::get<std::uint32_t>(bytes, 8, big ? ByteOrder::big : ByteOrder::little);
    if (i > 0) {
      EXPECT_EQ(frame, previous + 1);
    }
    previous = frame;
    if (i > 20) echoed = wire::get<std::uint32_t>(bytes, 16, ByteOrder::little);
    s.time = i * 0.0167;
    host.send(receiver->port(), encodeCigiHost(s, 5000 + i, frame, ByteOrder::little));
  }
  EXPECT_NEAR(echoed, 5058, 2) << "the last frame number received, in the host's byte order";
  // A busy machine may slow it; nothing may hurry it.
  const double rateHz = 59 / (times.back() - times.front());
  EXPECT_GT(rateHz, 30);
  EXPECT_LT(rateHz, 66);
  EXPECT_EQ(gathered(*receiver, count(60)).size(), 60U);
}

TEST(Link, takesRandomBytesForAMinuteWithNothingMovedButACounter) {
  const bool isLong = std::getenv("TRIMTAB_LONG") != nullptr;
  const auto receiver = opened();
  UdpSocket host;
  AircraftState s;
  host.send(receiver->port(), encodeCigiHost(s, 1, 0));
  const auto first = gathered(*receiver, count(1));
  ASSERT_EQ(first.size(), 1U);
  std::mt19937_64 random(3);
  std::uint64_t sent = 0;
  const auto end = std::chrono::steady_clock::now() + (isLong ? 60s : 1s);
  while (std::chrono::steady_clock::now() < end) {
    std::vector<std::byte> bytes(random() % 1400);
    for (std::byte& b : bytes) b = static_cast<std::byte>(random());
    host.send(receiver->port(), bytes);
    ++sent;
    if (sent % 16 == 0) std::this_thread::sleep_for(1ms);
  }
  gathered(*receiver, [&](const auto&) { return receiver->statistics().received > sent; });
  const HostStatistics st = receiver->statistics();
  EXPECT_EQ(st.bad, sent);
  EXPECT_EQ(st.received, sent + 1);
  EXPECT_EQ(st.states, 1U);
  EXPECT_EQ(st.lost, 0U);
  EXPECT_FALSE(st.firstBadHex.empty());
  host.send(receiver->port(), encodeCigiHost(s, 2, 0));
  EXPECT_EQ(gathered(*receiver, count(1)).size(), 1U);
}

TEST(Link, keepsTheNewestWhenNobodyTakesThem) {
  const auto receiver = opened();
  UdpSocket host;
  AircraftState s;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    host.send(receiver->port(), encodeCigiHost(s, i, 0));
    while (receiver->statistics().received < i) std::this_thread::sleep_for(100us);
  }
  while (receiver->statistics().received < 5000) std::this_thread::sleep_for(1ms);
  std::vector<ReceivedState> states;
  receiver->take(states);
  ASSERT_EQ(states.size(), 4096U);
  EXPECT_EQ(receiver->dropped(), 5000U - 4096U);
  for (std::size_t i = 0; i < states.size(); ++i) EXPECT_EQ(states[i].state.packet, 5000 - 4096 + i);
}

TEST(Link, costsNothingWhileNoHostSends) {
  const auto receiver = opened();
  const auto used = [] {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec) * 1e-6 +
           static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec);
  };
  constexpr double kIdle = 0.01;
  double least = 1;
  for (int i = 0; i < 3 && least >= kIdle; ++i) {
    const double before = used();
    std::this_thread::sleep_for(1s);
    least = std::min(least, used() - before);
  }
  EXPECT_LT(least, kIdle);
}

TEST(Link, tapsEveryDatagramBadOnesToo) {
  const auto receiver = opened();
  std::mutex mutex;
  std::vector<std::size_t> sizes;
  receiver->tap([&](const Datagram& d) {
    const std::lock_guard lock(mutex);
    sizes.push_back(d.bytes.size());
  });
  UdpSocket host;
  host.send(receiver->port(), std::vector<std::byte>(7));
  host.send(receiver->port(), encodeNativeFdm({}));
  ASSERT_EQ(gathered(*receiver, count(1)).size(), 1U);
  receiver->tap(nullptr);
  EXPECT_THAT(sizes, testing::ElementsAre(7, 408));
}

TEST(Inbox, keepsWhatFitsAndCountsTheRest) {
  link::Inbox inbox(1000);
  const auto datagram = [](std::size_t bytes, double arrival) {
    return CapturedDatagram{arrival, "127.0.0.1:1", "127.0.0.1:2", std::vector<std::byte>(bytes)};
  };
  for (const std::size_t bytes : {600, 401, 400, 1}) inbox.put(datagram(bytes, static_cast<double>(bytes)));
  EXPECT_EQ(inbox.dropped(), 2u);
  const std::vector<CapturedDatagram> first = inbox.take();
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0].bytes.size(), 600u);
  EXPECT_EQ(first[1].bytes.size(), 400u);
  inbox.put(datagram(1000, 0));
  EXPECT_EQ(inbox.take().size(), 1u) << "what was taken makes room";
  EXPECT_EQ(inbox.dropped(), 2u);
}

TEST(Endpoint, isAddressAndPort) {
  EXPECT_EQ(link::parseEndpoint("8004")->port, 8004);
  EXPECT_EQ(link::parseEndpoint("8004")->address, "127.0.0.1");
  EXPECT_EQ(link::parseEndpoint("10.0.0.7:65535")->address, "10.0.0.7");
  EXPECT_EQ(link::parseEndpoint("localhost:1")->address, "localhost");
  for (const char* bad :
       {"", ":", "host:", ":80", "0", "host:0", "host:65536", "host:80x", "host:-1", "::1:80", "host: 80"})
    EXPECT_FALSE(link::parseEndpoint(bad)) << bad;
}

TEST(Link, refusesAReplyRateThatItCannotKeep) {
  for (const double rateHz : {0.0, -60.0, 1e-12, 1e6, std::nan("")}) {
    link::ReceiverOptions options;
    options.replyRateHz = rateHz;
    EXPECT_FALSE(link::Receiver::open(options)) << rateHz;
  }
}

TEST(FeedPlayer, isHeardFromTheFirstPacketOnThatSomeoneListensTo) {
  Flight flight = aFlight();
  flight.states.resize(3);
  flight.states[1].time = flight.states[0].time + 1;
  flight.states[2].time = flight.states[0].time + 1.2;
  const std::uint16_t port = opened()->port();
  const auto player = playing(port, {.to = {}, .rateHz = 0}, flight);
  for (int i = 0; i < 500 && player->sent() < 1; ++i) std::this_thread::sleep_for(1ms);
  const auto receiver = opened({.port = port, .reply = {}, .wake = {}});
  const auto all = gathered(*receiver, count(2));
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].state.position, flight.states[1].position);
}

TEST(FeedPlayer, waitsForARowThatIsCenturiesAway) {
  Flight flight = aFlight();
  flight.states.resize(2);
  flight.states[1].time = 1e12;
  const auto receiver = opened();
  const auto player = playing(receiver->port(), {.to = {}, .rateHz = 0, .loop = true}, flight);
  ASSERT_EQ(gathered(*receiver, count(1)).size(), 1U);
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(player->sent(), 1U);
}

TEST(FeedPlayer, refusesWhatCannotBePlayed) {
  const auto refused = [](const link::PlayOptions& options, Flight flight) {
    return !link::FeedPlayer::start(std::move(flight), options);
  };
  link::PlayOptions options;
  options.to.port = 8004;
  EXPECT_TRUE(refused(options, Flight{}));
  options.rateHz = std::nan("");
  EXPECT_TRUE(refused(options, aFlight()));
  // The next packet would be due when the clock has long wrapped.
  options.rateHz = 1e-12;
  EXPECT_TRUE(refused(options, aFlight()));
  options.rateHz = 60;
  for (const double speed : {0.0, -1.0, 1e-12, 1001.0, std::nan("")}) {
    options.speed = speed;
    EXPECT_TRUE(refused(options, aFlight())) << speed;
  }
  options.speed = 1;
  options.to.address = "no such host";
  EXPECT_TRUE(refused(options, aFlight()));
}

}  // namespace
}  // namespace trimtab::test
