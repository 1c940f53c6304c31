#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "app/link/link.h"
#include "trimtab/host/encoder.h"

/// What tests of the link share.
namespace trimtab::test {

using namespace std::chrono_literals;

/// Sends the host's state of one frame to an address, from the loopback interface.
inline void sendOnLoopback(const std::string& address, std::uint16_t port, std::uint32_t frame = 1,
                           const std::string& from = "0.0.0.0") {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  ASSERT_EQ(inet_pton(AF_INET, from.c_str(), &own.sin_addr), 1);
  ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&own), sizeof own), 0);
  in_addr loopback{htonl(INADDR_LOOPBACK)};
  ::setsockopt(socket, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  ASSERT_EQ(inet_pton(AF_INET, address.c_str(), &to.sin_addr), 1);
  AircraftState state;
  state.position = {Degrees{36.6}, Degrees{128.3}, Metres{1500}};
  const auto bytes = encodeCigiHost(state, frame, 0);
  EXPECT_EQ(
      ::sendto(socket, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to),
      static_cast<ssize_t>(bytes.size()))
      << std::strerror(errno);
  ::close(socket);
}

inline std::unique_ptr<link::Receiver> opened(link::ReceiverOptions options = {}) {
  auto receiver = link::Receiver::open(options);
  EXPECT_TRUE(receiver) << toString(receiver.findings());
  return std::move(*receiver);
}

/// Everything received until `enough` says so, or for ten seconds.
template <class Enough>
std::vector<ReceivedState> gathered(link::Receiver& receiver, Enough enough) {
  std::vector<ReceivedState> all, some;
  const auto end = std::chrono::steady_clock::now() + 10s;
  do {
    std::this_thread::sleep_for(2ms);
    receiver.take(some);
    all.insert(all.end(), some.begin(), some.end());
  } while (!enough(all) && std::chrono::steady_clock::now() < end);
  return all;
}

inline auto count(std::size_t n) {
  return [n](const auto& all) { return all.size() >= n; };
}

}  // namespace trimtab::test
