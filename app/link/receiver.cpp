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

#include "socket.h"
#include "trimtab/host/encoder.h"
#include "trimtab/host/received_state.h"

namespace trimtab::link {
namespace {

constexpr std::size_t kQueue = 4096;  // over a minute at 60 Hz

using Clock = std::chrono::steady_clock;

double seconds(const timespec& t) {
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

/// Lets through whom the options allow.
class Gate {
 public:
  Gate(const std::string& allowed, std::optional<in_addr> address, std::optional<in_addr> group)
      : address_(address), group_(group) {
    senders_.allowed = allowed;
  }
  /// `to`: where the datagram was addressed to.
  bool isOpenTo(const sockaddr_in& sender, const in_addr& to) {
    // A member of a group is bound to every interface, and listens to no one who addresses it directly from
    // elsewhere.
    constexpr std::uint32_t kLoopback = 127;
    const bool addressed = !group_ || to.s_addr == group_->s_addr || ntohl(to.s_addr) >> 24U == kLoopback;
    if (addressed && (!address_ || address_->s_addr == sender.sin_addr.s_addr)) return true;
    ++senders_.refused;
    senders_.lastRefused = addressText(sender);
    return false;
  }
  /// A stray datagram that means nothing must not shut the host out, so only good ones count.
  void heardGood(const sockaddr_in& sender) {
    if (address_ || senders_.allowed != kFirst) return;
    address_ = sender.sin_addr;
    senders_.allowed = addressText(sender);
    senders_.allowed.erase(senders_.allowed.rfind(':'));
  }
  const Senders& senders() const { return senders_; }

 private:
  std::optional<in_addr> address_;  ///< the only one that is allowed
  std::optional<in_addr> group_;
  Senders senders_;
};

class UdpReceiver final : public Receiver {
 public:
  UdpReceiver(Descriptor socket, Descriptor stop, std::uint16_t port, const ReceiverOptions& options,
              std::optional<sockaddr_in> reply, Gate gate)
      : socket_(std::move(socket)),
        stop_(std::move(stop)),
        port_(port),
        reply_(reply),
        replyPeriod_(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(1 / options.replyRateHz))),
        wake_(options.wake),
        decoder_(options.protocol, options.entity),
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
  std::optional<sockaddr_in> reply_;
  Clock::duration replyPeriod_;
  std::function<void()> wake_;

  // Only the receiver's thread uses these.
  HostDecoder decoder_;
  std::array<std::byte, 65536> buffer_;
  sockaddr_in sender_{};
  std::string from_;
  std::uint32_t igFrame_ = 0;

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
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(in_pktinfo))> control;
  sockaddr_in sender{};
  iovec data{buffer_.data(), buffer_.size()};
  msghdr message{};
  message.msg_name = &sender;
  message.msg_namelen = sizeof sender;
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t length = ::recvmsg(socket_.get(), &message, MSG_DONTWAIT);
  if (length < 0) return errno == EINTR;
  double kernelTime = 0;
  in_addr to{};
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level == IPPROTO_IP && c->cmsg_type == IP_PKTINFO) {
      in_pktinfo info{};
      std::memcpy(&info, CMSG_DATA(c), sizeof info);
      to = info.ipi_addr;
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
  if (sender.sin_addr.s_addr != sender_.sin_addr.s_addr || sender.sin_port != sender_.sin_port ||
      from_.empty()) {
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
  const auto encode =
      decoder_.hostProtocol() == WireProtocol::cigi4 ? encodeCigi4StartOfFrame : encodeCigiStartOfFrame;
  const auto bytes = encode(++igFrame_, decoder_.lastHostFrame().value_or(0), now(), decoder_.hostOrder());
  // A host that is not there yet is no reason to stop.
  static_cast<void>(::sendto(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                             reinterpret_cast<const sockaddr*>(&*reply_), sizeof *reply_));
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

/// Joins a group on one interface, and takes datagrams of groups that this socket joined only.
static Result<Done> join(int socket, const std::string& group, const in_addr& onInterface,
                         const std::string& where) {
  ip_mreq request{};
  request.imr_interface = onInterface;
  const bool read = inet_pton(AF_INET, group.c_str(), &request.imr_multiaddr) == 1;
  if (!read || !IN_MULTICAST(ntohl(request.imr_multiaddr.s_addr)))
    return Finding{Severity::error, where, "", "a multicast group, 224.0.0.0 to 239.255.255.255", group};
  const int off = 0;
  ::setsockopt(socket, IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof off);
  if (::setsockopt(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) != 0)
    return Finding{Severity::error, where, "", "to join the group " + group, std::strerror(errno)};
  return Done{};
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
  std::optional<sockaddr_in> reply;
  if (options.reply) {
    const auto resolved = resolve(*options.reply);
    if (!resolved) return resolved.findings();
    reply = *resolved;
  }
  std::optional<in_addr> only;
  if (options.sender != kAnyone && options.sender != kFirst) {
    const auto resolved = resolve({options.sender, 0});
    if (!resolved) return resolved.findings();
    only = resolved->sin_addr;
  }
  Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  Descriptor stop(::eventfd(0, EFD_CLOEXEC));
  if (socket.get() < 0 || stop.get() < 0) return failure("a UDP socket", std::strerror(errno));
  const int on = 1, room = 4 << 20;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
  ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &room, sizeof room);
  sockaddr_in address = *own;
  std::optional<in_addr> group;
  if (options.group.empty()) {
    // The socket is opened without SO_REUSEADDR: two receivers on one port would share its datagrams, and
    // neither would know.
  } else {
    // Each member of a group gets every datagram. They are addressed to the group, so a socket that is bound
    // to the interface's own address would get none.
    ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    address.sin_addr.s_addr = htonl(INADDR_ANY);
    const Result<Done> joined = join(socket.get(), options.group, own->sin_addr, where);
    if (!joined) return joined.findings();
    group.emplace();
    static_cast<void>(inet_pton(AF_INET, options.group.c_str(), &*group));
    ::setsockopt(socket.get(), IPPROTO_IP, IP_PKTINFO, &on, sizeof on);
  }
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const std::string port = std::to_string(options.port);
    if (errno == EADDRINUSE) return failure("a free port", "port " + port + " is taken by another program");
    return failure("port " + port + " at " + options.bindAddress, std::strerror(errno));
  }
  socklen_t size = sizeof address;
  if (::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0)
    return failure("the number of the port", std::strerror(errno));
  return std::unique_ptr<Receiver>(std::make_unique<UdpReceiver>(std::move(socket), std::move(stop),
                                                                 ntohs(address.sin_port), options, reply,
                                                                 Gate(options.sender, only, group)));
}

}  // namespace trimtab::link
