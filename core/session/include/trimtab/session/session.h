#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "trimtab/decision/decide.h"
#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/frame/ground_heights.h"
#include "trimtab/host/decoder.h"
#include "trimtab/host/ground_velocity.h"
#include "trimtab/host/host_clock_offset.h"
#include "trimtab/host/received_state.h"
#include "trimtab/measure/trace.h"
#include "trimtab/preset/table.h"
#include "trimtab/session/air_drift.h"
#include "trimtab/session/ground_doubt.h"
#include "trimtab/session/head_input.h"
#include "trimtab/session/image_rate.h"
#include "trimtab/session/latency.h"
#include "trimtab/session/motion_ahead.h"
#include "trimtab/session/precipitation_fade.h"
#include "trimtab/session/signal_tracker.h"

/// Turns states into decisions and requests for images. An image generator and the workbench both use it, so
/// that they decide alike. It has no window, no GL and no clock of its own: the caller passes `now`, in
/// seconds of CLOCK_REALTIME.
namespace trimtab {

enum class LinkState {
  never,  ///< no packet yet
  live,
  silent,  ///< no packet for host.silence_after_ms, so the eye stays where it is
  jumped   ///< live, and within the last second the aircraft was moved farther than it can fly
};
std::string_view toText(LinkState state);

class Session {
 public:
  explicit Session(const ValidatedParameters& parameters);

  /// Sets the parameters for the next packet on. The current state is decided again for the image, without a
  /// trace row and without changing the memory (see `decision`), except that the policy's levers take their
  /// new targets at once.
  void setParameters(const ValidatedParameters& parameters);
  const ValidatedParameters& parameters() const { return parameters_; }
  /// Sets what is asked for the height of the ground: for the height above it, and for aircraft that stand on
  /// it. May be null.
  void setGround(std::shared_ptr<const GroundHeights> ground);
  /// Sets what the arbiter of the budget counts the triangles of coming views in; see FrameHold::setIndex.
  void setLoadIndex(std::shared_ptr<const LoadIndex> index) { budget_.hold.setIndex(std::move(index)); }

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

  bool hasState() const { return current_.has_value(); }
  /// Returns what the last decision was made from; before the first decision, the newest state. Call it only
  /// if `hasState`.
  const FrameInput& input() const { return decided_; }
  /// Returns the decision for the last packet; after `setParameters`, the decision that it would get now.
  /// Head motion goes from the packet before it, because no time passes in an edit.
  const FrameDecision& decision() const { return decision_; }
  /// Returns the memory that the next packet will be decided with.
  const DecisionMemory& memory() const { return memory_; }
  LinkState linkState(double now) const;
  /// Returns the seconds since the last packet arrived; NaN before the first.
  double packetAge(double now) const;
  std::uint64_t packets() const { return packets_; }
  std::uint64_t jumps() const { return jumps_; }
  /// Returns where the host's height above ground contradicts the terrain's; nullopt if it never did. The two
  /// are compared only where something asks for the height.
  const std::optional<GroundDoubt>& groundDoubt() const { return doubt_; }
  const Latency& latency() const { return latency_.latency(); }

  /// Returns what holds the budget: its cost model, and how its predictions come out.
  FrameHold& hold() { return budget_.hold; }
  const FrameHold& hold() const { return budget_.hold; }

  /// Derives the signals also while the preset has no policy, for whoever shows them. They cost a height from
  /// the terrain for each state; decisions and traces do not depend on it.
  void watchSignals() { signals_.watched.emplace(); }
  /// Returns the signals of the last decided state. They are unknown without a policy, unless somebody
  /// watches.
  SignalValues signalValues() const { return signals_.watched.value_or(decided_.signalValues); }

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
  FrameCost costOf(const FrameResult& result) const;
  /// Call this when the requested image is finished. It completes trace rows, latencies and the cost that the
  /// next input holds, and returns that cost with `decide` filled in.
  FrameCost finished(const FrameResult& result, double now);
  /// Names the nodes that the next images may draw and `drawn`, the last request as it was drawn, may not
  /// have (FrameHold::nodesAhead). Renderer::buildAhead takes them, for the time of aheadMs().
  std::span<const std::uint32_t> nodesAhead(const FrameRequest& drawn);
  /// Tells for how many of these names there was no time (scene::BuiltAhead::left): the arbiter restores no
  /// level of detail before its meshes are there.
  void builtAhead(std::size_t left) { budget_.hold.setMeshesLeft(left); }
  /// Returns how long building ahead may take after the last image: half of what it left of the budget,
  /// milliseconds, but at least a fiftieth of the budget, so that it also goes on while images are late.
  double aheadMs() const;
  /// Returns how many finished images took longer to make than measure.budget_ms.
  std::uint64_t overBudget() const { return overBudget_; }
  /// Call this if no image will show what has arrived, as while a window is hidden. Rows and latencies then
  /// do not wait for one. It counts as an image where images are decided.
  void noPicture();

