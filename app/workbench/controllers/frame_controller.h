// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <limits>
#include <optional>
#include <string>

#include "app/workbench/viewport/viewport.h"
#include "observer_controller.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/overlays.h"
#include "views/model/live.h"
#include "workplace.h"

namespace trimtab {
class Session;
}

namespace trimtab::workbench {

class TerrainController;

/// Asks the session for each image that the viewport draws, and shows every frame to the docks.
class FrameController : public QObject {
  Q_OBJECT

 public:
  FrameController(const Workplace& workplace, const TerrainController& terrain, ObserverController& observer);
  /// Keeps what images cost for the next start.
  ~FrameController() override;

  /// The pilot's request for the image that the viewport drew last. Nothing until the first image.
  const std::optional<FrameRequest>& shown() const { return shown_; }
  /// The session that decided it: while frozen a copy, which stays as it was.
  const Session& session() const;
  /// What the last image cost.
  const FrameCost& lastCost() const { return lastCost_; }
  /// See LiveFrame::counts.
  bool counts() const { return !observer_.frozen() && !at_.viewport.paused(); }
  /// Seconds since the window was made: the clock of LiveFrame::time.
  double clock() const { return double(sinceStart_.nsecsElapsed()) * 1e-9; }

  const Overlays& overlays() const { return overlays_; }
  void setOverlays(const Overlays& overlays);
  /// Whether the image fills the viewport, so that its field of view grows beyond the preset's at two sides.
  /// If not, it has the preset's, with bars where the viewport has another shape. Kept in the settings.
  bool fills() const { return fit_ == ViewFit::fill; }
  void setFills(bool fills);
  /// Shows the docks the FLIP that was measured of an image; NaN if none is known any more.
  void setMeasuredFlip(double flip) { flip_ = flip; }
  /// Outlines a box of the terrain's local frame, in front of everything.
  void setOutline(const std::optional<Box>& box);

 signals:
  /// A new image is about to be asked for; `before` is the request that it replaces.
  void replaced(const trimtab::FrameRequest& before);
  /// A new frame for the docks: after each image, and between two images when the decision changes.
  void frameShown(const trimtab::views::LiveFrame& frame);
  /// An image is on the display and its cost is known. Emitted after `frameShown`.
  void painted();

 private:
  std::optional<NextImage> nextImage(int widthPx, int heightPx);
  FrameCost costOf(const FrameResult& result) const;
  QString hud(const AircraftState& eye) const;
  void onPainted();
  void onDecision();
  views::LiveFrame liveFrame() const;

  Workplace at_;
  const TerrainController& terrain_;
  ObserverController& observer_;
  Overlays overlays_;
  ViewFit fit_;
  std::optional<Box> outlined_;
  std::optional<FrameRequest> shown_;
  FrameCost lastCost_;
  std::string machine_;    ///< whose costs an earlier start may have learned; empty until they are recalled
  bool saidAnew_ = false;  ///< that these costs are learned anew
  LevelsFrame levels_;     ///< of the last image
  QElapsedTimer sinceImage_, sinceStart_;
  double fps_ = std::numeric_limits<double>::quiet_NaN(), flip_ = fps_;
};

}  // namespace trimtab::workbench
