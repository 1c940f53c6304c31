// SPDX-License-Identifier: GPL-3.0-or-later
#include "feed.h"

#include <algorithm>
#include <cmath>

#include "trimtab/host/flight.h"
#include "trimtab/motion/head_motion.h"

namespace trimtab::workbench {
namespace {

constexpr double kLookPeriodS = 1.0 / 60;
/// After a longer stall of the program, states continue from now instead of catching up.
constexpr double kLongestBurstS = 1;

/// Whether `b`, decided after `a`, changes nothing that belongs in a log of changes.
bool sameChoice(const FrameDecision& a, const FrameDecision& b) {
  return a.scheme == b.scheme && a.band == b.band && a.occlusionResolution == b.occlusionResolution &&
         !changesState(b.motion.reason);
}

}  // namespace

Feed::Feed(const ValidatedParameters& parameters, QObject* parent) : QObject(parent), session_(parameters) {
  session_.watchSignals();
  silence_.setSingleShot(true);
  connect(&silence_, &QTimer::timeout, this, [this] {
    lastLink_ = session_.linkState(link::now());
    emit linkChanged();
  });
}

Feed::~Feed() {
  receiver_.reset();
}

Findings Feed::openHost(const HostSettings& settings) {
  link::ReceiverOptions options;
  options.port = settings.port;
  options.bindAddress = settings.bindAddress;
  options.group = settings.group;
  options.sender = settings.sender;
  options.choice = settings.choice;
  options.reply = settings.reply;
  options.wake = [this] {
    if (!wakePosted_.exchange(true)) QMetaObject::invokeMethod(this, &Feed::wake, Qt::QueuedConnection);
  };
  // The same port can be opened again only after the old link has closed it.
  if (receiver_ && receiver_->port() == settings.port) closeHost();
  auto opened = link::Receiver::open(options);
  if (!opened) return opened.findings();
  closeHost();
  pauseHere();
  receiver_ = std::move(opened).value();
  receiver_->setGround(ground_);
  settings_ = settings;
  setSource(Source::camera);
  session_.restart();
  // Until the first packet the camera is free, and its images need a state.
  if (camera_) lookAt(link::now());
  lastDecision_.reset();
  lastLink_ = LinkState::never;
  lastJumps_ = 0;
  emit linkChanged();
  return {};
}

void Feed::closeHost() {
  if (!receiver_) return;
  stopUdp();
  receiver_.reset();
  silence_.stop();
  lastLink_ = LinkState::never;
  if (source_ == Source::host) setSource(Source::camera);
  emit linkChanged();
}

void Feed::setGround(std::shared_ptr<const GroundHeights> ground) {
  ground_ = std::move(ground);
  if (receiver_) receiver_->setGround(ground_);
  session_.setGround(ground_);
}

void Feed::loadFlight(Flight flight) {
  stopUdp();
  playback_.load(std::move(flight));
  if (source_ == Source::flight) setSource(Source::camera);
  emit flightChanged();
}

void Feed::playHere() {
  if (!playback_.loaded()) return;
  closeHost();
  if (source_ != Source::flight) session_.restart();
  setSource(Source::flight);
  beginHeadLog();
  playback_.play(link::now());
  session_.fly(playback_.current(), link::now());
  noteDecision();
  emit flightChanged();
  emit statesArrived();
}

void Feed::pauseHere() {
  if (!playback_.playing()) return;
  playback_.pause();
  emit flightChanged();
}

void Feed::seekHere(double position) {
  playback_.seek(position);
  if (udp_) return udp_->seek(position);
  if (!playback_.loaded() || source_ == Source::host) return;
  setSource(Source::flight);
  beginHeadLog();
  session_.fly(playback_.current(), link::now());
  noteDecision();
  emit statesArrived();
}

Findings Feed::playOverUdp(WireProtocol protocol, double speed, bool loop, double position) {
  stopUdp();
  if (!receiver_)
    if (Findings refused = openHost(settings_); !refused.empty()) return refused;
  link::PlayOptions options;
  const bool anywhere =
      settings_.bindAddress == "0.0.0.0" || settings_.bindAddress == "::" || !settings_.group.empty();
  options.to = {anywhere ? "127.0.0.1" : settings_.bindAddress, receiver_->port()};
  options.protocol = protocol;
  options.speed = speed;
  options.loop = loop;
  options.startS = position;
  auto started = link::FeedPlayer::start(playback_.flight(), options);
  if (!started) return started.findings();
  udp_ = std::move(started).value();
  emit flightChanged();
  return {};
}

void Feed::stopUdp() {
  if (!udp_) return;
  playback_.seek(udp_->position());
  udp_.reset();
  emit flightChanged();
}

void Feed::look(const FreeCamera& camera) {
  if (source_ != Source::camera) return;
  camera_.emplace();
  camera_->position = camera.position();
  camera_->attitude = camera.attitude();
  const double now = link::now();
  // While the head moves, the next state of the 60 per second carries the camera's new place.
  if (!session_.hasState() || !session_.head().moves(now)) lookAt(now);
  emit statesArrived();
}

void Feed::lookAt(double time) {
  AircraftState state = *camera_;
  state.time = lastLook_ = time;
  session_.look(state);
  noteDecision();
}

void Feed::lookOnGrid(double now) {
  if (now - lastLook_ > kLongestBurstS) return lookAt(now);
  while (lastLook_ + kLookPeriodS <= now) lookAt(lastLook_ + kLookPeriodS);
}

void Feed::useHead(Head source) {
  HeadInput& head = session_.head();
  if (source == Head::pointer)
    head.usePointer();
  else if (source == Head::none)
    head.useNone();
  else
    head.useHost();
  if (source_ == Source::camera && camera_) lookAt(link::now());
  emit headChanged();
  emit statesArrived();
}

void Feed::useHeadLog(HeadLog log) {
  session_.head().useLog(std::move(log));
  beginHeadLog();
  emit headChanged();
  emit statesArrived();
}

void Feed::beginHeadLog() {
  session_.head().restart();
  if (source_ == Source::flight) session_.head().begin(playback_.flight().beginS());
}

void Feed::point(double right, double up) {
  if (session_.head().source() != Head::pointer) return;
  session_.head().point(right, up, link::now());
  emit statesArrived();
}

void Feed::wake() {
  wakePosted_ = false;
  advance(link::now());
  if (!imagesDrawn_) session_.noPicture();
  emit statesArrived();
}

void Feed::advance(double now) {
  if (receiver_) {
    received_.clear();
    receiver_->take(received_);
    if (!received_.empty()) setSource(Source::host);
    // States are decided one at a time, so that the log misses no change between two images.
    for (const ReceivedState& state : received_) {
      session_.receive({&state, 1});
      noteDecision();
    }
    if (!received_.empty()) {
      silence_.start(static_cast<int>(std::ceil(session_.parameters()->host.silenceAfter.value())) + 1);
      if (session_.jumps() != lastJumps_) {
        lastJumps_ = session_.jumps();
        emit jumped();
      }
      const LinkState link = session_.linkState(now);
      if (link != lastLink_) {
        lastLink_ = link;
        emit linkChanged();
      }
    }
  }
  if (source_ == Source::flight && playback_.playing()) {
    flown_.clear();
    playback_.advance(now, flown_);
    const double step = flown_.empty() ? 0 : (now - lastAdvance_) / static_cast<double>(flown_.size());
    for (std::size_t i = 0; i < flown_.size(); ++i) {
      session_.fly(flown_[i], lastAdvance_ + step * static_cast<double>(i + 1));
      noteDecision();
    }
    if (!playback_.playing()) emit flightChanged();
  }
  if (source_ == Source::camera && camera_ && session_.head().moves(now)) lookOnGrid(now);
  lastAdvance_ = now;
}

bool Feed::movesOnItsOwn(double now) const {
  if (source_ == Source::flight) return playback_.playing() || session_.needsImage(now);
  if (source_ == Source::camera)
    return (camera_ && session_.head().moves(now)) || (session_.hasState() && session_.needsImage(now));
  if (session_.unsettled()) return true;
  // It is asked a little ahead, because directly after an image of `now` nothing has moved yet.
  return source_ == Source::host && session_.linkState(now) != LinkState::silent &&
         session_.needsImage(now + 0.02);
}

void Feed::noteDecision() {
  const FrameDecision& decision = session_.decision();
  const bool same = lastDecision_ && sameChoice(*lastDecision_, decision);
  lastDecision_ = decision;
  if (!same) emit decisionChanged();
}

void Feed::setSource(Source source) {
  if (source_ == source) return;
  source_ = source;
  session_.head().restart();
  emit sourceChanged();
}

}  // namespace trimtab::workbench
