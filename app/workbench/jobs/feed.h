// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QTimer>
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "app/link/link.h"
#include "app/workbench/viewport/free_camera.h"
#include "flight_playback.h"
#include "trimtab/host/flight.h"
#include "trimtab/session/session.h"

namespace trimtab::workbench {

/// Who moves the aircraft: a host, a flight played here, or the person at the mouse. One session decides over
/// them all.
class Feed : public QObject {
  Q_OBJECT

 public:
  enum class Source { camera, flight, host };

  explicit Feed(const ValidatedParameters& parameters, QObject* parent = nullptr);
  ~Feed() override;

  Session& session() { return session_; }
  const Session& session() const { return session_; }
  /// A host counts from its first packet; until then the camera is free.
  Source source() const { return source_; }

  struct HostSettings {
    std::uint16_t port = 0;
    HostProtocol protocol = HostProtocol::automatic;
    std::optional<link::Endpoint> reply;
  };
  /// Listens, in place of any link before. Errors leave that one as it was, unless both want the same port.
  Findings openHost(const HostSettings& settings);
  void closeHost();
  const link::Receiver* receiver() const { return receiver_.get(); }

  FlightPlayback& playback() { return playback_; }
  void loadFlight(Flight flight);
  /// Plays here; the host's link is closed first.
  void playHere();
  void pauseHere();
  void seekHere(double position);
  /// Sends the flight to the port that is listened on (one is opened where none is).
  Findings playOverUdp(WireProtocol protocol, double speed, bool loop, double position);
  void stopUdp();
  link::FeedPlayer* udpPlayer() const { return udp_.get(); }

  // The head of the one who looks, in place of a host's. A log begins with the flight, or with the next
  // state. While a log or the pointer moves it under a free camera, states come 60 a second.
  using Head = HeadInput::Source;
  void useHead(Head source);
  void useHeadLog(HeadLog log);
  /// See HeadInput::point.
  void point(double right, double up);

  /// The free camera moved. Without effect while a host or a flight moves the aircraft.
  void look(const FreeCamera& camera);
  /// Takes what has come since the last call and decides each state, in order.
  void advance(double now);
  /// Whether pictures must go on without any further event: a flight plays, or the eye is extrapolated.
  bool movesOnItsOwn(double now) const;
  /// Pictures are not drawn (hidden window): nothing waits for one.
  void setPicturesDrawn(bool drawn) { picturesDrawn_ = drawn; }

 signals:
  void statesArrived();  ///< a picture would differ
  /// Scheme, band or size is another than a state ago, or head motion changed something; the session has it.
  void decisionChanged();
  void sourceChanged();
  void linkChanged();  ///< opened, closed, first packet, silent, live again
  void jumped();
  void headChanged();    ///< another source of the line of sight
  void flightChanged();  ///< another flight, or it started, stopped, ended

 private:
  void wake();
  void noteDecision();
  void lookAt(double time);
  void lookOnGrid(double now);
  void beginHeadLog();
  void setSource(Source source);

  Session session_;
  Source source_ = Source::camera;
  FlightPlayback playback_;
  std::vector<ReceivedState> received_;
  std::vector<AircraftState> flown_;
  std::optional<AircraftState> camera_;  ///< where the free camera is
  double lastLook_ = 0, lastAdvance_ = 0;
  std::optional<FrameDecision> lastDecision_;
  QTimer silence_;
  LinkState lastLink_ = LinkState::never;
  std::uint64_t lastJumps_ = 0;
  bool picturesDrawn_ = true;
  std::atomic<bool> wakePosted_ = false;
  HostSettings settings_;
  std::unique_ptr<link::FeedPlayer> udp_;
  std::unique_ptr<link::Receiver> receiver_;  ///< last: its thread calls wake() until it is gone
};

}  // namespace trimtab::workbench
