#include <gmock/gmock.h>
#include <ifaddrs.h>
#include <net/if.h>

#include "app/link/socket.h"
#include "link_support.h"
#include "udp_socket.h"

/// Addresses of IPv6, groups of it, and one host among several of a machine.
namespace trimtab::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A plain socket of IPv6 on the loopback.
class UdpSocket6 {
 public:
  explicit UdpSocket6(const in6_addr& address = in6addr_loopback) : fd_(::socket(AF_INET6, SOCK_DGRAM, 0)) {
    sockaddr_in6 own{};
    own.sin6_family = AF_INET6;
    own.sin6_addr = address;
    works_ = fd_ >= 0 && ::bind(fd_, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0;
  }
  ~UdpSocket6() { ::close(fd_); }
  UdpSocket6(const UdpSocket6&) = delete;
  UdpSocket6& operator=(const UdpSocket6&) = delete;

  bool works() const { return works_; }
  std::uint16_t port() const {
    sockaddr_in6 own{};
    socklen_t size = sizeof own;
    ::getsockname(fd_, reinterpret_cast<sockaddr*>(&own), &size);
    return ntohs(own.sin6_port);
  }
  bool send(const std::string& address, std::uint16_t port, std::uint32_t frame) const {
    const auto to = link::resolve({address, port});
    if (!to) return false;
    AircraftState state;
    state.position = {Degrees{36.6}, Degrees{128.3}, Metres{1500}};
    const auto bytes = encodeCigiHost(state, frame, 0);
    return ::sendto(fd_, bytes.data(), bytes.size(), 0, to->raw(), to->size) ==
           static_cast<ssize_t>(bytes.size());
  }
  std::vector<std::byte> receive() const {
    pollfd polled{fd_, POLLIN, 0};
    if (::poll(&polled, 1, 2000) <= 0) return {};
    std::vector<std::byte> bytes(2048);
    const ssize_t length = ::recv(fd_, bytes.data(), bytes.size(), 0);
    bytes.resize(length > 0 ? static_cast<std::size_t>(length) : 0);
    return bytes;
  }

 private:
  int fd_;
  bool works_ = false;
};

class Addresses6 : public testing::Test {
 protected:
  void SetUp() override {
    if (!host_.works()) GTEST_SKIP() << "this machine has no IPv6";
  }
  UdpSocket6 host_;
};

TEST_F(Addresses6, areListenedAtAndRepliedTo) {
  link::ReceiverOptions options;
  options.bindAddress = "::1";
  options.reply = link::Endpoint{"::1", host_.port()};
  const auto receiver = opened(options);
  ASSERT_TRUE(host_.send("::1", receiver->port(), 4));
  EXPECT_EQ(gathered(*receiver, count(1)).size(), 1U);
  EXPECT_EQ(receiver->statistics().from, "[::1]:" + std::to_string(host_.port()));
  const auto reply = host_.receive();
  ASSERT_EQ(reply.size(), 24U);
  EXPECT_EQ(std::to_integer<int>(reply[0]), 101);
}

TEST_F(Addresses6, ofEveryInterfaceHearIpv4Too) {
  link::ReceiverOptions options;
  options.bindAddress = "::";
  UdpSocket host4;
  options.reply = link::Endpoint{"127.0.0.1", host4.port()};
  const auto receiver = opened(options);
  ASSERT_TRUE(host_.send("::1", receiver->port(), 1));
  gathered(*receiver, count(1));
  EXPECT_THAT(receiver->statistics().from, StartsWith("[::1]:"));
  sendOnLoopback("127.0.0.1", receiver->port(), 1);
  gathered(*receiver, count(1));
  EXPECT_THAT(receiver->statistics().from, StartsWith("127.0.0.1:"));
  EXPECT_EQ(host4.receive(2000).size(), 24U) << "the reply goes by IPv4";
}

TEST_F(Addresses6, areAllowedAndRefusedLikeOthers) {
  link::ReceiverOptions options;
  options.bindAddress = "::";
  options.sender = "::1";
  const auto receiver = opened(options);
  sendOnLoopback("127.0.0.1", receiver->port(), 1);
  ASSERT_TRUE(host_.send("::1", receiver->port(), 2));
  const auto states = gathered(*receiver, count(1));
  ASSERT_EQ(states.size(), 1U);
  EXPECT_EQ(states[0].state.packet, 2U);
  EXPECT_EQ(receiver->senders().refused, 1U);
  EXPECT_THAT(receiver->senders().lastRefused, StartsWith("127.0.0.1:"));
}

/// Returns an interface that carries groups, with an address of its own; empty if there is none.
std::pair<std::string, std::string> interfaceWithGroups() {
  std::pair<std::string, std::string> found;
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return found;
  for (const ifaddrs* each = all; each != nullptr; each = each->ifa_next) {
    const bool carries = (each->ifa_flags & IFF_UP) != 0 && (each->ifa_flags & IFF_MULTICAST) != 0;
    if (!carries || each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET6) continue;
    const auto* address = reinterpret_cast<const sockaddr_in6*>(each->ifa_addr);
    char text[INET6_ADDRSTRLEN] = "";
    ::inet_ntop(AF_INET6, &address->sin6_addr, text, sizeof text);
    found = {each->ifa_name, text};
    if (IN6_IS_ADDR_LINKLOCAL(&address->sin6_addr)) found.second += std::string("%") + each->ifa_name;
  }
  ::freeifaddrs(all);
  return found;
}

TEST(Groups, ofIpv6AreHeardByTheirMembers) {
  const auto [name, address] = interfaceWithGroups();
  if (name.empty()) GTEST_SKIP() << "no interface of this machine carries groups of IPv6";
  const UdpSocket6 host(in6addr_any);
  // Groups of one interface alone: nothing leaves the machine.
  const std::string group = "ff11::4:217", other = "ff11::4:218";
  link::ReceiverOptions options;
  options.bindAddress = address;
  options.group = group;
  const auto byAddress = opened(options);
  if (!host.send(group + '%' + name, byAddress->port(), 1)) GTEST_SKIP() << "no route to groups of " << name;
  EXPECT_EQ(gathered(*byAddress, count(1)).size(), 1U);
  options.bindAddress = "::";
  options.port = byAddress->port();
  options.group = group + '%' + name;
  const auto byName = opened(options);
  ASSERT_TRUE(host.send(other + '%' + name, byName->port(), 2));
  ASSERT_TRUE(host.send(group + '%' + name, byName->port(), 3));
  for (const auto* receiver : {&byAddress, &byName}) {
    const auto states = gathered(**receiver, count(1));
    ASSERT_EQ(states.size(), 1U) << "each member of a group gets every datagram of it, and of no other";
    EXPECT_EQ(states[0].state.packet, 3U);
  }
}

TEST(Groups, areRefusedIfTheyAreNone) {
  link::ReceiverOptions options;
  options.group = "fe80::4:217";
  const auto refused = link::Receiver::open(options);
  ASSERT_FALSE(refused);
  EXPECT_THAT(toString(refused.findings()), HasSubstr("or ff00::/8, found fe80::4:217"));
}

TEST_F(Addresses6, areSentTo) {
  link::ReceiverOptions options;
  options.bindAddress = "::1";
  const auto receiver = opened(options);
  Flight flight;
  for (int i = 0; i < 20; ++i) {
    AircraftState state;
    state.time = i * 0.05;
    state.position = {Degrees{36.6}, Degrees{128.3 + i * 1e-5}, Metres{1500}};
    flight.states.push_back(state);
  }
  const auto player = link::FeedPlayer::start(flight, {.to = {"::1", receiver->port()}});
  ASSERT_TRUE(player) << toString(player.findings());
  EXPECT_GE(gathered(*receiver, count(10)).size(), 10U);
}

TEST(OneOfSeveralHosts, isToldByItsPort) {
  UdpSocket one, two;
  const auto message = [](std::uint32_t frame) {
    AircraftState state;
    state.position = {Degrees{36.6}, Degrees{128.3}, Metres{1500}};
    return encodeCigiHost(state, frame, 0);
  };
  link::ReceiverOptions options;
  options.sender = "127.0.0.1:" + std::to_string(two.port());
  const auto receiver = opened(options);
  for (std::uint32_t frame = 1; frame <= 5; ++frame) {
    one.send(receiver->port(), message(frame));
    two.send(receiver->port(), message(100 + frame));
  }
  const auto states = gathered(*receiver, count(5));
  ASSERT_EQ(states.size(), 5U);
  for (const ReceivedState& each : states) EXPECT_GT(each.state.packet, 100U);
  EXPECT_EQ(receiver->senders().refused, 5U);
  EXPECT_EQ(receiver->senders().allowed, options.sender);
  EXPECT_TRUE(receiver->senders().others.empty());
}

TEST(Endpoints, areOfEitherFamily) {
  const auto good = [](const std::string& text, const std::string& address, int port) {
    const auto endpoint = link::parseEndpoint(text);
    ASSERT_TRUE(endpoint) << text;
    EXPECT_EQ(endpoint->address, address);
    EXPECT_EQ(endpoint->port, port);
  };
  good("[::1]:8004", "::1", 8004);
  good("[fe80::7%eth0]:90", "fe80::7%eth0", 90);
  good("10.0.0.5:8004", "10.0.0.5", 8004);
  const auto why = [](const std::string& text) { return toString(link::parseEndpoint(text).findings()); };
  EXPECT_THAT(why("::1:8004"), HasSubstr("an IPv6 address in brackets, such as [::1]:8004"));
  EXPECT_THAT(why("[::1]"), HasSubstr("HOST:PORT or PORT"));
  EXPECT_THAT(why("[]:80"), HasSubstr("found"));
}

}  // namespace
}  // namespace trimtab::test
