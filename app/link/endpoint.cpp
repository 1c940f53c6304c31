#include <arpa/inet.h>
#include <netdb.h>

#include <charconv>
#include <cstring>

#include "link.h"
#include "socket.h"
#include "trimtab/host/protocol_names.h"

namespace trimtab::link {
namespace {

Finding refusal(const std::string& text, std::string expected, std::string found) {
  return {Severity::error, text, "", std::move(expected), std::move(found)};
}

template <class T>
const T& as(const Address& address) {
  return reinterpret_cast<const T&>(address.storage);
}

}  // namespace

std::vector<std::string> protocolOptions(bool toReceive) {
  std::vector<std::string> options;
  if (toReceive) options.emplace_back("auto");
  for (const ProtocolName& name : kProtocols)
    if (toReceive || name.sent) options.emplace_back(name.option);
  return options;
}

Result<Endpoint> parseEndpoint(const std::string& text) {
  constexpr const char* kForm = "HOST:PORT or PORT, such as 127.0.0.1:8004 or [::1]:8004";
  Endpoint endpoint;
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  if (colon != std::string::npos) endpoint.address = text.substr(0, colon);
  const std::string& host = endpoint.address;
  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (bracketed) endpoint.address = host.substr(1, host.size() - 2);
  unsigned number = 0;
  const auto [end, failed] = std::from_chars(port.data(), port.data() + port.size(), number);
  const bool named = !endpoint.address.empty() && endpoint.address.front() != '[';
  if (failed != std::errc{} || end != port.data() + port.size() || !named)
    return refusal(text, kForm, "'" + text + "'");
  if (!bracketed && endpoint.address.find(':') != std::string::npos)
    return refusal(text, "an IPv6 address in brackets, such as [::1]:8004", "'" + text + "'");
  if (number < 1 || number > 65535) return refusal(text, "a port in 1..65535", std::to_string(number));
  endpoint.port = static_cast<std::uint16_t>(number);
  return endpoint;
}

std::uint16_t Address::port() const {
  return ntohs(family() == AF_INET6 ? as<sockaddr_in6>(*this).sin6_port : as<sockaddr_in>(*this).sin_port);
}

in6_addr Address::host() const {
  if (family() == AF_INET6) return as<sockaddr_in6>(*this).sin6_addr;
  in6_addr mapped{};
  mapped.s6_addr[10] = mapped.s6_addr[11] = 0xff;
  std::memcpy(&mapped.s6_addr[12], &as<sockaddr_in>(*this).sin_addr, 4);
  return mapped;
}

bool Address::isLoopback() const {
  const in6_addr address = host();
  constexpr std::uint8_t kLoopback = 127;
  return IN6_IS_ADDR_V4MAPPED(&address) ? address.s6_addr[12] == kLoopback
                                        : IN6_IS_ADDR_LOOPBACK(&address) != 0;
}

bool Address::isMulticast() const {
  const in6_addr address = host();
  if (!IN6_IS_ADDR_V4MAPPED(&address)) return IN6_IS_ADDR_MULTICAST(&address) != 0;
  return (address.s6_addr[12] & 0xf0U) == 0xe0U;
}

Result<Address> resolve(const Endpoint& endpoint) {
  const std::string port = std::to_string(endpoint.port);
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  int failed = 0;
  for (const int family : {AF_INET, AF_INET6}) {
    hints.ai_family = family;
    addrinfo* found = nullptr;
    failed = getaddrinfo(endpoint.address.c_str(), port.c_str(), &hints, &found);
    if (failed != 0 || !found) continue;
    Address address;
    address.size = found->ai_addrlen;
    std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
    freeaddrinfo(found);
    return address;
  }
  return refusal(endpoint.address, "the address of a host", failed != 0 ? gai_strerror(failed) : "none");
}

std::string addressText(const Address& address) {
  char text[INET6_ADDRSTRLEN] = "?";
  const in6_addr host = address.host();
  const bool is4 = IN6_IS_ADDR_V4MAPPED(&host);
  inet_ntop(is4 ? AF_INET : AF_INET6, is4 ? static_cast<const void*>(&host.s6_addr[12]) : &host, text,
            sizeof text);
  const std::string port = ':' + std::to_string(address.port());
  return is4 ? text + port : '[' + std::string(text) + ']' + port;
}

}  // namespace trimtab::link
