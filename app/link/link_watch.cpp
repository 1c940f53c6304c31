#include "link_watch.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace trimtab::link {
namespace {

std::string number(std::uint64_t count) {
  return std::to_string(count);
}

std::string newest(const std::optional<Finding>& finding) {
  return "; the newest from " + toString(finding.value_or(Finding{}));
}

}  // namespace

std::vector<LinkWatch::Reason> LinkWatch::reasons(const HostStatistics& followed, const Senders& senders,
                                                  double now) const {
  std::vector<Reason> all;
  const auto addUnusable = [&all](const HostStatistics& s) {
    const std::string of = " of " + number(s.received) + " datagrams ";
    all.push_back({"bad " + s.from, s.bad, number(s.bad) + of + "refused" + newest(s.newestBad)});
    all.push_back({"other " + s.from, s.notForUs,
                   number(s.notForUs) + of + "are for someone else" + newest(s.newestNotForUs)});
  };
  addUnusable(followed);
  for (const HostStatistics& other : senders.others) {
    addUnusable(other);
    if (other.states > 0 && other.alongside > 1 && followed.states > 0)
      all.push_back(
          {"two " + other.from, other.alongside,
           "two hosts send: " + number(other.received) + " datagrams of " + other.from + " beside " +
               number(followed.received) + " of " + followed.from +
               ", and what both say is drawn in turn; end one, or allow one address alone (--from)"});
  }
  all.push_back({"refused", senders.refused,
                 number(senders.refused) + " datagrams of others than " + senders.allowed +
                     " thrown away; the newest from " + senders.lastRefused + "; --from says who may send"});
  const std::string time = number(static_cast<std::uint64_t>(kPeriodS)) + " s";
  if (followed.newestUnused && now - stateAt_ >= kPeriodS)
    all.push_back({"unused " + followed.from, followed.received,
                   "no new state for " + time + newest(followed.newestUnused)});
  return all;
}

/// Adds what of the followed host is passed over while its aircraft flies.
void LinkWatch::addUnused(std::vector<Reason>& all, const HostStatistics& followed,
                          const Questions& questions) {
  const std::string of = " of " + followed.from;
  all.push_back({"packets" + of, followed.refusedPackets,
                 number(followed.refusedPackets) + " packets left out, the rest of their messages is used" +
                     newest(followed.newestRefused)});
  std::string types;
  for (const IgnoredPackets& each : followed.ignored)
    types += (types.empty() ? "" : ", ") + cigiPacketName(each.id) + ' ' + number(each.count);
  all.push_back(
      {"types" + of, followed.ignored.size(), "packets" + of + " of types that are not read: " + types});
  all.push_back(
      {"uncounted" + of, followed.uncounted > 0 ? 1U : 0U,
       "the frame number" + of +
           " stands still; its messages are used as they come, and nobody can tell which are lost"});
  std::string others;
  for (const std::uint16_t view : followed.views)
    if (view != followed.view) others += (others.empty() ? "" : ", ") + std::to_string(view);
  if (followed.view && !others.empty())
    all.push_back({"views" + of, followed.views.size(),
                   "view " + std::to_string(*followed.view) + of + " is followed, of others: " + others +
                       "; --view, or host.view of the preset, chooses one"});
  if (questions.nowhereToAnswer)
    all.push_back(
        {"questions", 1,
         number(questions.asked) +
             " requests of heights or lines of sight stay without an answer; --reply HOST:PORT says "
             "where the host waits for it"});
  all.push_back({"dropped questions", questions.dropped,
                 number(questions.dropped) + " of " + number(questions.asked) +
                     " requests of heights or lines of sight came faster than they can be answered"});
}

std::optional<std::string> LinkWatch::look(const HostStatistics& followed, const Senders& senders,
                                           const Questions& questions, double now) {
  if (!begin_) begin_ = now;
  if (!followed.newestUnused) stateAt_ = now;
  if (saidAt_ && now - *saidAt_ < kPeriodS) return std::nullopt;
  const std::string port = "UDP port " + number(port_);
  if (senders.received + senders.refused == 0) {
    if (saidAt_ || now - *begin_ < kPeriodS) return std::nullopt;
    saidAt_ = now;
    std::string line =
        "nothing has arrived on " + port + " for " + number(static_cast<std::uint64_t>(kPeriodS)) + " s";
    if (address_ == kOwnMachine)
      line += "; only this machine can send to " + address_ + ", until --bind names another interface";
    return line;
  }
  std::vector<Reason> all = reasons(followed, senders, now);
  addUnused(all, followed, questions);
  std::erase_if(said_, [&all](const auto& said) {
    return std::none_of(all.begin(), all.end(), [&said](const Reason& r) { return r.what == said.first; });
  });
  const auto growth = [this](const Reason& reason) {
    const auto said = said_.find(reason.what);
    return reason.datagrams - std::min(reason.datagrams, said == said_.end() ? 0 : said->second);
  };
  const auto urgency = [&](const Reason& reason) {
    const std::uint64_t grown = growth(reason);
    return std::pair(grown > 0 && !said_.contains(reason.what), grown);
  };
  const auto most = std::max_element(
      all.begin(), all.end(), [&](const Reason& a, const Reason& b) { return urgency(a) < urgency(b); });
  if (growth(*most) == 0) return std::nullopt;
  saidAt_ = now;
  said_[most->what] = most->datagrams;
  return port + ": " + most->text;
}

}  // namespace trimtab::link
