#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <thread>

#include "socket.h"
#include "trimtab/host/encoder.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/protocol_names.h"

namespace trimtab::link {
namespace {

using Clock = std::chrono::steady_clock;

// Rates and speeds so low, and gaps so long, that deadlines would not fit the clock's 292 years.
constexpr double kLowestRateHz = 1e-3, kLongestGapS = 1e9;

bool isSpeed(double speed) {
  return speed >= 1e-3 && speed <= 1000;
}

class UdpPlayer final : public FeedPlayer {
 public:
  UdpPlayer(Descriptor socket, Flight flight, const PlayOptions& options)
      : socket_(std::move(socket)),
        flight_(std::move(flight)),
        protocol_(options.protocol),
        rateHz_(options.rateHz),
        head_(options.head),
        symbols_(options.symbols),
        speed_(options.speed),
        loop_(options.loop),
        epoch_(now()) {
    moveTo(options.startS);
    thread_ = std::thread([this] { run(); });
  }
  ~UdpPlayer() override {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  void pause(bool paused) override {
    change([&] { paused_ = paused; });
  }
  void setSpeed(double speed) override {
    if (!isSpeed(speed)) return;
    change([&] { speed_ = speed; });
  }
  void setLoop(bool loop) override {
    change([&] { loop_ = loop; });
  }
  void seek(double timeS) override {
    change([&] { moveTo(timeS); });
  }
  double position() const override {
    const std::lock_guard lock(mutex_);
    return position_;
  }
  bool finished() const override {
    const std::lock_guard lock(mutex_);
    return finished_;
  }
  std::uint64_t sent() const override {
    const std::lock_guard lock(mutex_);
    return sent_;
  }

 private:
  template <class Edit>
  void change(Edit edit) {
    {
      const std::lock_guard lock(mutex_);
      edit();
      ++edits_;
    }
    changed_.notify_all();
  }
  void moveTo(double timeS) {
    position_ = std::isfinite(timeS) ? std::clamp(timeS, 0.0, flight_.durationS()) : 0;
    const auto at =
        std::lower_bound(flight_.states.begin(), flight_.states.end(), flight_.beginS() + position_,
                         [](const AircraftState& state, double t) { return state.time < t; });
    row_ = static_cast<std::size_t>(at - flight_.states.begin());
    finished_ = false;
  }
  void run();
  void runEvenly(std::unique_lock<std::mutex>& lock);
  void runByRows(std::unique_lock<std::mutex>& lock);
  /// `state` is that of the flight at `flightS`.
  void send(AircraftState state, double flightS, Clock::duration elapsed);
  bool idle() const { return finished_ || (paused_ && rateHz_ <= 0); }

  Descriptor socket_;
  const Flight flight_;
  const WireProtocol protocol_;
  const double rateHz_;
  const std::optional<HeadLog> head_;
  const bool symbols_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool stop_ = false, paused_ = false, finished_ = false;
  double speed_;
  bool loop_;
  double position_ = 0;  ///< seconds into the flight of what was sent last
  std::size_t row_ = 0;  ///< the next one, when rows are sent as they are
  std::uint64_t edits_ = 0;
  std::uint64_t sent_ = 0;

  const double epoch_;
  std::uint32_t frame_ = 0;
  std::thread thread_;
};

void UdpPlayer::send(AircraftState state, double flightS, Clock::duration elapsed) {
  if (head_) state.head = headAt(*head_, flightS);
  // The host's clock runs on through pauses and loops, as a simulator's does.
  state.time = std::chrono::duration<double>(elapsed).count();
  if (protocol_ == WireProtocol::native_fdm) state.time += epoch_;
  const auto encodeCigi = protocol_ == WireProtocol::cigi4 ? encodeCigi4Host : encodeCigiHost;
  auto bytes = protocol_ == WireProtocol::native_fdm ? encodeNativeFdm(state)
                                                     : encodeCigi(state, ++frame_, 0, ByteOrder::big);
  if (symbols_) {
    const auto packets = encodeCigiSymbols(exampleSymbols(state.time));
    bytes.insert(bytes.end(), packets.begin(), packets.end());
  }
  // Nobody there (ECONNREFUSED) is no reason to stop: a host sends whether it is heard or not. It is told of
  // the packet before and in place of this one, which is sent once more: someone may listen by now.
  const auto attempt = [&] {
    return ::send(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  };
  if (attempt() < 0 && (errno == ECONNREFUSED || errno == EINTR)) static_cast<void>(attempt());
  // A datagram that the system has no room for is lost, as on a full line; the receiver sees it by the frame
  // numbers.
  ++sent_;
}

void UdpPlayer::run() {
  raisePriority();
  std::unique_lock lock(mutex_);
  if (rateHz_ > 0)
    runEvenly(lock);
  else
    runByRows(lock);
}

void UdpPlayer::runEvenly(std::unique_lock<std::mutex>& lock) {
  const std::chrono::duration<double> period(1 / rateHz_);
  const auto begin = Clock::now();
  for (std::uint64_t tick = 0; !stop_; ++tick) {
    // Deadlines from the start, so that no error adds up; after a long stall it goes on from now, without a
    // burst.
    constexpr std::chrono::milliseconds kLongestBurst(250);
    if (const auto late = Clock::now() - begin - period * static_cast<double>(tick); late > kLongestBurst)
      tick += static_cast<std::uint64_t>(late / period);
    const auto due = std::chrono::duration_cast<Clock::duration>(period * static_cast<double>(tick));
    changed_.wait_until(lock, begin + due, [this] { return stop_; });
    if (stop_ || finished_) {
      changed_.wait(lock, [this] { return stop_ || !finished_; });
      continue;
    }
    send(stateAt(flight_, flight_.beginS() + position_), position_, due);
    if (paused_) continue;
    if (position_ >= flight_.durationS() && !loop_) {
      finished_ = true;
      continue;
    }
    position_ += speed_ * period.count();
    if (position_ <= flight_.durationS()) continue;
    position_ =
        loop_ && flight_.durationS() > 0 ? std::fmod(position_, flight_.durationS()) : flight_.durationS();
  }
}

void UdpPlayer::runByRows(std::unique_lock<std::mutex>& lock) {
  const auto begin = Clock::now();
  auto anchor = begin;  // when the flight was, or would have been, at `anchorS`
  double anchorS = position_;
  std::uint64_t seen = edits_;
  while (!stop_) {
    if (row_ >= flight_.states.size()) {
      if (loop_ && flight_.durationS() > 0) {
        moveTo(0);
        anchor = Clock::now();
        anchorS = 0;
      } else {
        finished_ = true;
      }
    }
    changed_.wait(lock, [this] { return stop_ || !idle(); });
    if (stop_) return;
    const bool restarted = seen != edits_;
    if (restarted) {
      seen = edits_;
      anchor = Clock::now();
      anchorS = position_;
      if (row_ >= flight_.states.size()) continue;
    }
    const double rowS = flight_.states[row_].time - flight_.beginS();
    const auto due = anchor + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                                  std::min((rowS - anchorS) / speed_, kLongestGapS)));
    if (changed_.wait_until(lock, due, [&] { return stop_ || seen != edits_; })) continue;
    send(flight_.states[row_], rowS, due - begin);
    position_ = rowS;
    ++row_;
  }
}

}  // namespace

Result<std::unique_ptr<FeedPlayer>> FeedPlayer::start(Flight flight, const PlayOptions& options) {
  Findings errors;
  const auto refuse = [&errors](const char* key, const char* expected, const std::string& found) {
    errors.push_back({Severity::error, "feed", key, expected, found});
  };
  if (flight.states.empty()) refuse("flight", "at least one state", "none");
  if (!(options.rateHz == 0 || (options.rateHz >= kLowestRateHz && options.rateHz <= 10000)))
    refuse("rate", "0, or 0.001..10000 Hz", std::to_string(options.rateHz));
  if (!isSpeed(options.speed)) refuse("speed", "0.001..1000", std::to_string(options.speed));
  const ProtocolName* const protocol = nameOf(options.protocol);
  if (!protocol || !protocol->sent)
    refuse("protocol", "native-fdm, cigi3 or cigi4", protocol ? protocol->option : "none");
  if (options.head && options.protocol == WireProtocol::native_fdm)
    refuse("head", "cigi3 or cigi4, whose View Control carries a head", "native-fdm, which has none");
  if (options.symbols && protocol && options.protocol != WireProtocol::cigi3)
    refuse("symbols", "cigi3, whose packets define symbols",
           std::string(protocol->option) + ", which has none");
  const auto address = resolve(options.to);
  if (!address) errors.insert(errors.end(), address.findings().begin(), address.findings().end());
  if (!errors.empty()) return errors;
  Descriptor socket(::socket(address->family(), SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (socket.get() < 0 || ::connect(socket.get(), address->raw(), address->size) != 0)
    return Finding{Severity::error, "udp " + addressText(*address), "", "an address that can be reached",
                   std::strerror(errno)};
  return std::unique_ptr<FeedPlayer>(
      std::make_unique<UdpPlayer>(std::move(socket), std::move(flight), options));
}

}  // namespace trimtab::link
