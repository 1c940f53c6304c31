#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <iostream>
#include <thread>

#include "app/link/link.h"
#include "injection.h"
#include "trimtab/host/encoder.h"

/// A link whose calls on sockets fail. It says why it cannot be opened; once it is, a call that fails costs
/// no more than the datagram that it was for, and reception goes on.
namespace trimtab {
namespace {

using namespace std::chrono_literals;
using test::Injection;
namespace faults = test::faults;

constexpr faults::Way kWays[] = {faults::Way::no_space, faults::Way::io_error, faults::Way::interrupted,
                                 faults::Way::short_count};
constexpr std::size_t kSent = 6;

/// Tells apart where a socket failed.
struct Outcome {
  bool opened = false;
  std::size_t states = 0, bad = 0;
  long calls = 0;
  bool says = true;
};

template <class Condition>
bool until(const Condition& condition) {
  for (int i = 0; i < 400 && !condition(); ++i) std::this_thread::sleep_for(5ms);
  return condition();
}

Outcome receive(long call, faults::Way way) {
  // The sender's socket is there before calls are counted, and it is used by the system call itself.
  const int sender = ::socket(AF_INET, SOCK_DGRAM, 0);
  faults::watch(faults::kSockets);
  faults::disturb(call, way);
  Outcome outcome;
  {
    const auto receiver = link::Receiver::open({});
    outcome.opened = receiver.ok();
    if (!receiver) {
      const Finding finding = receiver.findings().front();
      outcome.says = !finding.where.empty() && !finding.expected.empty() && !finding.found.empty();
    } else {
      sockaddr_in to{};
      to.sin_family = AF_INET;
      to.sin_port = htons((*receiver)->port());
      to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      std::vector<ReceivedState> states;
      for (std::size_t i = 0; i < kSent; ++i) {
        AircraftState state;
        state.time = static_cast<double>(i);
        state.position = {Degrees{36.6}, Degrees{128.3}, Metres{2000}};
        const auto bytes = encodeCigiHost(state, static_cast<std::uint32_t>(i + 1), 0);
        const auto heard = [&] { return (*receiver)->senders().received; };
        const auto before = heard();
        ::syscall(SYS_sendto, sender, bytes.data(), bytes.size(), 0, &to, sizeof to);
        until([&] { return heard() > before; });
      }
      (*receiver)->take(states);
      outcome.states = states.size();
      outcome.bad = (*receiver)->statistics().bad;
    }
  }
  outcome.calls = faults::calls();
  faults::stop();
  ::close(sender);
  return outcome;
}

TEST_F(Injection, ofReceiving) {
  const Outcome undisturbed = receive(-1, faults::Way::io_error);
  ASSERT_TRUE(undisturbed.opened);
  ASSERT_EQ(undisturbed.states, kSent);
  ASSERT_GT(undisturbed.calls, 10);
  long runs = 0, violations = 0, refused = 0;
  for (long call = 0; call < undisturbed.calls; ++call)
    for (const faults::Way way : kWays) {
      ++runs;
      const Outcome outcome = receive(call, way);
      refused += !outcome.opened;
      const bool good = outcome.opened ? outcome.states + outcome.bad == kSent && outcome.bad <= 1
                                       : outcome.says && way != faults::Way::short_count;
      if (good) continue;
      ++violations;
      ADD_FAILURE() << "call " << call << ", " << faults::nameOf(way) << ": "
                    << (outcome.opened ? "received " + std::to_string(outcome.states) + ", bad " +
                                             std::to_string(outcome.bad)
                                       : "refused without a reason");
    }
  EXPECT_GT(refused, 0);
  std::cout << "receiving: " << undisturbed.calls << " calls, " << runs << " runs, " << violations
            << " violations\n";
}

TEST_F(Injection, ofSending) {
  Flight flight;
  for (std::size_t i = 0; i < kSent; ++i) {
    AircraftState state;
    state.time = 0.01 * static_cast<double>(i);
    state.position = {Degrees{36.6}, Degrees{128.3}, Metres{2000}};
    flight.states.push_back(state);
  }
  const auto receiver = link::Receiver::open({});
  ASSERT_TRUE(receiver);
  struct Sent {
    bool opened = false, finished = false, says = true;
    std::uint64_t received = 0;
    long calls = 0;
  };
  const auto send = [&](long call, faults::Way way) {
    const auto before = (*receiver)->senders().received;
    faults::watch(faults::kSockets);
    faults::disturb(call, way);
    Sent sent;
    link::PlayOptions how;
    how.to.port = (*receiver)->port();
    how.rateHz = 0;
    {
      const auto player = link::FeedPlayer::start(flight, how);
      sent.opened = player.ok();
      if (player)
        sent.finished = until([&] { return (*player)->finished(); });
      else
        sent.says = !player.findings().empty() && !player.findings().front().found.empty();
    }
    sent.calls = faults::calls();
    faults::stop();
    if (sent.opened) until([&] { return (*receiver)->senders().received >= before + kSent - 1; });
    std::this_thread::sleep_for(2ms);
    sent.received = (*receiver)->senders().received - before;
    return sent;
  };
  const Sent undisturbed = send(-1, faults::Way::io_error);
  ASSERT_EQ(undisturbed.received, kSent);
  long runs = 0, violations = 0;
  // Calls of the receiver that is open beside it are counted, too: there are more of them at times.
  for (long call = 0; call < undisturbed.calls; ++call)
    for (const faults::Way way : kWays) {
      ++runs;
      const Sent sent = send(call, way);
      if (sent.opened ? sent.finished && sent.received + 1 >= kSent : sent.says) continue;
      ++violations;
      ADD_FAILURE() << "call " << call << ", " << faults::nameOf(way) << ": received " << sent.received;
    }
  std::cout << "sending: " << undisturbed.calls << " calls, " << runs << " runs, " << violations
            << " violations\n";
}

}  // namespace
}  // namespace trimtab
