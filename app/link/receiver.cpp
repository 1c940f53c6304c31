#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "gate.h"
#include "multicast.h"
#include "socket.h"
#include "terrain_desk.h"
#include "trimtab/host/encoder.h"
#include "trimtab/host/received_state.h"

namespace trimtab::link {
namespace {

constexpr std::size_t kQueue = 4096;  // over a minute at 60 Hz

using Clock = std::chrono::steady_clock;

double seconds(const timespec& t) {
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

/// Where Start of Frame goes.
struct Reply {
  Address to;
  Descriptor socket;  ///< none: the receiver's own serves, so that a host may answer where it came from
};

class UdpReceiver final : public Receiver {
 public:
  UdpReceiver(Descriptor socket, Descriptor stop, std::uint16_t port, const ReceiverOptions& options,
              std::optional<Reply> reply, Gate gate)
      : socket_(std::move(socket)),
        stop_(std::move(stop)),
        port_(port),
        reply_(std::move(reply)),
        replyPeriod_(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(1 / options.replyRateHz))),
        wake_(options.wake),
        decoder_(options.choice),
        gate_(std::move(gate)) {
    queue_.reserve(kQueue);
    thread_ = std::thread([this] { run(); });
  }
  ~UdpReceiver() override {
    const std::uint64_t one = 1;
    static_cast<void>(::write(stop_.get(), &one, sizeof one));
    thread_.join();
  }

  std::uint16_t port() const override { return port_; }
  void take(std::vector<ReceivedState>& states) override {
    states.clear();
    const std::lock_guard lock(mutex_);
    // Oldest first: the ring begins where the next one would be written once it is full.
    const auto split = queue_.begin() + static_cast<std::ptrdiff_t>(queue_.size() == kQueue ? oldest_ : 0);
    states.insert(states.end(), split, queue_.end());
    states.insert(states.end(), queue_.begin(), split);
    queue_.clear();
    oldest_ = 0;
  }
  HostStatistics statistics() const override {
    const std::lock_guard lock(mutex_);
    HostStatistics statistics = statistics_;
    statistics.rateHz = now() - statistics.lastArrival < 1 ? statistics.rateHz : 0;
    return statistics;
  }
  Senders senders() const override {
    const std::lock_guard lock(mutex_);
    Senders senders = gate_.senders();
    senders.received = received_;
    senders.others = others_;
    return senders;
  }
  std::uint64_t dropped() const override {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }
  void setGround(std::shared_ptr<const GroundHeights> ground) override { desk_.setGround(std::move(ground)); }
  Questions questions() const override {
    Questions questions = desk_.questions();
    questions.nowhereToAnswer = questions.asked > 0 && !reply_;
    return questions;
  }
  void tap(std::function<void(const Datagram&)> tap) override {
    const std::lock_guard lock(tapMutex_);
    tap_ = std::move(tap);
  }

 private:
  void run();
  bool receiveOne();
  void accept(std::span<const std::byte> bytes, double kernelTime);
  void sendStartOfFrame();

  Descriptor socket_, stop_;
  std::uint16_t port_;
  std::optional<Reply> reply_;
  Clock::duration replyPeriod_;
  std::function<void()> wake_;

  // Only the receiver's thread uses these.
  HostDecoder decoder_;
  std::array<std::byte, 65536> buffer_;
  Address sender_;
  std::string from_;
  std::uint32_t igFrame_ = 0;
  std::vector<TerrainQuery> queries_;

  TerrainDesk desk_;
  std::mutex tapMutex_;
  std::function<void(const Datagram&)> tap_;

  mutable std::mutex mutex_;
  std::vector<ReceivedState> queue_;
  std::size_t oldest_ = 0;
  std::uint64_t dropped_ = 0;
  HostStatistics statistics_;
  std::vector<HostStatistics> others_;
  std::uint64_t received_ = 0;
  Gate gate_;

  std::thread thread_;
};

void UdpReceiver::run() {
  raisePriority();
  std::array<pollfd, 2> polled{{{socket_.get(), POLLIN, 0}, {stop_.get(), POLLIN, 0}}};
  const auto begin = Clock::now();
  Clock::duration due{0};
  for (;;) {
    timespec wait{};
    if (reply_) {
      const auto elapsed = Clock::now() - begin;
      if (elapsed >= due) {
        sendStartOfFrame();
        // Replies are due at absolute times; those that were missed are not made up for.
        due = (elapsed / replyPeriod_ + 1) * replyPeriod_;
      }
      const auto left = std::chrono::nanoseconds(due - (Clock::now() - begin)).count();
      wait.tv_sec = left > 0 ? left / 1000000000 : 0;
      wait.tv_nsec = left > 0 ? left % 1000000000 : 0;
    }
    const int ready = ::ppoll(polled.data(), polled.size(), reply_ ? &wait : nullptr, nullptr);
    // The system may be short of memory for a moment; a thread that ended would look like a silent host.
    constexpr auto kAfterFailure = std::chrono::milliseconds(10);
    if (ready < 0 && errno != EINTR) std::this_thread::sleep_for(kAfterFailure);
    if (ready <= 0) continue;
    if (polled[1].revents != 0) return;
    // A flood must not keep Start of Frame or the end waiting.
    constexpr int kAtOnce = 256;
    for (int i = 0; i < kAtOnce && receiveOne(); ++i) {
    }
  }
}

bool UdpReceiver::receiveOne() {
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(in6_pktinfo))> control;
  Address sender;
  iovec data{buffer_.data(), buffer_.size()};
  msghdr message{};
  message.msg_name = &sender.storage;
  message.msg_namelen = sender.size;
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t length = ::recvmsg(socket_.get(), &message, MSG_DONTWAIT);
  if (length < 0) return errno == EINTR;
  sender.size = message.msg_namelen;
  double kernelTime = 0;
  Address to;
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_PKTINFO) {
      in_pktinfo info{};
      std::memcpy(&info, CMSG_DATA(c), sizeof info);
      auto& to4 = reinterpret_cast<sockaddr_in&>(to.storage);
      to4.sin_family = AF_INET;
      to4.sin_addr = info.ipi_addr;
    }
    if (c->cmsg_level == IPPROTO_IPV6 && c->cmsg_type == IPV6_PKTINFO) {
      in6_pktinfo info{};
      std::memcpy(&info, CMSG_DATA(c), sizeof info);
      auto& to6 = reinterpret_cast<sockaddr_in6&>(to.storage);
      to6.sin6_family = AF_INET6;
      to6.sin6_addr = info.ipi6_addr;
    }
    if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec stamp{};
    std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
    kernelTime = seconds(stamp);
  }
  {
    const std::lock_guard lock(mutex_);
    if (!gate_.isOpenTo(sender, to)) return true;
  }
  if (from_.empty() || sender.size != sender_.size ||
      std::memcmp(&sender.storage, &sender_.storage, sender.size) != 0) {
    sender_ = sender;
    from_ = addressText(sender);
  }
  accept(std::span(buffer_).first(static_cast<std::size_t>(length)), kernelTime > 0 ? kernelTime : now());
  return true;
}

