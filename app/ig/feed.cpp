#include "feed.h"

#include <algorithm>
#include <iostream>
#include <limits>
#include <string>
#include "app/link/link.h"
#include "app/link/link_watch.h"
#include "app/link/log_options.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/received_state.h"

namespace trimtab::ig {
namespace {

class FlightFeed : public Feed {
 public:
  explicit FlightFeed(Flight flight) : flight_(std::move(flight)) {}
  bool advance(Session& session, double) override {
    if (finished()) return false;
    session.fly(flight_.states[next_++]);
    return true;
  }
  double dueIn(double) const override { return 0; }
  bool finished() const override { return next_ >= flight_.states.size(); }

 private:
  Flight flight_;
  std::size_t next_ = 0;
};

class TraceFeed : public Feed {
 public:
  explicit TraceFeed(std::vector<TraceRow> rows) : rows_(std::move(rows)) {}
  bool advance(Session& session, double) override {
    if (finished()) return false;
    session.replay(rows_[next_++]);
    return true;
  }
  double dueIn(double) const override { return 0; }
  bool finished() const override { return next_ >= rows_.size(); }

 private:
  std::vector<TraceRow> rows_;
  std::size_t next_ = 0;
};

/// Rows become packets that arrive at their times, counted from the first call.
class RealtimeFeed : public Feed {
 public:
  explicit RealtimeFeed(Flight flight) : flight_(std::move(flight)) {}
  bool advance(Session& session, double now) override {
    if (finished()) return false;
    if (!start_) start_ = now;
    due_.clear();
    while (!finished() && dueAt(next_) <= now) {
      due_.push_back({flight_.states[next_], dueAt(next_), dueAt(next_)});
      ++next_;
    }
    session.receive(due_);
    return !due_.empty();
  }
  double dueIn(double now) const override {
    return start_ && !finished() ? std::max(0.0, dueAt(next_) - now) : 0;
  }
  bool finished() const override { return next_ >= flight_.states.size(); }

 private:
  double dueAt(std::size_t i) const {
    return *start_ + (flight_.states[i].time - flight_.states.front().time);
  }

  Flight flight_;
  std::size_t next_ = 0;
  std::optional<double> start_;
  std::vector<ReceivedState> due_;
};

class LinkFeed : public Feed {
 public:
  LinkFeed(std::unique_ptr<link::Receiver> receiver, std::string address)
      : receiver_(std::move(receiver)), address_(std::move(address)), watch_(receiver_->port(), address_) {}
  bool advance(Session& session, double) override {
    states_.clear();
    receiver_->take(states_);
    session.receive(states_);
    return !states_.empty();
  }
  double dueIn(double) const override { return std::numeric_limits<double>::infinity(); }
  bool finished() const override { return false; }
  void ready() const override {
    // Written in one piece, for whoever waits for the line.
    std::cerr << "listening on UDP port " + std::to_string(receiver_->port()) + " of " + address_ +
                     ", sender: " + receiver_->senders().allowed + "\n"
              << std::flush;
  }
  std::optional<HostStatistics> statistics() const override { return receiver_->statistics(); }
  std::optional<link::Senders> senders() const override { return receiver_->senders(); }
  std::uint64_t dropped() const override { return receiver_->dropped(); }
  link::Questions questions() const override { return receiver_->questions(); }
  void setGround(std::shared_ptr<const GroundHeights> ground) override {
    receiver_->setGround(std::move(ground));
  }
  std::optional<std::string> complaint(double now) override { return watch_.look(*receiver_, now); }

 private:
  std::unique_ptr<link::Receiver> receiver_;
  std::string address_;  ///< that it is bound to
  link::LinkWatch watch_;
  std::vector<ReceivedState> states_;
};

Result<std::unique_ptr<Feed>> openFlight(const Options& options) {
  const auto empty = [&options] {
    return Finding{Severity::error, options.flight.string(), {}, "at least one row", "none"};
  };
  if (!options.realtime && isTraceFile(options.flight)) {
    Result<std::vector<TraceRow>> rows = readTrace(options.flight);
    if (!rows) return rows.findings();
    if (rows->empty()) return empty();
    Findings notes = rows.findings();
    return {std::make_unique<TraceFeed>(std::move(rows).value()), std::move(notes)};
  }
  Result<Flight> flight = link::openFlightOption(options.flight.string(), options.columns);
  if (!flight) return flight.findings();
  if (flight->states.empty()) return empty();
  Findings notes = flight.findings();
  if (options.realtime) return {std::make_unique<RealtimeFeed>(std::move(flight).value()), std::move(notes)};
  return {std::make_unique<FlightFeed>(std::move(flight).value()), std::move(notes)};
}

}  // namespace

Result<HeadInput> openHeadInput(const Options& options) {
  HeadInput head;
  if (options.head.empty()) return head;
  if (!options.listen && !options.realtime && isTraceFile(options.flight))
    return Finding{Severity::error,
                   "--head",
                   {},
                   "a flight, or a trace with --realtime",
                   options.flight.string() + ", a trace that brings its heads"};
  Result<HeadLog> log = link::openHeadOption(options.head, options.skipBadRows, options.headColumns);
  if (!log) return log.findings();
  Findings notes = log.findings();
  head.useLog(std::move(log).value());
  return {std::move(head), std::move(notes)};
}

Result<std::unique_ptr<Feed>> openFeed(const Options& options, const HostParameters& host, const Wake& wake) {
  if (!options.listen) return openFlight(options);
  link::ReceiverOptions receiver;
  receiver.port = *options.listen;
  receiver.bindAddress = options.bindAddress;
  receiver.group = options.group;
  receiver.sender = options.sender;
  receiver.choice = HostChoice(host);
  receiver.choice.protocol = options.protocol.value_or(receiver.choice.protocol);
  receiver.choice.chooseEntity(options.entity);
  if (options.view) receiver.choice.view = options.view;
  receiver.wake = [&wake] { wake.post(); };
  if (!options.reply.empty()) {
    Result<link::Endpoint> reply = link::parseEndpoint(options.reply);
    if (!reply) return reply.findings();
    receiver.reply = *reply;
  }
  Result<std::unique_ptr<link::Receiver>> opened = link::Receiver::open(receiver);
  if (!opened) return opened.findings();
  Findings notes = opened.findings();
  return {std::make_unique<LinkFeed>(std::move(opened).value(), options.bindAddress), std::move(notes)};
}

}  // namespace trimtab::ig
