// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QTimer>
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "app/link/link.h"
#include "flight_playback.h"
#include "free_camera.h"
#include "trimtab/host/flight.h"
#include "trimtab/session/session.h"

namespace trimtab::workbench {

/// Feeds the session with states of the aircraft, from a host, from a flight that is played here, or from the
/// free camera. One session decides for all of them. Everything runs on the main thread but the host's
/// receiver, which only wakes it.
class Feed : public QObject {
  Q_OBJECT

 public:
  enum class Source { camera, flight, host };

  explicit Feed(const ValidatedParameters& parameters, QObject* parent = nullptr);
  ~Feed() override;

  Session& session() { return session_; }
  const Session& session() const { return session_; }
  /// Who moves the aircraft now. An open link counts as a host from its first packet on; until then the
  /// camera is free.
  Source source() const { return source_; }

  struct HostSettings {
    std::uint16_t port = 0;
    HostChoice choice{};  ///< what is followed of what the host says
    std::optional<link::Endpoint> reply;
    std::string bindAddress = link::kOwnMachine;  ///< of the interface to listen on
    std::string group{};                          ///< a multicast group to join there, or empty
    std::string sender = link::kAnyone;           ///< see link::ReceiverOptions::sender
  };
  /// Listens for a host; an earlier link is closed. If that fails, the earlier link stays open, unless both
  /// use the same port. Returns what went wrong.
  Findings openHost(const HostSettings& settings);
  void closeHost();
  const link::Receiver* receiver() const { return receiver_.get(); }
  /// Sets the terrain of the session, which also answers what a host asks.
  void setGround(std::shared_ptr<const GroundHeights> ground);

  FlightPlayback& playback() { return playback_; }
  void loadFlight(Flight flight);
  /// Plays the flight in this program. The host's link is closed first.
  void playHere();
  void pauseHere();
  void seekHere(double position);
  /// Sends the flight over UDP to the port that this program listens on; opens one if there is none.
  Findings playOverUdp(WireProtocol protocol, double speed, bool loop, double position);
  void stopUdp();
  link::FeedPlayer* udpPlayer() const { return udp_.get(); }

  // A head that replaces the host's. A log starts with the flight, or with the next state. While a log or the
  // pointer moves the head under a free camera, there are 60 states per second.
  using Head = HeadInput::Source;
  void useHead(Head source);
  void useHeadLog(HeadLog log);
  /// See HeadInput::point.
  void point(double right, double up);

  /// Call this when the free camera has moved. Does nothing while a host or a flight moves the aircraft.
  void look(const FreeCamera& camera);
  /// Decides every state that has arrived since the last call, in order.
  void advance(double now);
  /// Whether images must follow without a further event, because a flight plays or the eye is extrapolated.
  bool movesOnItsOwn(double now) const;
  /// Set to false while no image is drawn because the window is hidden: then nothing waits for one.
  void setImagesDrawn(bool drawn) { imagesDrawn_ = drawn; }

 signals:
  void statesArrived();  ///< a new image would differ from the last one
  /// The scheme, the band or the depth map's size has changed since the last state, or head motion has
  /// changed something. The session holds the new decision.
  void decisionChanged();
  void sourceChanged();
  void linkChanged();  ///< opened, closed, first packet, silent, live again
  void jumped();
  void headChanged();    ///< the line of sight has another source
  void flightChanged();  ///< another flight was opened, or it started, stopped or ended

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
  bool imagesDrawn_ = true;
  std::atomic<bool> wakePosted_ = false;
  HostSettings settings_;
  std::shared_ptr<const GroundHeights> ground_;
  std::unique_ptr<link::FeedPlayer> udp_;
  std::unique_ptr<link::Receiver>
      receiver_;  ///< last member, destroyed first: its thread calls wake() until then
};

}  // namespace trimtab::workbench
