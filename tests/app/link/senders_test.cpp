#include <gmock/gmock.h>

#include "link_support.h"
#include "udp_socket.h"

/// Who reaches a receiver, and who is heard.
namespace trimtab::test {
namespace {

TEST(Senders, areOfThisMachineAloneUnlessToldOtherwise) {
  const auto receiver = opened();
  sendOnLoopback("127.0.0.9", receiver->port(), 1);
  sendOnLoopback("127.0.0.1", receiver->port(), 2);
  const auto states = gathered(*receiver, count(1));
  ASSERT_EQ(states.size(), 1u);
  EXPECT_EQ(states[0].state.packet, 2u) << "it listens at 127.0.0.1 and nowhere else";
  link::ReceiverOptions every;
  every.bindAddress = "0.0.0.0";
  const auto open = opened(every);
  sendOnLoopback("127.0.0.9", open->port(), 1);
  EXPECT_EQ(gathered(*open, count(1)).size(), 1u);
}

TEST(Senders, areHeardIfTheyAreAllowed) {
  link::ReceiverOptions options;
  options.sender = "127.0.0.3";
  const auto receiver = opened(options);
  int tapped = 0;
  receiver->tap([&tapped](const Datagram&) { ++tapped; });
  for (std::uint32_t frame = 1; frame <= 10; ++frame)
    sendOnLoopback("127.0.0.1", receiver->port(), frame, "127.0.0.4");
  sendOnLoopback("127.0.0.1", receiver->port(), 11, "127.0.0.3");
  const auto states = gathered(*receiver, count(1));
  receiver->tap(nullptr);
  ASSERT_EQ(states.size(), 1u);
  EXPECT_EQ(states[0].state.packet, 11u);
  EXPECT_EQ(tapped, 1) << "others are not recorded either";
  EXPECT_EQ(receiver->statistics().received, 1u);
  const link::Senders senders = receiver->senders();
  EXPECT_EQ(senders.allowed, "127.0.0.3");
  EXPECT_EQ(senders.refused, 10u);
  EXPECT_THAT(senders.lastRefused, testing::StartsWith("127.0.0.4:"));
  options.sender = "nobody at all";
  EXPECT_FALSE(link::Receiver::open(options));
}

TEST(Senders, theFirstOneOfAGoodPacketIsHeld) {
  link::ReceiverOptions options;
  options.sender = link::kFirst;
  const auto receiver = opened(options);
  EXPECT_EQ(receiver->senders().allowed, link::kFirst);
  UdpSocket stray;
  stray.send(receiver->port(), std::vector<std::byte>(30, std::byte{7}));
  while (receiver->statistics().bad < 1) std::this_thread::sleep_for(1ms);
  sendOnLoopback("127.0.0.1", receiver->port(), 1, "127.0.0.3");
  sendOnLoopback("127.0.0.1", receiver->port(), 2, "127.0.0.4");
  sendOnLoopback("127.0.0.1", receiver->port(), 3, "127.0.0.3");
  EXPECT_EQ(gathered(*receiver, count(2)).size(), 2u) << "the host may send from another port";
  EXPECT_EQ(receiver->senders().allowed, "127.0.0.3");
  EXPECT_EQ(receiver->senders().refused, 1u);
}

}  // namespace
}  // namespace trimtab::test
