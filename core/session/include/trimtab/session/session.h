#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/hold/frame_hold.h"
#include "trimtab/host/received_state.h"
#include "trimtab/session/decider.h"
#include "trimtab/session/frame_book.h"
#include "trimtab/session/head_input.h"
#include "trimtab/session/host_link.h"
#include "trimtab/session/image_rate.h"
#include "trimtab/session/motion_ahead.h"
#include "trimtab/session/request_maker.h"

/// Turns states into decisions and requests for images. An image generator and the workbench both use it, so
/// that they decide alike. It has no window, no GL and no clock of its own: the caller passes `now`, in
/// seconds of CLOCK_REALTIME.
namespace trimtab {

class Session {
 public:
  explicit Session(const ValidatedParameters& parameters) : decider_(parameters) {}

  /// Sets the parameters for the next packet on. The current state is decided again for the image, without a
  /// trace row and without changing the memory (see `decision`), except that the policy's levers take their
  /// new targets at once.
  void setParameters(const ValidatedParameters& parameters);
  const ValidatedParameters& parameters() const { return decider_.parameters(); }
  /// Sets what is asked for the height of the ground: for the height above it, and for aircraft that stand on
  /// it. May be null.
  void setGround(std::shared_ptr<const GroundHeights> ground);
  /// Sets what the arbiter of the budget counts the triangles of coming views in; see FrameHold::setIndex.
  void setLoadIndex(std::shared_ptr<const LoadIndex> index) { hold_.setIndex(std::move(index)); }

  // States come from one of these. Each call decides each of its states exactly once, in order.

  /// Receives packets, in order of arrival. If head motion counts images (MotionFrames::drawn), states only
  /// move the eye, and `request` decides the state that it draws.
  void receive(std::span<const ReceivedState> states);
  /// Receives a row of a flight that is drawn row by row, without a link and without extrapolation. `now`
  /// places it among the pointer's events.
  void fly(const AircraftState& state, double now = std::numeric_limits<double>::quiet_NaN());
  /// Decides a row of a trace from exactly the recorded input. The first row also sets the memory that it was
  /// decided with.
  void replay(const TraceRow& row);
  /// Receives the state of a free camera, whose time is `now`. It is decided with a memory of its own and
  /// counts neither as a packet nor as a trace row. A camera that is set down farther away than it can have
  /// flown begins anew there, so that its place and its turn count as no motion.
  void look(const AircraftState& state);
  /// Forgets states, memory, link and latencies, for a new host or a new flight.
  void restart();

  /// Returns where the head comes from. It applies to every state except rows of a trace, which have the head
  /// that they were decided with.
  HeadInput& head() { return head_; }
  const HeadInput& head() const { return head_; }

  // The current state.

  bool hasState() const { return flight_.current.has_value(); }
  /// Returns what the last decision was made from; before the first decision, the newest state. Call it only
  /// if `hasState`.
  const FrameInput& input() const { return decider_.input(); }
  /// Returns the decision for the last packet; after `setParameters`, the decision that it would get now.
  /// Head motion goes from the packet before it, because no time passes in an edit.
  const FrameDecision& decision() const { return decider_.decision(); }
  /// Returns the memory that the next packet will be decided with.
  const DecisionMemory& memory() const { return decider_.memory(); }
  LinkState linkState(double now) const { return flight_.link.state(now, parameters()->host.silenceAfter); }
  /// Returns the seconds since the last packet arrived; NaN before the first.
  double packetAge(double now) const { return flight_.link.packetAge(now); }
  std::uint64_t packets() const { return flight_.packets; }
  std::uint64_t jumps() const { return flight_.link.jumps(); }
  /// Returns where the host's height above ground contradicts the terrain's; nullopt if it never did. The two
  /// are compared only where something asks for the height.
  const std::optional<GroundDoubt>& groundDoubt() const { return decider_.groundDoubt(); }
  const Latency& latency() const { return book_.latency(); }

  /// Returns what holds the budget: its cost model, and how its predictions come out.
  FrameHold& hold() { return hold_; }
  const FrameHold& hold() const { return hold_; }

