// SPDX-License-Identifier: GPL-3.0-or-later
#include "observer_controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/link/link.h"
#include "app/workbench/jobs/feed.h"
#include "app/workbench/viewport/viewport.h"
#include "terrain_controller.h"
#include "trimtab/motion/line_of_sight.h"
#include "views/model/draft.h"

namespace trimtab::workbench {
namespace {

/// Where a detached observer starts: behind the pilot's eye and above it, so that its frustum lies ahead.
constexpr double kBehindM = 3000, kAboveM = 1200, kPitchDeg = -18;
constexpr double kClearM = 300;

GeodeticPosition moved(const GeodeticPosition& from, Vec3 eastNorthUpM) {
  const Mat3 toEarth = transposed(eastNorthUp(from.latitude, from.longitude));
  return toGeodetic(toEcef(from) + toEarth * eastNorthUpM);
}

}  // namespace

Seat seatOf(const Session& session) {
  const AircraftState eye = session.eyeState(link::now());
  const Attitude sight = lineOfSight(eye.attitude, eye.head);
  return {eye.position, {sight.heading, sight.pitch, Degrees{0}}};
}

ObserverController::ObserverController(const Workplace& workplace, const TerrainController& terrain)
    : at_(workplace), terrain_(terrain) {
  connect(&terrain_, &TerrainController::opened, this, [this] {
    setFrozen(false);
    setDetached(false);
  });
  connect(&at_.draft, &views::Draft::activeChanged, this, [this] {
    if (!frozen_) return;
    frozen_->session.setParameters(at_.draft.active());
    frozen_->request.reset();
  });
}

const Session& ObserverController::pilot() const {
  return frozen_ ? frozen_->session : std::as_const(at_.feed).session();
}

bool ObserverController::canLeave() const {
  return terrain_.database() && at_.feed.session().hasState();
}

void ObserverController::setDetached(bool detached) {
  if (detached != detached_ && (!detached || canLeave())) {
    const bool wasApart = apart();
    detached_ = detached;
    if (detached && !wasApart) leave(true);
    if (!apart()) comeBack(true);
  }
  emit detachedChanged(detached_);
  emit changed();
  at_.viewport.invalidate();
}

void ObserverController::setFrozen(bool frozen) {
  if (frozen != this->frozen() && (!frozen || canLeave())) {
    const bool wasApart = apart();
    if (frozen) {
      frozen_.emplace(Frozen{at_.feed.session(), link::now(), {}});
      frozen_->session.keepRows(false);
    } else {
      frozen_.reset();
    }
    if (frozen && !wasApart) leave(false);
    if (!apart()) comeBack(false);
  }
  emit frozenChanged(this->frozen());
  emit changed();
  at_.viewport.invalidate();
}

/// Places the camera at the pilot's eye, or behind it. A free camera that was the pilot's eye is there
/// already.
void ObserverController::leave(bool behind) {
  if (!behind && at_.feed.source() == Feed::Source::camera) return;
  const Seat seat = seatOf(at_.feed.session());
  if (!behind) return at_.viewport.camera().place(seat.position, seat.attitude);
  const double heading = seat.attitude.heading.in<Radians>();
  GeodeticPosition place =
      moved(seat.position, {-std::sin(heading) * kBehindM, -std::cos(heading) * kBehindM, kAboveM});
  if (const auto ground =
          terrain_.database()->highestWithin(place.latitude, place.longitude, Metres{kBehindM}))
    place.height = std::max(place.height, *ground + Metres{kClearM});
  at_.viewport.camera().place(place, {seat.attitude.heading, Degrees{kPitchDeg}, Degrees{0}});
}

/// A free camera becomes the pilot's eye again: where it is now, or in the place that was left.
void ObserverController::comeBack(bool toTheSeat) {
  if (at_.feed.source() != Feed::Source::camera || !at_.feed.session().hasState()) return;
  const AircraftState& seat = at_.feed.session().input().state;
  if (toTheSeat) at_.viewport.camera().place(seat.position, seat.attitude);
  at_.feed.look(at_.viewport.camera());
}

std::optional<FrameRequest> ObserverController::request(double now, QSize size, ViewFit fit) {
  Session& live = at_.feed.session();
  if (!frozen_) return live.request(now, size.width(), size.height(), fit);
  live.noPicture();
  if (!frozen_->request)
    frozen_->request = frozen_->session.request(frozen_->at, size.width(), size.height(), fit);
  return frozen_->request;
}

FrameRequest ObserverController::seen(const FrameRequest& pilot) const {
  FrameRequest seen = pilot;
  const LocalFrame& local = terrain_.database()->index().frame;
  seen.frozenEye = EyePose{local.fromGeodetic(pilot.eye), eyeAxes(local, pilot.eye, pilot.attitude)};
  seen.eye = at_.viewport.camera().position();
  seen.attitude = at_.viewport.camera().attitude();
  seen.velocity.reset();
  seen.symbology.reset();
  seen.levers.drawn.blurStrength = 0;
  return seen;
}

bool ObserverController::movesOnItsOwn(double now) const {
  // The live session waits for no image then, but a flight moves on only while images are asked for.
  if (frozen_) return at_.feed.source() == Feed::Source::flight && at_.feed.playback().playing();
  return at_.feed.movesOnItsOwn(now);
}

QString ObserverController::banner() const {
  if (frozen_)
    return tr("FROZEN: decision, levels and visible set stay. Keys and mouse fly this view. Ctrl+F ends it.");
  if (detached_)
    return tr("DETACHED: the pilot flies on below. Keys and mouse fly this view. Ctrl+Shift+F ends it.");
  return {};
}

}  // namespace trimtab::workbench
