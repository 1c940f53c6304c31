#pragma once

#include <netinet/in.h>
#include <unistd.h>

#include <string>
#include <utility>

#include "link.h"

namespace trimtab::link {

/// Owns a file descriptor and closes it.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  int get() const { return fd_; }

 private:
  int fd_;
};

/// An address of IPv4 or IPv6 with its port.
struct Address {
  sockaddr_storage storage{};
  socklen_t size = sizeof(sockaddr_storage);

  int family() const { return storage.ss_family; }
  sockaddr* raw() { return reinterpret_cast<sockaddr*>(&storage); }
  const sockaddr* raw() const { return reinterpret_cast<const sockaddr*>(&storage); }
  std::uint16_t port() const;
  /// Returns the address without its port as IPv6, where IPv4 has a place of its own (::ffff:0:0/96): equal
  /// addresses are equal whatever socket they came from.
  in6_addr host() const;
  bool isLoopback() const;
  bool isMulticast() const;
};

/// Returns the address of an endpoint; IPv4 if a name has both. A host name is looked up, which may wait for
/// a name server. An IPv6 address may name its interface: fe80::1%eth0.
Result<Address> resolve(const Endpoint& endpoint);
/// Returns "127.0.0.1:5500" or "[::1]:5500"; IPv4 also for what came to a socket of IPv6.
std::string addressText(const Address& address);
/// Raises the priority of the calling thread if the system permits it; otherwise changes nothing.
void raisePriority();

}  // namespace trimtab::link
