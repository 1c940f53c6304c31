#include "app/link/link_watch.h"

#include <gmock/gmock.h>

#include "link_support.h"
#include "udp_socket.h"

/// What a program that listens says while nothing can be drawn: real datagrams at a real receiver, and times
/// of a clock of our own.
namespace trimtab::test {
namespace {

using testing::HasSubstr;
using testing::Optional;

class LinkWatchTest : public testing::Test {
 protected:
  LinkWatchTest() : LinkWatchTest(link::ReceiverOptions{}) {}
  explicit LinkWatchTest(const link::ReceiverOptions& options)
      : receiver_(opened(options)), watch_(receiver_->port(), "127.0.0.1") {}

  std::optional<std::string> look(double now) { return watch_.look(*receiver_, now); }
  /// Sends so many copies and waits until they have come.
  void send(const UdpSocket& from, const std::vector<std::byte>& bytes, std::uint64_t times = 1) {
    for (std::uint64_t i = 0; i < times; ++i) {
      from.send(receiver_->port(), bytes);
      ++sent_;
      while (receiver_->senders().received + receiver_->senders().refused < sent_)
        std::this_thread::sleep_for(1ms);
    }
  }
  std::string port() const { return "UDP port " + std::to_string(receiver_->port()); }
  static std::string name(const UdpSocket& socket) { return "127.0.0.1:" + std::to_string(socket.port()); }

