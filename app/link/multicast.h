#pragma once

#include <string>

#include "socket.h"

namespace trimtab::link {

/// Reads the address of a multicast group of IPv4 or IPv6. `where` names the receiver in findings.
Result<Address> resolveGroup(const std::string& group, std::uint16_t port, const std::string& where);
/// Joins a group on the interface that has the address `own`, and takes datagrams of groups that this socket
/// joined only. A group of IPv6 may name its interface instead: ff15::7%eth0.
Result<Done> join(int socket, const Address& group, const Address& own, const std::string& where);
/// Returns the address of every interface.
Address anyAddress(int family, std::uint16_t port);

}  // namespace trimtab::link