  /// Derives the signals also while the preset has no policy, for whoever shows them. They cost a height from
  /// the terrain for each state; decisions and traces do not depend on it.
  void watchSignals() { decider_.watchSignals(); }
  /// Returns the signals of the last decided state. They are unknown without a policy, unless somebody
  /// watches.
  SignalValues signalValues() const { return decider_.signalValues(); }

  // Images.

  /// Reports whether an image at `now` would differ from the last one requested: because of a packet, an
  /// edit, an eye that moves on between packets, or a blur that has not ended. It is false while the host is
  /// silent and nothing is edited.
  bool needsImage(double now) const;
  /// Reports whether images are due even if nothing moves: the last one was blurred, or head motion counts
  /// images and has yet to see that the eye rests.
  bool unsettled() const;
  /// Returns the state of the eye at `now`: between packets it moves on along the recent velocity. Call it
  /// only if `hasState`.
  AircraftState eyeState(double now) const;
  /// Returns the request for the image of `now`; nothing before the first state. Packets received so far
  /// count as shown by it. The remaining time of a blur runs from the first image of its decision.
  std::optional<FrameRequest> request(double now, int windowWidthPx, int windowHeightPx,
                                      ViewFit fit = ViewFit::preset);
  /// Returns what the image that was requested last costs, with `decide` filled in. `finished` returns the
  /// same.
  FrameCost costOf(const FrameResult& result) const { return book_.costOf(result); }
  /// Call this when the requested image is finished. It completes trace rows, latencies and the cost that the
  /// next input holds, and returns that cost with `decide` filled in.
  FrameCost finished(const FrameResult& result, double now);
  /// Names the nodes that the next images may draw and `drawn`, the last request as it was drawn, may not
  /// have (FrameHold::nodesAhead). Renderer::buildAhead takes them, for the time of aheadMs().
  std::span<const std::uint32_t> nodesAhead(const FrameRequest& drawn);
  /// Tells for how many of these names there was no time (scene::BuiltAhead::left): the arbiter restores no
  /// level of detail before its meshes are there.
  void builtAhead(std::size_t left) { hold_.setMeshesLeft(left); }
  /// Returns how long building ahead may take after the last image: half of what it left of the budget,
  /// milliseconds, but at least a fiftieth of the budget, so that it also goes on while images are late.
  double aheadMs() const;
  /// Returns how many finished images took longer to make than measure.budget_ms.
  std::uint64_t overBudget() const { return book_.overBudget(); }
  /// Call this if no image will show what has arrived, as while a window is hidden. Rows and latencies then
  /// do not wait for one. It counts as an image where images are decided.
  void noPicture();

  // Trace.

  /// Sets whether trace rows are made.
  void keepRows(bool keep) { book_.keepRows(keep); }
  /// Moves the complete rows to the end of `rows`, in order. With `all`, for the end of a trace, also those
  /// that no image has shown yet.
  void takeRows(std::vector<TraceRow>& rows, bool all = false) { book_.takeRows(rows, all); }

 private:
  template <class Decide>
  void timed(const Decide& decide);
  void decideNext(FrameInput input, double kernelTime);
  void arrive(const AircraftState& state, double kernelTime);
  bool decidesImages() const;
  void decideImage(double now);
  void addRow(const DecisionMemory& before);
  FrameInput inputFor(const AircraftState& state, bool live) const;
  void holdBudget(FrameRequest& request);

  Decider decider_;
  HeadInput head_;
  FrameBook book_;
  FrameHold hold_;
  /// Holds what a new host or flight begins without.
  struct Flight {
    HostLink link;
    std::optional<FrameInput> current;  ///< of the newest state
    std::uint64_t packets = 0;
    RequestMaker maker;
    ImageRate imageRate;
    MotionAhead ahead;                         ///< up to the last image requested
    std::optional<HoldDecision> replayedHold;  ///< of the row of a trace that the next image shows
    bool replayed = false;
    bool blurDrawn = false;  ///< in the last image requested
  };
  Flight flight_;
  bool dirty_ = false;  ///< since the last image requested
};

}  // namespace trimtab
