#include "trimtab/hold/frame_hold.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trimtab {
namespace {

std::optional<TerrainForm> formOf(const FrameRequest& r, const LoadIndex& index) {
  return formDrawn(r, {index.tiles != nullptr, index.patches != nullptr, index.trees != nullptr});
}

/// Returns the share of the load that is left where the error is 2^octaves times that of neutral levers: from
/// octave to octave by a constant factor, which goes on beyond either end.
double shareAt(const LoadShape& shape, double octaves) {
  const auto low = static_cast<std::size_t>(std::clamp(octaves, 0.0, static_cast<double>(shape.size() - 2)));
  return shape[low] * std::pow(shape[low + 1] / shape[low], octaves - static_cast<double>(low));
}

/// Returns what an image may draw of a scene whose levels are not known, as one of OpenSceneGraph: the last
/// image's triangles, and less by the shape where the allowed error is larger.
TriangleLadder ladderFromLast(double triangles, double drawnPx, const LeverChain& levers,
                              const LoadShape& shape) {
  const double askedPx = levers.policy.errorPx;
  // The shape begins at neutral levers, and the ladder at what is asked for.
  const double asked = std::log2(askedPx * levers.policy.lodScale / levers.preset.errorPx);
  TriangleLadder ladder;
  ladder[0] = triangles * shareAt(shape, asked) / shareAt(shape, asked + std::log2(drawnPx / askedPx));
  for (std::size_t k = 1; k < kErrorSteps; ++k) {
    const double octaves = (placesToNext(askedPx) + static_cast<double>(k - 1)) / double{kPlacesPerOctave};
    ladder[k] = ladder[0] * shareAt(shape, asked + octaves) / shareAt(shape, asked);
  }
  return ladder;
}

}  // namespace

double groundMpxOf(const LocalFrame& frame, const ViewShape& view, const ComingEye& eye) {
  const EyePose pose{frame.fromGeodetic(eye.position), eyeAxes(frame, eye.position, eye.attitude)};
  const Vec3 up = frame.ecefToLocal() * eastNorthUp(eye.position.latitude, eye.position.longitude).row[2];
  return 1e-6 * view.widthPx * view.heightPx *
         shareBelowHorizon({pose, view}, up, eye.position.height.value());
}

void FrameHold::setIndex(std::shared_ptr<const LoadIndex> index) {
  index_ = std::move(index);
  measure_.reset();
  correction_ = 1;
  waiting_.clear();
  meshesLeft_ = 0;
  requested_ = false;
}

LoadView FrameHold::viewOf(const FrameRequest& request, const ComingEye& eye) const {
  const LocalFrame& frame = index_->frame;
  return {{frame.fromGeodetic(eye.position), eyeAxes(frame, eye.position, eye.attitude)},
          request.view,
          farCutM(request)};
}

const std::vector<float>& FrameHold::treeErrorOf(ErrorMeasure measure) {
  if (measure_ != measure) {
    measure_ = measure;
    treeError_ = staticLodError(*index_->trees, measure);
  }
  return treeError_;
}

TriangleLadder FrameHold::count(const FrameRequest& request, const LoadView& view) {
  TriangleLadder ladder = countGround(request, view);
  if (!index_->objects || !formOf(request, *index_)) return ladder;
  CutRule rule = objectRuleOf(request);
  const FrameLevers& asked = request.levers.policy;
  rule.maxErrorPx = asked.objectErrorPx;
  const TriangleLadder objects = countTriangles(*index_->objects, view, rule, asked.errorPx, asked);
  for (std::size_t k = 0; k < kErrorSteps; ++k) ladder[k] += objects[k];
  return ladder;
}

TriangleLadder FrameHold::countGround(const FrameRequest& request, const LoadView& view) {
  const std::optional<TerrainForm> form = formOf(request, *index_);
  const double askedPx = request.levers.policy.errorPx;
  if (!form)
    return ladderFromLast(lastTriangles_, held_.errorPx > 0 ? held_.errorPx : askedPx, request.levers,
                          shape_);
  TriangleLadder ladder;
  if (*form == TerrainForm::static_trees) {
    ladder = countTriangles(*index_->trees, treeErrorOf(request.staticLod.error), view,
                            staticLodRuleOf(request), askedPx, stack_);
    // By that rule a distance follows from the error of a node alone, so the lever moves nothing.
    if (request.staticLod.rule == StaticDistanceRule::factor) ladder.fill(ladder.front());
    return ladder;
  }
  const CutRule rule = cutKeyOf(request, view.eye.position, 1).rule;
  return *form == TerrainForm::patches ? countTriangles(*index_->patches, view, rule, askedPx, stack_)
                                       : countTriangles(*index_->tiles, view, rule, askedPx, stack_);
}

