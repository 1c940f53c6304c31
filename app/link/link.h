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

/// UDP at the edge: the one receiver and the one sender that workbench, IG and CLI share. IPv4, no GUI, no
/// GL.
namespace trimtab::link {

struct Endpoint {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;
};
/// "host:port"; a bare port means 127.0.0.1.
Result<Endpoint> parseEndpoint(const std::string& text);

struct ReceiverOptions {
  std::uint16_t port = 0;  ///< 0: any free one
  std::string bindAddress = "0.0.0.0";
  HostProtocol protocol = HostProtocol::automatic;
  std::optional<Endpoint> reply;  ///< Start of Frame goes there at `replyRateHz`
  double replyRateHz = 60;        ///< 0.001..10000
  /// Called on the receiver's thread after each state was queued: a place to post an event, nothing more.
  std::function<void()> wake;
};

/// Receives and decodes on a thread of its own; states wait in a bounded queue (oldest dropped and counted).
class Receiver {
 public:
  /// Fails when the port is taken, naming it.
  static Result<std::unique_ptr<Receiver>> open(const ReceiverOptions& options);
  virtual ~Receiver() = default;  ///< stops the thread and closes the socket

  virtual std::uint16_t port() const = 0;
  /// All states since the last call, in order of arrival.
  virtual void take(std::vector<ReceivedState>& states) = 0;
  virtual HostStatistics statistics() const = 0;
  virtual std::uint64_t dropped() const = 0;
  /// Copies every datagram from now on (for recording); null ends it. Called on the receiver's thread.
  virtual void tap(std::function<void(const Datagram&)> tap) = 0;
};

/// Current CLOCK_REALTIME in seconds.
double now();

struct PlayOptions {
  Endpoint to;
  WireProtocol protocol = WireProtocol::cigi3;
  /// States are interpolated at this rate, 0.001..10000; 0: send the flight's rows as they are, at their
  /// times.
  double rateHz = 60;
  double speed = 1;  ///< 0.001..1000
  bool loop = false;
  double startS = 0;  ///< seconds into the flight
  /// In place of the flight's own heads, on the flight's clock; native-fdm carries none, and refuses it.
  std::optional<HeadLog> head{};
};
/// Sends a flight over UDP on the flight's own clock, from its own thread.
class FeedPlayer {
 public:
  static Result<std::unique_ptr<FeedPlayer>> start(Flight flight, const PlayOptions& options);
  virtual ~FeedPlayer() = default;  ///< stops
  virtual void pause(bool paused) = 0;
  /// A speed that `PlayOptions` does not allow changes nothing.
  virtual void setSpeed(double speed) = 0;
  virtual void setLoop(bool loop) = 0;
  virtual void seek(double timeS) = 0;
  virtual double position() const = 0;  ///< seconds into the flight
  virtual bool finished() const = 0;
  virtual std::uint64_t sent() const = 0;
};

}  // namespace trimtab::link