void UdpReceiver::accept(std::span<const std::byte> bytes, double kernelTime) {
  const Datagram datagram{bytes, kernelTime, from_};
  const auto state = decoder_.accept(datagram);
  const double decodedTime = now();
  decoder_.takeQueries(queries_);
  if (!queries_.empty()) desk_.ask(queries_, reply_.has_value());
  queries_.clear();
  {
    const std::lock_guard lock(tapMutex_);
    if (tap_) tap_(datagram);
  }
  {
    const std::lock_guard lock(mutex_);
    if (decoder_.understood()) gate_.heardGood(sender_);
    statistics_ = decoder_.statistics();
    others_ = decoder_.otherSenders();
    received_ = decoder_.received();
    if (state) {
      const ReceivedState received{*state, kernelTime, decodedTime, decoder_.symbols()};
      if (queue_.size() < kQueue) {
        queue_.push_back(received);
      } else {
        queue_[oldest_] = received;
        oldest_ = (oldest_ + 1) % kQueue;
        ++dropped_;
      }
    }
  }
  if (state && wake_) wake_();
}

void UdpReceiver::sendStartOfFrame() {
  const ByteOrder order = decoder_.hostOrder();
  const bool is4 = decoder_.hostProtocol() == WireProtocol::cigi4;
  const auto encode = is4 ? encodeCigi4StartOfFrame : encodeCigiStartOfFrame;
  auto bytes = encode(++igFrame_, decoder_.lastHostFrame().value_or(0), now(), order);
  // Requests of CIGI 4 are not read, so nothing is asked there.
  if (!is4) desk_.takeAnswers(bytes, igFrame_, order);
  // A host that is not there yet is no reason to stop.
  const int socket = reply_->socket.get() >= 0 ? reply_->socket.get() : socket_.get();
  static_cast<void>(::sendto(socket, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                             reply_->to.raw(), reply_->to.size));
}

}  // namespace