HoldGiven FrameHold::look(const FrameRequest& request, std::span<const ComingEye> coming, double budgetMs) {
  HoldGiven g;
  Prediction prediction;
  g.timeS = request.time;
  g.budgetMs = budgetMs;
  g.meshesLeft = static_cast<double>(meshesLeft_);
  const FrameLevers& asked = request.levers.policy;
  g.asked = {asked.errorPx, asked.renderScale, asked.particleShare, 1};
  const FadingPrecipitation falls = fallsNow(request);
  if (falls.kind != Precipitation::none) g.particles = falls.amount * asked.particleShare;
  g.blurs = asked.blurStrength > 0;
  g.imageMpx = 1e-6 * request.view.widthPx * request.view.heightPx;
  countedNow_.fill(lastTriangles_);
  groundNowMpx_ = g.imageMpx;
  if (index_) {
    const ComingEye here{request.eye, request.attitude};
    const LoadView view = viewOf(request, here);
    countedNow_ = count(request, view);
    groundNowMpx_ = groundMpxOf(index_->frame, request.view, here);
  }
  g.triangles = countedNow_;
  g.groundMpx = groundNowMpx_;
  for (std::size_t i = 0; index_ && i < coming.size(); ++i) {
    const LoadView next = viewOf(request, coming[i]);
    const TriangleLadder ladder = count(request, next);
    const double ground = groundMpxOf(index_->frame, request.view, coming[i]);
    if (i + 1 == kImagesAhead) {
      prediction.triangles = ladder;
      for (double& triangles : prediction.triangles) triangles *= correction_;
      prediction.groundMpx = ground;
      prediction.known = true;
    }
    for (std::size_t k = 0; k < kErrorSteps; ++k) g.triangles[k] = std::max(g.triangles[k], ladder[k]);
    g.groundMpx = std::max(g.groundMpx, ground);
  }
  if (index_)
    for (double& triangles : g.triangles) triangles *= correction_;
  // The band is that of an image as it is likely to be drawn. What is asked for may be far from all that was
  // drawn lately, and its band so wide that the arbiter would give up what it need not.
  const HeldLevers likely = memory_.begun && held_.renderScale > 0 ? held_ : g.asked;
  g.cost = model_.coefficients(loadOf(
      g, likely, trianglesAt(g.triangles, g.asked.errorPx, std::max(likely.errorPx, g.asked.errorPx))));
  prediction.cost = g.cost;
  prediction.known = prediction.known && g.cost.known;
  waiting_.push_back(prediction);
  if (waiting_.size() > kImagesAhead + 1) waiting_.pop_front();
  return g;
}

HoldDecision FrameHold::decide(const HoldGiven& given, const HoldParameters& parameters,
                               FrameRequest& request) {
  const HoldSteps before = memory_.steps;
  const HoldDecision d = arbitrate(given, parameters, memory_);
  exchanged_ = memory_.steps != before;
  return apply(given, d, request);
}

HoldDecision FrameHold::replay(const HoldGiven& given, const HoldDecision& decision, FrameRequest& request) {
  exchanged_ = decision.held != held_;
  memory_ = {};
  return apply(given, decision, request);
}

HoldDecision FrameHold::apply(const HoldGiven& given, const HoldDecision& d, FrameRequest& request) {
  given_ = given;
  held_ = d.held;
  requested_ = true;
  request.hold = d;
  if (d.reason == HoldReason::off) return d;
  // The stages of a frame teach the model, so they are measured apart.
  request.separateStages = true;
  request.levers.drawn = withBudget(request.levers.policy, d.held);
  return d;
}

/// Adds what a view draws with so many times the request's allowed error.
void FrameHold::collect(const FrameRequest& request, const LoadView& view, double errorScale) {
  if (formOf(request, *index_) == TerrainForm::static_trees) {
    StaticLodRule rule = staticLodRuleOf(request);
    rule.distancePerError /= errorScale;
    return collectNodes(*index_->trees, treeErrorOf(request.staticLod.error), view, rule, stack_,
                        nodesAhead_);
  }
  CutRule rule = cutKeyOf(request, view.eye.position, 1).rule;
  rule.maxErrorPx *= errorScale;
  collectNodes(*index_->tiles, view, rule, stack_, nodesAhead_);
}

std::span<const std::uint32_t> FrameHold::nodesAhead(const FrameRequest& drawn,
                                                     std::span<const ComingEye> coming) {
  nodesAhead_.clear();
  const std::optional<TerrainForm> form = index_ ? formOf(drawn, *index_) : std::nullopt;
  if (!form || *form == TerrainForm::patches || drawn.frozenEye) return {};
  const ComingEye here{drawn.eye, drawn.attitude};
  const LoadView last = viewOf(drawn, coming.empty() ? here : coming.back());
  collect(drawn, last, 1);
  if (drawn.hold.reason == HoldReason::off) return nodesAhead_;
  if (memory_.wantedError != memory_.steps.error)
    collect(drawn, last, errorAtPlace(memory_.wantedError, given_.asked.errorPx) / held_.errorPx);
  else
    collect(drawn, last, 2);
  return nodesAhead_;
}

void FrameHold::finished(const FrameResult& result, const FrameCost& cost) {
  const auto drawn = static_cast<double>(result.visible.triangles);
  lastTriangles_ = drawn;
  if (!std::exchange(requested_, false)) return;
  const double counted = trianglesAt(countedNow_, given_.asked.errorPx, held_.errorPx);
  FrameLoad load = loadOf(given_, held_, drawn);
  load.groundMpx = groundNowMpx_ * held_.renderScale * held_.renderScale;
  outcome_.reset();
  if (waiting_.size() > kImagesAhead) {
    const Prediction& p = waiting_.front();
    HoldOutcome o{kImagesAhead, 0, drawn, 0, 0, workMs(cost)};
    o.predictedTriangles = trianglesAt(p.triangles, given_.asked.errorPx, held_.errorPx);
    FrameLoad then = load;
    then.triangles = o.predictedTriangles;
    then.groundMpx = p.groundMpx * held_.renderScale * held_.renderScale;
    o.predictedMs = predict(p.cost, then).total();
    o.halfBandMs = p.cost.halfBandMs;
    if (p.known) outcome_ = o;
  }
  if (counted > 0 && drawn > 0) {
    constexpr double kGain = 0.2;
    correction_ += kGain * (std::clamp(drawn / counted, 0.05, 4.0) - correction_);
  }
  exchanged_ ? model_.leversMoved() : model_.observe(load, cost);
}

}  // namespace trimtab
