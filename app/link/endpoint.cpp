#include <arpa/inet.h>
#include <netdb.h>

#include <charconv>

#include "link.h"
#include "socket.h"
#include "trimtab/host/protocol_names.h"

namespace trimtab::link {
namespace {

Finding refusal(const std::string& text, std::string expected, std::string found) {
  return {Severity::error, text, "", std::move(expected), std::move(found)};
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
  constexpr const char* kForm = "HOST:PORT or PORT, such as 127.0.0.1:8004";
  Endpoint endpoint;
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  if (colon != std::string::npos) endpoint.address = text.substr(0, colon);
  unsigned number = 0;
  const auto [end, failed] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (failed != std::errc{} || end != port.data() + port.size() || endpoint.address.empty())
    return refusal(text, kForm, "'" + text + "'");
  if (number < 1 || number > 65535) return refusal(text, "a port in 1..65535", std::to_string(number));
  endpoint.port = static_cast<std::uint16_t>(number);
  if (endpoint.address.find(':') != std::string::npos)
    return refusal(text, "an IPv4 address or a host name", endpoint.address);
  return endpoint;
}

Result<sockaddr_in> resolve(const Endpoint& endpoint) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(endpoint.port);
  if (inet_pton(AF_INET, endpoint.address.c_str(), &address.sin_addr) == 1) return address;
  addrinfo hints{}, *found = nullptr;
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_DGRAM;
  const int failed = getaddrinfo(endpoint.address.c_str(), nullptr, &hints, &found);
  if (failed != 0 || !found)
    return refusal(endpoint.address, "the address of a host", failed != 0 ? gai_strerror(failed) : "none");
  address.sin_addr = reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr;
  freeaddrinfo(found);
  return address;
}

std::string addressText(const sockaddr_in& address) {
  char text[INET_ADDRSTRLEN] = "?";
  inet_ntop(AF_INET, &address.sin_addr, text, sizeof text);
  return std::string(text) + ':' + std::to_string(ntohs(address.sin_port));
}

}  // namespace trimtab::link
