#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "link.h"
#include "socket.h"

namespace trimtab::link {

/// Lets through whom the options of a receiver allow.
class Gate {
 public:
  /// `allowed` is ReceiverOptions::sender; its address is looked up. `group` is the one that was joined.
  static Result<Gate> open(const std::string& allowed, const std::optional<Address>& group);

  /// `to`: where the datagram was addressed to; it matters for members of a group alone.
  bool isOpenTo(const Address& sender, const Address& to);
  /// Call it for every good datagram that was let through: a stray one that means nothing must not shut the
  /// host out.
  void heardGood(const Address& sender);
  const Senders& senders() const { return senders_; }

 private:
  std::optional<Address> only_;  ///< the one that is allowed
  bool portMatters_ = false;
  std::optional<Address> group_;
  Senders senders_;
};

}  // namespace trimtab::link