  // Trace.

  /// Sets whether trace rows are made.
  void keepRows(bool keep);
  /// Moves the complete rows to the end of `rows`, in order. With `all`, for the end of a trace, also those
  /// that no image has shown yet.
  void takeRows(std::vector<TraceRow>& rows, bool all = false);

 private:
  void decideNext(FrameInput input, double kernelTime);
  void decideWith(DecisionMemory& memory);
  void arrive(const AircraftState& state, double kernelTime);
  bool decidesImages() const;
  void decideImage(double now);
  FrameInput inputFor(const AircraftState& state) const;
  void decideInput(DecisionMemory& memory);
  void trackSignals(FrameInput& input, const WeatherDecision& weather);
  void holdBudget(FrameRequest& request);
  std::optional<Metres> heightOverTerrain(const AircraftState& state) const;
  std::optional<Metres> groundBelow(const AircraftState& state) const;
  void compareGround(const AircraftState& state, std::optional<Metres> overTerrain);
  std::optional<Metres> highestGround() const;
  void follow(const AircraftState& state, double arrival);
  void unlink();
  SymbologyState symbols(const AircraftState& eye) const;
  std::optional<Velocity> velocityOf(const AircraftState& state) const;
  std::vector<std::uint16_t> darkAt(double time) const;

  ValidatedParameters parameters_;
  std::shared_ptr<const GroundHeights> ground_;
  std::optional<GroundDoubt> doubt_;

  DecisionMemory memory_, lookMemory_;
  MotionMemory motionBefore_;          ///< before the last decision
  std::optional<FrameInput> current_;  ///< of the newest state
  FrameInput decided_;                 ///< of the last decision
  FrameDecision decision_;
  ImageRate imageRate_;
  std::optional<std::uint64_t> lastVertices_;  ///< of the last finished image
  FrameCost lastCost_;
  double decideMs_ = 0, requestedDecideMs_ = 0;  ///< spent since the last request, and on the image requested
  std::uint64_t overBudget_ = 0;
  bool looking_ = false;
  bool replayed_ = false;

  HeadInput head_;
  std::optional<double> blurPicturedAt_;  ///< when the first image of the last decision was requested
  bool blurDrawn_ = false;
  /// Holds what moves and falls, up to the last image requested.
  struct Air {
    AirDrift drift;
    PrecipitationFade fade;
  };
  Air air_;

  struct Signals {
    SignalTracker tracker;                ///< pushed only if the preset has a policy or somebody watches
    std::optional<SignalValues> watched;  ///< if unset, nobody watches
  };
  Signals signals_;
  /// Holds what keeps the budget.
  struct Budget {
    FrameHold hold;
    MotionAhead ahead;                     ///< up to the last image requested
    std::optional<HoldDecision> replayed;  ///< of the row of a trace that the next image shows
  };
  Budget budget_;
  GroundVelocity groundVelocity_;
  Extrapolator extrapolator_;
  bool linked_ = false;  ///< states come from a live link, so the eye may be extrapolated
  HostClockOffset hostClock_;
  double lastArrival_ = 0, lastJump_ = 0;
  std::uint64_t packets_ = 0, jumps_ = 0;
  LatencyMeter latency_;

  std::shared_ptr<const HostSymbols> hostSymbols_;  ///< of the live link; null for any other source
  std::vector<std::uint16_t> drawnDark_;            ///< its dark symbols in the last image requested

  bool dirty_ = false;
  std::optional<AircraftState> drawnEye_;
  bool keepRows_ = false;
  std::vector<TraceRow> rows_;
  std::size_t completeRows_ = 0, requestedRows_ = 0;
};

}  // namespace trimtab
