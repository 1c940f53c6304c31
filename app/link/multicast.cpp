#include "multicast.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <cerrno>
#include <cstring>

namespace trimtab::link {
namespace {

/// Returns the number of the interface with the address `own`; 0, the system's choice, if there is none.
unsigned interfaceOf(const Address& own) {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return 0;
  unsigned index = 0;
  const in6_addr wanted = own.host();
  for (const ifaddrs* each = all; each != nullptr && index == 0; each = each->ifa_next) {
    if (each->ifa_addr == nullptr) continue;
    const int family = each->ifa_addr->sa_family;
    if (family != AF_INET && family != AF_INET6) continue;
    Address address;
    std::memcpy(&address.storage, each->ifa_addr,
                family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6));
    const in6_addr host = address.host();
    if (std::memcmp(&host, &wanted, sizeof host) == 0) index = ::if_nametoindex(each->ifa_name);
  }
  ::freeifaddrs(all);
  return index;
}

/// Returns whether the system did what was asked, of a socket that hears only the groups that it joined.
bool joined4(int socket, const Address& group, const Address& own) {
  ip_mreqn request{};
  request.imr_multiaddr = reinterpret_cast<const sockaddr_in&>(group.storage).sin_addr;
  request.imr_ifindex = static_cast<int>(interfaceOf(own));
  if (own.family() == AF_INET)
    request.imr_address = reinterpret_cast<const sockaddr_in&>(own.storage).sin_addr;
  const int off = 0, on = 1;
  ::setsockopt(socket, IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof off);
  ::setsockopt(socket, IPPROTO_IP, IP_PKTINFO, &on, sizeof on);
  return ::setsockopt(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof request) == 0;
}

bool joined6(int socket, const Address& group, const Address& own) {
  const auto& wanted = reinterpret_cast<const sockaddr_in6&>(group.storage);
  ipv6_mreq request{};
  request.ipv6mr_multiaddr = wanted.sin6_addr;
  request.ipv6mr_interface = wanted.sin6_scope_id != 0 ? wanted.sin6_scope_id : interfaceOf(own);
  const int off = 0, on = 1;
  ::setsockopt(socket, IPPROTO_IPV6, IPV6_MULTICAST_ALL, &off, sizeof off);
  ::setsockopt(socket, IPPROTO_IPV6, IPV6_RECVPKTINFO, &on, sizeof on);
  return ::setsockopt(socket, IPPROTO_IPV6, IPV6_JOIN_GROUP, &request, sizeof request) == 0;
}

}  // namespace

Result<Address> resolveGroup(const std::string& group, std::uint16_t port, const std::string& where) {
  const std::size_t scope = group.find('%');
  in6_addr any{};
  const bool isNumber = ::inet_pton(AF_INET, group.c_str(), &any) == 1 ||
                        ::inet_pton(AF_INET6, group.substr(0, scope).c_str(), &any) == 1;
  // A name that some server knows is no group.
  if (isNumber)
    if (auto resolved = resolve({group, port}); resolved && resolved->isMulticast()) return resolved;
  return Finding{Severity::error, where, "", "a multicast group, 224.0.0.0 to 239.255.255.255 or ff00::/8",
                 group};
}

Result<Done> join(int socket, const Address& group, const Address& own, const std::string& where) {
  const bool joined = group.family() == AF_INET6 ? joined6(socket, group, own) : joined4(socket, group, own);
  if (joined) return Done{};
  std::string name = addressText(group);
  name.erase(name.rfind(':'));
  return Finding{Severity::error, where, "", "to join the group " + name, std::strerror(errno)};
}

Address anyAddress(int family, std::uint16_t port) {
  Address address;
  address.storage.ss_family = static_cast<sa_family_t>(family);
  if (family == AF_INET6) {
    reinterpret_cast<sockaddr_in6&>(address.storage).sin6_port = htons(port);
    address.size = sizeof(sockaddr_in6);
  } else {
    reinterpret_cast<sockaddr_in&>(address.storage).sin_port = htons(port);
    address.size = sizeof(sockaddr_in);
  }
  return address;
}

}  // namespace trimtab::link
