// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QObject>
#include <QSize>
#include <QString>
#include <optional>

#include "trimtab/session/session.h"
#include "workplace.h"

namespace trimtab::workbench {

class TerrainController;

/// A place for a free camera: with level wings.
struct Seat {
  GeodeticPosition position;
  Attitude attitude;
};
/// Returns the pilot's seat: where the eye of this session is now, and where it looks.
Seat seatOf(const Session& session);

/// Lets the engineer leave the pilot's eye and look at what it decides and culls, from a free camera.
/// Detached, the pilot's eye (host, flight or camera) goes on. Frozen, its decision, its levels and its
/// visible set stay as they were, whatever flies; the live session goes on as if no window showed it.
/// Opening another terrain ends both.
class ObserverController : public QObject {
  Q_OBJECT

 public:
  ObserverController(const Workplace& workplace, const TerrainController& terrain);

  bool detached() const { return detached_; }
  bool frozen() const { return frozen_.has_value(); }
  /// Reports whether the free camera is the observer's eye. If false, the image is the pilot's.
  bool apart() const { return detached_ || frozen_; }
  /// Ends itself at once if no terrain is open or nothing has been decided yet.
  void setDetached(bool detached);
  /// As `setDetached`. An edit decides the frozen moment again.
  void setFrozen(bool frozen);

  /// Returns the session that decided what is drawn: while frozen a copy, which stays as it was.
  const Session& pilot() const;
  /// Returns the pilot's request for an image of `size`; nothing before the first state. While frozen it is
  /// the same each time, in the size that it had first.
  std::optional<FrameRequest> request(double now, QSize size, ViewFit fit);
  /// Returns the request for what the observer sees of the pilot's: its cut and its visible set, from the
  /// free camera. Symbols, blur and streaks of rain belong to the pilot's eye and are left out.
  FrameRequest seen(const FrameRequest& pilot) const;
  /// Reports whether images must follow without a further event.
  bool movesOnItsOwn(double now) const;
  /// Says what is going on and how it ends; empty unless `apart`.
  QString banner() const;

 signals:
  void detachedChanged(bool detached);
  void frozenChanged(bool frozen);
  void changed();  ///< after either

 private:
  bool canLeave() const;
  void leave(bool behind);
  void comeBack(bool toTheSeat);

  struct Frozen {
    Session session;
    double at = 0;  ///< the time of its image
    std::optional<FrameRequest> request;
  };

  Workplace at_;
  const TerrainController& terrain_;
  bool detached_ = false;
  std::optional<Frozen> frozen_;
};

}  // namespace trimtab::workbench
