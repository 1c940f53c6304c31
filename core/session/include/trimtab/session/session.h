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
#include "trimtab/host/received_state.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/measure/trace.h"
#include "trimtab/preset/table.h"
#include "trimtab/session/head_input.h"

/// From packet states to pictures: what IG and workbench do alike, so that they decide alike. No GUI, no GL,
/// no clock of its own: the caller passes `now` (link::now()). One thread.
namespace trimtab {

enum class LinkState {
  never,  ///< no packet yet
  live,
  silent,  ///< no packet for host.silence_after_ms: the eye stands still
  jumped   ///< live, and within the last second the aircraft was moved farther than it can fly
};
std::string_view toText(LinkState state);

/// Milliseconds over the newest packets.
struct Latency {
  SampleWindow decoded{4096};  ///< kernel time stamp to decoded state
  SampleWindow shown{4096};    ///< kernel time stamp of the packet that a picture shows, to that picture
  /// Also of the packets that a newer one overtook: to the picture that shows the newer one.
  SampleWindow every{4096};
  SampleWindow frame{4096};  ///< from the request of a picture that shows a packet to its end
};

class Session {
 public:
  explicit Session(const ValidatedParameters& parameters);

  /// Holds from the next packet on; the current picture's decision is made again, without a trace of it (see
  /// `decision`).
  void setParameters(const ValidatedParameters& parameters);
  const ValidatedParameters& parameters() const { return parameters_; }
  /// Asked for the ground where the host does not tell the height above it. May be null.
  void setGround(std::shared_ptr<const GroundHeights> ground);

  // Where states come from. Each call decides exactly once for each state, in order.

  /// Packets, in order of arrival.
  void receive(std::span<const ReceivedState> states);
  /// A row of a flight that is drawn row by row: no link, no extrapolation. `now` places it among the
  /// pointer's events.
  void fly(const AircraftState& state, double now = std::numeric_limits<double>::quiet_NaN());
  /// A row of a trace: decides from exactly the recorded input. The first one brings the memory it was
  /// decided with.
  void replay(const TraceRow& row);
  /// A free camera's state, whose time is `now`: decided with a memory of its own; no packet, no trace row,
  /// no link.
  void look(const AircraftState& state);
  /// Forgets states, memory, link and latencies: a new host, a new flight.
  void restart();

  /// Whose head it is: applies to every state but those of a trace, which bring the head they were decided
  /// with.
  HeadInput& head() { return head_; }
  const HeadInput& head() const { return head_; }

  // What there is now.

  bool hasState() const { return current_.has_value(); }
  /// What the last decision was made from. Only with `hasState`.
  const FrameInput& input() const { return *current_; }
  /// The last packet's decision; after `setParameters` what an equal packet would be decided to now.
  const FrameDecision& decision() const { return decision_; }
  /// Memory as the next packet will meet it.
  const DecisionMemory& memory() const { return memory_; }
  LinkState linkState(double now) const;
  /// Seconds since the last packet came; NaN before the first.
  double packetAge(double now) const;
  std::uint64_t packets() const { return packets_; }
  std::uint64_t jumps() const { return jumps_; }
  const Latency& latency() const { return latency_; }

  // Pictures.

  /// Whether a picture drawn at `now` would differ from the last one asked for: a packet, an edit, the eye
  /// moves on between packets, or a blur has not run out. False when the host is silent and nothing was
  /// edited.
  bool needsPicture(double now) const;
  /// Whether the last picture asked for was blurred: one more is due, though nothing else moves.
  bool blurred() const { return blurDrawn_; }
  /// The state that the eye has at `now`: between packets it moves on along the recent velocity. Only with
  /// `hasState`.
  AircraftState eyeState(double now) const;
  /// The picture of `now`. None before the first state. Packets decided until here count as shown by it. A
  /// blur's remaining time runs on from the first picture of its decision.
  std::optional<FrameRequest> request(double now, int windowWidthPx, int windowHeightPx);
  /// The requested picture is finished: completes rows, latency and the cost that the next decision is given.
  /// `cost.decide` is filled in here. Returns the completed cost.
  FrameCost finished(const FrameResult& result, double now);
  /// Finished pictures whose work took longer than measure.budget_ms.
  std::uint64_t overBudget() const { return overBudget_; }
  /// No picture is drawn of what has arrived (hidden window): rows and latencies do not wait for one.
  void noPicture();

  // Trace.

  /// Rows are made only while this is on.
  void keepRows(bool keep);
  /// Appends the rows that are complete, in order; at the end (`all`) also those that no picture has shown
  /// yet.
  void takeRows(std::vector<TraceRow>& rows, bool all = false);

 private:
  void decideNext(const FrameInput& input, double kernelTime);
  FrameInput inputFor(const AircraftState& state) const;
  std::optional<Metres> groundBelow(const AircraftState& state) const;
  void follow(const AircraftState& state, double arrival);
  SymbologyState symbols(const AircraftState& eye) const;
  std::optional<Velocity> velocityOf(const AircraftState& state) const;

  ValidatedParameters parameters_;
  std::shared_ptr<const GroundHeights> ground_;

  DecisionMemory memory_, lookMemory_;
  std::optional<FrameInput> current_;
  FrameDecision decision_;
  FrameCost lastCost_;
  double decideMs_ = 0;  ///< spent since the last picture
  std::uint64_t overBudget_ = 0;
  bool looking_ = false;
  bool replayed_ = false;

  HeadInput head_;
  std::optional<double> blurPicturedAt_;  ///< of the first picture of the last decision
  bool blurDrawn_ = false;

  GroundVelocity groundVelocity_;
  Extrapolator extrapolator_;
  bool linked_ = false;     ///< states come from a live link: the eye may be extrapolated
  double clockOffset_ = 0;  ///< host clock minus ours
  double lastArrival_ = 0, lastJump_ = 0;
  std::uint64_t packets_ = 0, jumps_ = 0;
  Latency latency_;

  bool dirty_ = false;
  std::optional<AircraftState> drawnEye_;
  std::vector<double> waiting_, inPicture_;  ///< kernel times
  double requestedAt_ = 0;
  bool keepRows_ = false;
  std::vector<TraceRow> rows_;
  std::size_t completeRows_ = 0, requestedRows_ = 0;
};

}  // namespace trimtab
