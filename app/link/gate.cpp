#include "gate.h"

#include <cstring>

namespace trimtab::link {
namespace {

bool sameHost(const Address& a, const Address& b) {
  const in6_addr x = a.host(), y = b.host();
  return std::memcmp(&x, &y, sizeof x) == 0;
}

}  // namespace

Result<Gate> Gate::open(const std::string& allowed, const std::optional<Address>& group) {
  Gate gate;
  gate.senders_.allowed = allowed;
  gate.group_ = group;
  if (allowed == kAnyone || allowed == kFirst) return gate;
  // A port after the address, as in 10.0.0.5:5500 or [::1]:5500, names one of several hosts on that machine.
  const bool isAddress6 = allowed.find(':') != allowed.rfind(':') && allowed.front() != '[';
  gate.portMatters_ = !isAddress6 && allowed.find(':') != std::string::npos;
  Endpoint asked{allowed, 0};
  if (gate.portMatters_) {
    const auto parsed = parseEndpoint(allowed);
    if (!parsed) return parsed.findings();
    asked = *parsed;
  }
  const auto resolved = resolve(asked);
  if (!resolved) return resolved.findings();
  gate.only_ = *resolved;
  return gate;
}

bool Gate::isOpenTo(const Address& sender, const Address& to) {
  // A member of a group is bound to every interface, and listens to no one who addresses it directly from
  // elsewhere.
  const bool addressed = !group_ || sameHost(to, *group_) || to.isLoopback();
  const bool allowed =
      !only_ || (sameHost(sender, *only_) && (!portMatters_ || sender.port() == only_->port()));
  if (addressed && allowed) return true;
  ++senders_.refused;
  senders_.lastRefused = addressText(sender);
  return false;
}

void Gate::heardGood(const Address& sender) {
  if (only_ || senders_.allowed != kFirst) return;
  only_ = sender;
  senders_.allowed = addressText(sender);
  senders_.allowed.erase(senders_.allowed.rfind(':'));
}

}  // namespace trimtab::link
