#pragma once

#include <netinet/in.h>
#include <unistd.h>

#include <string>
#include <utility>

#include "link.h"

namespace trimtab::link {

/// A file descriptor that is closed once.
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

/// An IPv4 address, or a name looked up (may wait for a name server).
Result<sockaddr_in> resolve(const Endpoint& endpoint);
std::string addressText(const sockaddr_in& address);
/// The calling thread before others where the system lets us; without the right to, it stays as it is.
void raisePriority();

}  // namespace trimtab::link
