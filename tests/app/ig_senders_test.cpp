#include <gmock/gmock.h>

#include "ig_support.h"
#include "tests/app/link/udp_socket.h"
#include "trimtab/host/encoder.h"

/// What the image generator says of who sends to it, while it runs and in its summary.
namespace trimtab {
namespace {

using test::IgProcess;
using testing::HasSubstr;

IgProcess listening() {
  return IgProcess({"--preset", "default", "--terrain", test::smallTerrain().string(), "--listen", "0",
                    "--headless", "--size", "160x100", "--json"});
}

std::vector<std::byte> host(std::uint32_t frame, double latitude = 36.63) {
  AircraftState state;
  state.position = {Degrees{latitude}, Degrees{128.35}, Metres{1500}};
  state.time = frame * 0.02;
  return encodeCigiHost(state, frame, 0);
}

void send(const IgProcess& ig, const test::UdpSocket& from, const std::vector<std::byte>& bytes) {
  from.send(ig.port(), bytes);
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

nlohmann::json ended(IgProcess& ig) {
  ig.signal(SIGINT);
  EXPECT_EQ(ig.end(), 0) << ig.err();
  return ig.summary();
}

std::string name(const test::UdpSocket& socket) {
  return "127.0.0.1:" + std::to_string(socket.port());
}

TEST(IgSenders, areNamedWhileEveryDatagramIsRefused) {
  IgProcess ig = listening();
  ASSERT_NE(ig.port(), 0) << ig.err();
  test::UdpSocket socket;
  for (int i = 0; i < 250; ++i) send(ig, socket, std::vector<std::byte>(404));
  EXPECT_TRUE(ig.says("warning: UDP port " + std::to_string(ig.port()) + ": ")) << ig.err();
  EXPECT_TRUE(ig.says("datagrams refused; the newest from " + name(socket) + ": byte 0: datagram: expected"))
      << ig.err();
  EXPECT_TRUE(ig.says("250 of 250 datagrams refused")) << "ten seconds later, with all of them\n" << ig.err();
  const auto summary = ended(ig);
  EXPECT_EQ(summary["host"]["bad"], 250);
  EXPECT_EQ(summary["frames"], 0);
}

TEST(IgSenders, ofAnotherEntityAreToldWhichOneIsDrawn) {
  IgProcess ig = listening();
  ASSERT_NE(ig.port(), 0) << ig.err();
  test::UdpSocket socket;
  for (std::uint32_t frame = 1; frame <= 20; ++frame) {
    auto bytes = host(frame);
    wire::put(bytes, 26, ByteOrder::big, std::uint16_t{1});
    send(ig, socket, bytes);
  }
  EXPECT_TRUE(ig.says("are for someone else; the newest from " + name(socket) +
                      ": byte 26: entity: expected 0, the own aircraft, found no entity 0; seen: 1"))
      << ig.err();
  const auto summary = ended(ig);
  EXPECT_EQ(summary["host"]["received"], 20);
  EXPECT_EQ(summary["host"]["not_for_us"], 20);
  EXPECT_EQ(summary["host"]["bad"], 0);
}

TEST(IgSenders, areMissedWhereNothingArrives) {
  IgProcess ig = listening();
  ASSERT_NE(ig.port(), 0) << ig.err();
  EXPECT_TRUE(ig.says("warning: nothing has arrived on UDP port " + std::to_string(ig.port()) + " for 10 s"))
      << ig.err();
  ended(ig);
}

TEST(IgSenders, areCountedApart) {
  IgProcess ig = listening();
  ASSERT_NE(ig.port(), 0) << ig.err();
  test::UdpSocket one, two;
  for (std::uint32_t i = 1; i <= 100; ++i) {
    send(ig, one, host(i));
    send(ig, two, host(30000 + i, 36.64));
  }
  EXPECT_TRUE(ig.says("two hosts send: ")) << ig.err();
  const auto summary = ended(ig);
  EXPECT_EQ(summary["packets"], 200) << "both are decided, in turn";
  EXPECT_EQ(summary["host"]["from"], name(two));
  EXPECT_EQ(summary["host"]["received"], 100);
  EXPECT_EQ(summary["host"]["lost"], 0);
  ASSERT_EQ(summary["host"]["other_senders"].size(), 1u);
  EXPECT_EQ(summary["host"]["other_senders"][0]["from"], name(one));
  EXPECT_EQ(summary["host"]["other_senders"][0]["received"], 100);
}

}  // namespace
}  // namespace trimtab
