#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "link.h"

namespace trimtab::link {

/// Says why datagrams lead to no image while a program listens: refused ones, ones for someone else, a port
/// where two hosts send, senders that are not allowed, a host whose own datagrams lead to nothing new, and a
/// port where nothing arrives. It also says what of a host is not used: refused packets, types that are not
/// read, other views, a frame number that stands still, questions that nobody can answer. It says one thing
/// at a time, the first at once and others at most every kPeriodS; what was never said comes first.
class LinkWatch {
 public:
  static constexpr double kPeriodS = 10;
  /// A program that sleeps looks again after so many seconds.
  static constexpr double kLookS = 0.5;

  /// `address` is the own one, which the receiver listens at.
  LinkWatch(std::uint16_t port, std::string address) : port_(port), address_(std::move(address)) {}

  /// Returns the line that is due at `now`, in seconds on any clock: how many of how many datagrams, the
  /// newest sender, what was expected and found, and what to do. Returns none as long as nothing is new since
  /// what was said last. The seconds without a datagram count from the first call.
  std::optional<std::string> look(const Receiver& receiver, double now) {
    return look(receiver.statistics(), receiver.senders(), receiver.questions(), now);
  }
  std::optional<std::string> look(const HostStatistics& followed, const Senders& senders,
                                  const Questions& questions, double now);

 private:
  struct Reason {
    std::string what;             ///< with its sender: tells it from other reasons
    std::uint64_t datagrams = 0;  ///< or whatever says that it is news again
    std::string text;
  };
  std::vector<Reason> reasons(const HostStatistics& followed, const Senders& senders, double now) const;
  static void addUnused(std::vector<Reason>& all, const HostStatistics& followed, const Questions& questions);

  std::uint16_t port_;
  std::string address_;
  std::optional<double> begin_, saidAt_;
  double stateAt_ = 0;                         ///< when the followed host's datagrams last led to a state
  std::map<std::string, std::uint64_t> said_;  ///< datagrams of a reason when it was said last
};

}  // namespace trimtab::link