double now() {
  timespec t{};
  ::clock_gettime(CLOCK_REALTIME, &t);
  return seconds(t);
}

void raisePriority() {
  sched_param lowest{};
  lowest.sched_priority = ::sched_get_priority_min(SCHED_RR);
  static_cast<void>(::pthread_setschedparam(::pthread_self(), SCHED_RR, &lowest));
}

Result<std::unique_ptr<Receiver>> Receiver::open(const ReceiverOptions& options) {
  const std::string where = "udp " + options.bindAddress + ':' + std::to_string(options.port);
  const auto failure = [&where](const std::string& expected, const std::string& found) {
    return Finding{Severity::error, where, "", expected, found};
  };
  if (!(options.replyRateHz >= 1e-3 && options.replyRateHz <= 10000))
    return failure("a reply rate of 0.001..10000 Hz", std::to_string(options.replyRateHz));
  const auto own = resolve({options.bindAddress, options.port});
  if (!own) return own.findings();
  std::optional<Address> group;
  if (!options.group.empty()) {
    auto resolved = resolveGroup(options.group, options.port, where);
    if (!resolved) return resolved.findings();
    group = *resolved;
  }
  auto gate = Gate::open(options.sender, group);
  if (!gate) return gate.findings();
  // Each member of a group gets every datagram. They are addressed to the group, so a socket that is bound to
  // the interface's own address would get none.
  Address address = group ? anyAddress(group->family(), options.port) : *own;
  Descriptor socket(::socket(address.family(), SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  Descriptor stop(::eventfd(0, EFD_CLOEXEC));
  if (socket.get() < 0 || stop.get() < 0) return failure("a UDP socket", std::strerror(errno));
  std::optional<Reply> reply;
  if (options.reply) {
    const auto resolved = resolve(*options.reply);
    if (!resolved) return resolved.findings();
    const bool sameFamily = resolved->family() == address.family();
    reply = Reply{*resolved,
                  Descriptor(sameFamily ? -1 : ::socket(resolved->family(), SOCK_DGRAM | SOCK_CLOEXEC, 0))};
  }
  const int on = 1, off = 0, room = 4 << 20;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
  // Every interface means every host, also those of IPv4.
  if (address.family() == AF_INET6) ::setsockopt(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, &off, sizeof off);
  if (group) {
    ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    const Result<Done> joined = join(socket.get(), *group, *own, where);
    if (!joined) return joined.findings();
  }  // else without SO_REUSEADDR: two receivers on one port would share its datagrams, and neither would know
  if (::bind(socket.get(), address.raw(), address.size) != 0) {
    const std::string port = std::to_string(options.port);
    if (errno == EADDRINUSE) return failure("a free port", "port " + port + " is taken by another program");
    return failure("port " + port + " at " + options.bindAddress, std::strerror(errno));
  }
  address.size = sizeof address.storage;
  if (::getsockname(socket.get(), address.raw(), &address.size) != 0)
    return failure("the number of the port", std::strerror(errno));
  return std::unique_ptr<Receiver>(std::make_unique<UdpReceiver>(std::move(socket), std::move(stop),
                                                                 address.port(), options, std::move(reply),
                                                                 std::move(gate).value()));
}

}  // namespace trimtab::link