  std::unique_ptr<link::Receiver> receiver_;
  link::LinkWatch watch_;
  std::uint64_t sent_ = 0;
};

std::vector<std::byte> host(std::uint32_t frame) {
  AircraftState state;
  state.position = {Degrees{36.6}, Degrees{128.3}, Metres{1500}};
  state.time = frame * 0.02;
  return encodeCigiHost(state, frame, 0);
}
const std::vector<std::byte> kBad(30, std::byte{7});

TEST_F(LinkWatchTest, saysTheFirstRefusedDatagramAtOnceAndThenOneLineInTenSeconds) {
  UdpSocket stray;
  EXPECT_FALSE(look(100));
  send(stray, kBad);
  EXPECT_THAT(look(101),
              Optional(port() + ": 1 of 1 datagrams refused; the newest from " + name(stray) +
                       ": byte 0: datagram: expected CIGI 3 or 4, FlightGear native-fdm 24 (408 bytes), DIS or "
                       "X-Plane from a host, found 30 bytes of none of them"));
  send(stray, kBad, 249);
  for (double now = 101; now < 111; now += 0.5) EXPECT_FALSE(look(now)) << now;
  EXPECT_THAT(look(111), Optional(HasSubstr("250 of 250 datagrams refused")));
  for (double now = 111; now < 200; now += 5) EXPECT_FALSE(look(now)) << "nothing new came by " << now;
  send(stray, std::vector<std::byte>(408));
  EXPECT_THAT(look(200), Optional(HasSubstr("byte 0: native-fdm version: expected 24, found 0")))
      << "the newest";
}

TEST_F(LinkWatchTest, saysOnceWhereNothingArrives) {
  for (double now = 50; now < 60; now += 0.5) EXPECT_FALSE(look(now)) << now;
  EXPECT_THAT(look(60),
              Optional("nothing has arrived on " + port() +
                       " for 10 s; only this machine can send to 127.0.0.1, until --bind names another "
                       "interface"));
  for (double now = 60; now < 300; now += 5) EXPECT_FALSE(look(now)) << now;
  link::LinkWatch everywhere(5501, "0.0.0.0");
  EXPECT_FALSE(everywhere.look({}, {}, {}, 0));
  EXPECT_THAT(everywhere.look({}, {}, {}, 10),
              Optional(std::string("nothing has arrived on UDP port 5501 for 10 s")));
}

TEST_F(LinkWatchTest, saysWhatIsForSomeoneElse) {
  UdpSocket socket;
  auto entity = host(1);
  wire::put(entity, 26, ByteOrder::big, std::uint16_t{1});
  send(socket, entity);
  EXPECT_THAT(
      look(1),
      Optional(port() + ": 1 of 1 datagrams are for someone else; the newest from " + name(socket) +
               ": byte 26: entity: expected 0, the own aircraft, found no entity 0; seen: 1; --entity, "
               "or host.entity of the preset, says which one is the own aircraft"));
}

TEST_F(LinkWatchTest, saysWhatOfAHostIsNotUsedEachOnce) {
  UdpSocket socket;
  const auto message = [](std::uint32_t frame) {
    auto bytes = host(frame);
    const auto add = [&bytes](std::uint8_t id, std::uint8_t size) {
      bytes.resize(bytes.size() + size);
      bytes[bytes.size() - size] = static_cast<std::byte>(id);
      bytes[bytes.size() - size + 1] = static_cast<std::byte>(size);
    };
    add(8, 32);
    add(24, 32);
    add(21, 32);
    bytes[bytes.size() - 32 + 5] = std::byte{1};  // a near plane, of 0 m
    return bytes;
  };
  for (std::uint32_t frame = 1; frame <= 6; ++frame) send(socket, message(frame));
  const std::string of = " of " + name(socket);
  EXPECT_THAT(look(1),
              Optional(HasSubstr("6 packets left out, the rest of their messages is used; the newest "
                                 "from " +
                                 name(socket) + ": byte 144: near plane")));
  // What grows does not hide what was never said.
  for (std::uint32_t frame = 7; frame <= 30; ++frame) send(socket, message(frame));
  std::string said;
  for (int i = 1; i <= 2; ++i) said += look(1 + i * 10).value_or("nothing") + '\n';
  EXPECT_THAT(said, HasSubstr("packets" + of + " of types that are not read: Rate Control (8) 30"));
  EXPECT_THAT(said, HasSubstr("30 requests of heights or lines of sight stay without an answer; --reply"));
  EXPECT_THAT(look(31), Optional(HasSubstr("30 packets left out")));
  EXPECT_FALSE(look(41)) << "nothing new";
}

TEST_F(LinkWatchTest, saysThatAFrameNumberStandsStillAndWhichViewIsFollowed) {
  UdpSocket socket;
  AircraftState state;
  state.position = {Degrees{36.6}, Degrees{128.3}, Metres{1500}};
  state.head = Attitude{Degrees{10}, {}, {}};
  auto bytes = encodeCigiHost(state, 0, 0);
  const auto second = bytes;
  bytes.insert(bytes.end(), second.end() - 32, second.end());
  wire::put(bytes, bytes.size() - 30, ByteOrder::big, std::uint16_t{4});
  send(socket, bytes, 20);
  const std::string first = look(1).value_or(""), then = look(11).value_or("");
  EXPECT_THAT(first + then,
              HasSubstr("the frame number of " + name(socket) + " stands still; its messages are"));
  EXPECT_THAT(first + then, HasSubstr("view 0 of " + name(socket) + " is followed, of others: 4; --view"));
  EXPECT_FALSE(look(21));
}

TEST_F(LinkWatchTest, namesAStraySenderBesideTheHost) {
  UdpSocket host_, stray;
  for (std::uint32_t frame = 1; frame <= 20; ++frame) send(host_, host(frame));
  EXPECT_FALSE(look(1));
  send(stray, kBad, 3);
  EXPECT_EQ(receiver_->statistics().from, name(host_));
  EXPECT_EQ(receiver_->statistics().bad, 0U);
  EXPECT_THAT(look(2), Optional(HasSubstr("3 of 3 datagrams refused; the newest from " + name(stray))));
}

TEST_F(LinkWatchTest, namesTwoHostsAndCountsEachApart) {
  UdpSocket one, two;
  for (std::uint32_t i = 1; i <= 300; ++i) {
    send(one, host(i));
    send(two, host(30000 + i));
  }
  for (const HostStatistics& s : {receiver_->statistics(), receiver_->senders().others.at(0)}) {
    EXPECT_EQ(s.received, 300U);
    EXPECT_EQ(s.lost, 0U);
  }
  EXPECT_THAT(
      look(1),
      Optional(port() + ": two hosts send: 300 datagrams of " + name(one) + " beside 300 of " + name(two) +
               ", and what both say is drawn in turn; end one, or allow one address alone (--from)"));
}

TEST_F(LinkWatchTest, isSilentAboutAHostThatRestartsAtAnotherPort) {
  UdpSocket one, two;
  for (std::uint32_t i = 1; i <= 50; ++i) send(one, host(7000 + i));
  EXPECT_FALSE(look(1));
  for (std::uint32_t i = 1; i <= 50; ++i) send(two, host(i));
  for (double now = 2; now < 60; ++now) EXPECT_FALSE(look(now));
  EXPECT_EQ(receiver_->statistics().lost, 0U);
}

TEST_F(LinkWatchTest, saysWhyAHostsOwnDatagramsLeadToNothingNew) {
  UdpSocket socket;
  send(socket, host(0));
  EXPECT_FALSE(look(0));
  for (double now = 1; now < 10; ++now) {
    if (now < 5) send(socket, host(0));  // a host that goes on with one number is flown
    EXPECT_FALSE(look(now)) << now;
  }
  EXPECT_THAT(look(10),
              Optional(HasSubstr("no new state for 10 s; the newest from " + name(socket) +
                                 ": frame number of IG Control: expected one that rises, above 0, found 0")));
}

class LinkWatchOfOneSender : public LinkWatchTest {
 protected:
  static link::ReceiverOptions only() {
    link::ReceiverOptions options;
    options.sender = "127.0.0.3";
    return options;
  }
  LinkWatchOfOneSender() : LinkWatchTest(only()) {}
};

TEST_F(LinkWatchOfOneSender, namesWhoSendsWithoutBeingAllowed) {
  UdpSocket socket;
  send(socket, host(1), 5);
  EXPECT_THAT(look(1),
              Optional(port() + ": 5 datagrams of others than 127.0.0.3 thrown away; the newest from " +
                       name(socket) + "; --from says who may send"));
}

}  // namespace
}  // namespace trimtab::test
