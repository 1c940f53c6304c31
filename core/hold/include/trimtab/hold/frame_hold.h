#pragma once

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "trimtab/frame/frame_request.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/hold/arbiter.h"

/// Holds the budget over successive images: counts the load of the coming views, arbitrates, and learns what
/// images cost. A session owns one.
namespace trimtab {

/// Says where the eye of a coming image will be.
struct ComingEye {
  GeodeticPosition position;
  Attitude attitude;
};

/// Says how a prediction made some images earlier came out, for docks and benchmarks.
struct HoldOutcome {
  int imagesAhead = 0;
  double predictedTriangles = 0, triangles = 0;
  double predictedMs = 0, halfBandMs = 0, ms = 0;
};

/// The share of an image's load that is left where the allowed error is 1, 2, 4, 8 and 16 times as large, of
/// a scene whose levels nobody can count; all are above 0. What no fit has measured halves from octave to
/// octave.
using LoadShape = std::array<double, 5>;
inline constexpr LoadShape kHalvedLoad{1, 0.5, 0.25, 0.125, 0.0625};

/// Returns the millions of pixels of an image that lie below the horizon of a smooth earth.
double groundMpxOf(const LocalFrame& frame, const ViewShape& view, const ComingEye& eye);

class FrameHold {
 public:
  /// Sets what triangles are counted in; null counts none, and the triangles of the last image are expected
  /// again, whatever error is allowed.
  void setIndex(std::shared_ptr<const LoadIndex> index);
  /// Sets by what the load falls where an index has no form to count in.
  void setLoadShape(const LoadShape& shape) { shape_ = shape; }

  /// Gathers what the arbitration of a request depends on. `coming` are the eyes of the next images, the
  /// nearest first, and `outcomesAhead` of them counts for outcome(). `budgetMs` is the preset's.
  HoldGiven look(const FrameRequest& request, std::span<const ComingEye> coming, double budgetMs);
  /// Decides, and writes the levers into the request.
  HoldDecision decide(const HoldGiven& given, const HoldParameters& parameters, FrameRequest& request);
  /// Writes what was decided before, perhaps on another machine, into the request, and returns it.
  HoldDecision replay(const HoldGiven& given, const HoldDecision& decision, FrameRequest& request);

  /// Learns from the image of the last request.
  void finished(const FrameResult& result, const FrameCost& cost);

  /// Names the nodes of tiles or of static trees that coming images may draw, the likeliest first:
  /// those of the view after `drawn` that is farthest ahead; and the same at the allowed error to which the
  /// arbiter will return in one step, or else at twice the error, to which it may have to go. A name may come
  /// twice. `drawn` is the last request as it was drawn. What is returned is valid until the next call.
  std::span<const std::uint32_t> nodesAhead(const FrameRequest& drawn, std::span<const ComingEye> coming);
  /// Tells how many of these names there was no time for. Without this the arbiter waits for none.
  void setMeshesLeft(std::size_t left) { meshesLeft_ = left; }

  const HoldMemory& memory() const { return memory_; }
  void setMemory(const HoldMemory& memory) { memory_ = memory; }
  CostModel& model() { return model_; }
  const CostModel& model() const { return model_; }
  /// Returns how the prediction made kImagesAhead images ago for the last finished image came out; unset
  /// before there is one.
  const std::optional<HoldOutcome>& outcome() const { return outcome_; }

  /// Returns what the last decision was made from.
  const HoldGiven& given() const { return given_; }

  static constexpr int kImagesAhead = 3;

 private:
  HoldDecision apply(const HoldGiven& given, const HoldDecision& decision, FrameRequest& request);
  TriangleLadder count(const FrameRequest& request, const LoadView& view);
  TriangleLadder countGround(const FrameRequest& request, const LoadView& view);
  const std::vector<float>& treeErrorOf(ErrorMeasure measure);
  void collect(const FrameRequest& request, const LoadView& view, double errorScale);
  LoadView viewOf(const FrameRequest& request, const ComingEye& eye) const;

  /// A prediction that waits for its image.
  struct Prediction {
    TriangleLadder triangles{};
    CostCoefficients cost;
    double groundMpx = 0;
    bool known = false;  ///< the motion was known, and the cost
  };

  std::shared_ptr<const LoadIndex> index_;
  LoadShape shape_ = kHalvedLoad;
  std::optional<ErrorMeasure> measure_;
  std::vector<float> treeError_;  ///< of the trees, by `measure_`
  std::vector<std::uint64_t> stack_;
  std::vector<std::uint32_t> nodesAhead_;
  CostModel model_;
  HoldMemory memory_;

  TriangleLadder countedNow_{};  ///< of the last request's own view, without the correction
  double groundNowMpx_ = 0;
  std::size_t meshesLeft_ = 0;
  HoldGiven given_;
  HeldLevers held_;
  bool requested_ = false;
  /// The arbiter moved a lever in the last image, which then also took the time of building levels or of
  /// resizing its target. It teaches nothing about an image at rest.
  bool exchanged_ = false;
  /// Triangles drawn over triangles counted, of recent images: what neighbours add and occlusion hides.
  double correction_ = 1;
  double lastTriangles_ = 0;
  std::deque<Prediction> waiting_;
  std::optional<HoldOutcome> outcome_;
};

}  // namespace trimtab
