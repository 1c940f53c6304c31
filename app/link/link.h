#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "trimtab/host/decoder.h"
#include "trimtab/host/flight.h"
#include "trimtab/host/head_log.h"
#include "trimtab/host/received_state.h"
#include "trimtab/units/result.h"

/// The UDP receiver and the UDP sender that workbench, IG and command line share.
namespace trimtab::link {

struct Endpoint {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;
};
/// Reads "host:port" or "[address of IPv6]:port"; a port alone means 127.0.0.1.
Result<Endpoint> parseEndpoint(const std::string& text);

/// Unless told otherwise, nobody on the network reaches a receiver.
inline constexpr const char *kOwnMachine = "127.0.0.1", *kAnyone = "any", *kFirst = "first";

/// Helps with the option --entity of the programs.
inline constexpr const char* kEntityHelp =
    "Own aircraft among the host's entities: its number; of a DIS host also SITE:APPLICATION:ENTITY or the "
    "marking. Without it entity 0 of a CIGI host, and the first platform of a DIS host";
/// Returns what --protocol may be: `auto` and all protocols of hosts, or those that can be sent.
std::vector<std::string> protocolOptions(bool toReceive);

/// Says who may send to a receiver, who sends, and who tried without being allowed.
struct Senders {
  std::string allowed;         ///< an address, kAnyone, or kFirst before the first
  std::uint64_t refused = 0;   ///< datagrams
  std::string lastRefused;     ///< "192.168.1.7:5500"; empty if none was
  std::uint64_t received = 0;  ///< datagrams of all allowed senders
  /// The health of the senders beside the one that Receiver::statistics() is of.
  std::vector<HostStatistics> others;
};

/// What hosts asked about the terrain.
struct Questions {
  std::uint64_t asked = 0, answered = 0;
  std::uint64_t dropped = 0;     ///< more at once than can wait
  bool nowhereToAnswer = false;  ///< asked, but there is no reply address
};

struct ReceiverOptions {
  std::uint16_t port = 0;  ///< 0: any free port
  std::string bindAddress =
      kOwnMachine;      ///< the interface's address; 0.0.0.0: every interface; "::": also of IPv6
  std::string group{};  ///< a multicast group to join there, or empty
  /// Sender that is allowed: kAnyone, kFirst (the address of the first good datagram is held from then on),
  /// or the address or name of a host, with a port if one of several on a machine is meant. The datagrams of
  /// others are counted and thrown away.
  std::string sender = kAnyone;
  HostChoice choice{};  ///< what is followed of what the host says
  /// Where Start of Frame is sent, `replyRateHz` times per second, with the answers to what the host asked
  /// about the terrain.
  std::optional<Endpoint> reply;
  double replyRateHz = 60;  ///< 0.001..10000
  /// Called on the receiver's thread after each state was queued. It must return at once: post an event.
  std::function<void()> wake;
};

/// Receives and decodes on a thread of its own. States wait in a bounded queue; if it is full, the oldest is
/// dropped and counted.
class Receiver {
 public:
  /// Opens the socket and starts the thread. Fails if the port is in use, and names it. Looking up a name may
  /// wait for a name server.
  static Result<std::unique_ptr<Receiver>> open(const ReceiverOptions& options);
  virtual ~Receiver() = default;  ///< stops the thread and closes the socket

  virtual std::uint16_t port() const = 0;
  /// Returns in `states` all states since the last call, in order of arrival.
  virtual void take(std::vector<ReceivedState>& states) = 0;
  /// Returns the health of the sender that is followed (HostDecoder::statistics).
  virtual HostStatistics statistics() const = 0;
  virtual Senders senders() const = 0;
  virtual std::uint64_t dropped() const = 0;
  /// Sets the terrain that answers what the host asks (HAT/HOT, line of sight); null: nothing valid is
  /// answered.
  virtual void setGround(std::shared_ptr<const GroundHeights> ground) = 0;
  virtual Questions questions() const = 0;
  /// Passes every datagram of an allowed sender from now on to `tap`, on the receiver's thread, for
  /// recording. Null ends this.
  virtual void tap(std::function<void(const Datagram&)> tap) = 0;
};

/// Returns CLOCK_REALTIME in seconds.
double now();

struct PlayOptions {
  Endpoint to;
  WireProtocol protocol = WireProtocol::cigi3;
  /// States are interpolated at this rate, 0.001 to 10000 Hz. If 0, the flight's rows are sent as they are,
  /// at their times.
  double rateHz = 60;
  double speed = 1;  ///< 0.001..1000
  bool loop = false;
  double startS = 0;  ///< seconds into the flight
  /// Replaces the head of the flight, on the flight's clock. native-fdm carries no head and refuses it.
  std::optional<HeadLog> head{};
  /// Sends a small set of symbols with every packet; see exampleSymbols. CIGI 3 alone has them.
  bool symbols = false;
};
/// Sends a flight over UDP on the flight's own clock, from its own thread.
class FeedPlayer {
 public:
  static Result<std::unique_ptr<FeedPlayer>> start(Flight flight, const PlayOptions& options);
  virtual ~FeedPlayer() = default;  ///< stops
  virtual void pause(bool paused) = 0;
  /// Sets the speed. A value outside the range of `PlayOptions::speed` is ignored.
  virtual void setSpeed(double speed) = 0;
  virtual void setLoop(bool loop) = 0;
  virtual void seek(double timeS) = 0;
  virtual double position() const = 0;  ///< seconds into the flight
  virtual bool finished() const = 0;
  virtual std::uint64_t sent() const = 0;
};

}  // namespace trimtab::link
