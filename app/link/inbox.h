#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

#include "trimtab/host/flight.h"

namespace trimtab::link {

/// Takes datagrams on the receiver's thread and hands them to the thread that writes, so that a slow disk
/// does not hold the receiver up. It keeps at most so many bytes of them and drops what comes beyond.
class Inbox {
 public:
  explicit Inbox(std::size_t mostBytes) : mostBytes_(mostBytes) {}

  void put(CapturedDatagram datagram) {
    const std::lock_guard lock(mutex_);
    if (datagram.bytes.size() > mostBytes_ - bytes_) {
      ++dropped_;
      return;
    }
    bytes_ += datagram.bytes.size();
    datagrams_.push_back(std::move(datagram));
  }
  /// Returns what came since the last call, in its order.
  std::vector<CapturedDatagram> take() {
    const std::lock_guard lock(mutex_);
    bytes_ = 0;
    return std::exchange(datagrams_, {});
  }
  std::uint64_t dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
  }

 private:
  const std::size_t mostBytes_;
  mutable std::mutex mutex_;
  std::vector<CapturedDatagram> datagrams_;
  std::size_t bytes_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace trimtab::link
