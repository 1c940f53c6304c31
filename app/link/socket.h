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

/// Returns the IPv4 address of an endpoint. A host name is looked up, which may wait for a name server.
Result<sockaddr_in> resolve(const Endpoint& endpoint);
std::string addressText(const sockaddr_in& address);
/// Raises the priority of the calling thread if the system permits it; otherwise changes nothing.
void raisePriority();

}  // namespace trimtab::link
