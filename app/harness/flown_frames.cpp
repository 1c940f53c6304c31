#include "flown_frames.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <deque>
#include <utility>

#include "trimtab/hold/arbiter.h"
#include "trimtab/measure/statistics.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/scene/load_index.h"
#include "trimtab/session/session.h"

namespace trimtab::harness {
namespace {

using Clock = std::chrono::steady_clock;
using experiment::blurs;
using experiment::kLongestTrace;

/// Returns the mean time of many decisions, each from the memory as the row met it: one takes less than a
/// clock tick.
double decideMilliseconds(const FrameInput& input, const ValidatedParameters& parameters,
                          const DecisionMemory& before) {
  constexpr int kRuns = 9, kDecisions = 16;
  SampleWindow window(kRuns);
  for (int run = 0; run < kRuns; ++run) {
    const auto start = Clock::now();
    for (int i = 0; i < kDecisions; ++i) {
      DecisionMemory memory = before;
      decide(input, parameters, memory);
    }
    window.add(std::chrono::duration<double, std::milli>(Clock::now() - start).count() / kDecisions);
  }
  return window.median();
}

/// Returns how long the slowest lever that the policy moves needs from one end of its range to the other,
/// seconds.
double crossingS(const CompiledPolicy& policy) {
  double seconds = 0;
  for (const LeverRow& row : kLeverRows) {
    if (!policy.moves(row.lever)) continue;
    const double way =
        row.logarithmic ? std::log2(row.hard.high / row.hard.low) : row.hard.high - row.hard.low;
    seconds = std::max(seconds, way / row.ratePerS);
  }
  return seconds;
}

/// Returns which rows of a flight are drawn so that their images are fed back, one flag for each row.
std::vector<bool> drawnRows(const Flying& flying, const Flight& flight, const Feedback& feedback,
                            const std::vector<std::size_t>& rows) {
  std::vector<bool> drawn(flight.states.size(), false);
  if (!feedback.any() || rows.empty()) return drawn;
  if (flying.whole) {
    std::fill_n(drawn.begin(), rows.back(), true);
    return drawn;
  }
  const auto& states = flight.states;
  for (const std::size_t row : rows)
    // Goes back until a row that was drawn for the row to measure before this one.
    for (std::size_t r = row; r-- > 0 && !drawn[r];) {
      const bool recent = states[row].time - states[r].time <= feedback.rememberedS;
      if (!recent && row - r > feedback.rememberedImages) break;
      drawn[r] = true;
    }
  return drawn;
}

std::size_t flightsOf(const Flying& flying, const Feedback& feedback) {
  return feedback.times ? std::max<std::size_t>(flying.repeats, 1) : 1;
}

/// The rows up to which a cost model learns this machine: some of those to measure, over the whole flight.
std::vector<std::size_t> rowsToLearn(const std::vector<std::size_t>& rows) {
  constexpr std::size_t kEnough = 8;
  const std::size_t every = std::max<std::size_t>(rows.size() / kEnough, 1);
  std::vector<std::size_t> learnt;
  for (std::size_t i = 0; i < rows.size(); i += every) learnt.push_back(rows[i]);
  return learnt;
}

std::vector<FlownFrame> framesOf(const Flight& flight, const std::vector<std::size_t>& rows) {
  std::vector<FlownFrame> frames;
  for (const std::size_t row : rows) frames.push_back({row, flight.states[row].time, 0, {}});
  return frames;
}

/// One flight of a preset, in a session of its own.
class Pilot {
 public:
  Pilot(experiment::Stage& stage, const Flying& flying, const ValidatedParameters& parameters,
        const CostModel& model)
      : stage_(stage),
        flying_(flying),
        parameters_(parameters),
        feedback_(feedbackOf(parameters)),
        session_(parameters) {
    session_.setGround(flying.terrain);
    if (!parameters->hold.enabled) return;
    session_.setLoadIndex(scene::loadIndexOf(flying.terrain));
    session_.hold().model() = model;
  }

  /// Flies up to the last of `rows` and adds an image to the frame of each; false if it was stopped.
  bool fly(const Flight& flight, const std::vector<std::size_t>& rows, std::vector<FlownFrame>& frames) {
    const std::vector<bool> drawn = drawnRows(flying_, flight, feedback_, rows);
    auto frame = frames.begin();
    for (std::size_t row = 0; row < flight.states.size() && frame != frames.end(); ++row) {
      const DecisionMemory memory = session_.memory();
      session_.fly(flight.states[row], flight.states[row].time);
      const bool measured = row == frame->row;
      // The arbiter decides only images that it hears of again.
      if (parameters_->hold.enabled && !drawn[row] && !measured) continue;
      // Only a session without a state has none.
      FrameRequest request = *session_.request(flight.states[row].time, flying_.widthPx, flying_.heightPx);
      if (measured) {
        if (frame->images.empty())
          frame->decideMs = decideMilliseconds(session_.input(), parameters_, memory);
        frame->images.push_back(imageOf(request));
        ++frame;
      }
      if (drawn[row]) {
        draw(request, flight.states[row].time);
        if (flying_.goOn && !flying_.goOn()) return false;
      }
      before_.push_back(std::move(request));
      if (before_.size() > kLongestTrace) before_.pop_front();
    }
    return true;
  }

  const CostModel& model() const { return session_.hold().model(); }

 private:
  FlownFrame::Image imageOf(const FrameRequest& request) const {
    const bool traces = blurs(request) || (!before_.empty() && blurs(before_.back()));
    const std::size_t kept = std::min<std::size_t>(before_.size(), traces ? kLongestTrace : 1);
    return {request, {before_.end() - static_cast<std::ptrdiff_t>(kept), before_.end()}};
  }

  /// Draws alike at every run where time decides nothing, so that counts depend on the requests alone.
  void draw(const FrameRequest& request, double time) {
    session_.finished(feedback_.times ? stage_.fly(request) : stage_.draw(request), time);
    if (parameters_->hold.enabled)
      session_.builtAhead(stage_.buildAhead(session_.nodesAhead(request), session_.aheadMs()).left);
  }

  experiment::Stage& stage_;
  const Flying& flying_;
  const ValidatedParameters& parameters_;
  const Feedback feedback_;
  Session session_;
  std::deque<FrameRequest> before_;
};

}  // namespace

Feedback feedbackOf(const ValidatedParameters& parameters) {
  Feedback feedback;
  const auto remember = [&feedback](double seconds, std::size_t images) {
    feedback.rememberedS = std::max(feedback.rememberedS, seconds);
    feedback.rememberedImages = std::max(feedback.rememberedImages, images);
  };
  if (const CompiledPolicy* policy = parameters.policy()) {
    feedback.counts = policy->asks(Signal::triangles);
    feedback.times = policy->asks(Signal::load);
    // A lever that moves changes what is drawn, which may move it back.
    if (feedback.any()) remember(2 * crossingS(*policy), ImageSignals::kLoadImages);
  }
  const MotionParameters& motion = parameters->motion;
  if (motion.control != MotionControl::off && motion.frames == MotionFrames::drawn &&
      motion.lodOverVertices.value() > 0) {
    feedback.counts = true;
    remember(0, kLongestTrace);
  }
  if (parameters->hold.enabled) {
    feedback.times = true;
    remember(rememberedMs(parameters->hold) / 1e3, ImageSignals::kLoadImages);
  }
  return feedback;
}

std::vector<std::size_t> sampledRows(const Flight& flight, const terrain::Database& terrain,
                                     std::size_t count) {
  std::vector<std::size_t> over;
  for (std::size_t i = 0; i < flight.states.size(); ++i)
    if (scene::liesOver(terrain.info(), flight.states[i].position)) over.push_back(i);
  if (over.size() <= count) return over;
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < count; ++k) rows.push_back(over[(2 * k + 1) * over.size() / (2 * count)]);
  return rows;
}

std::size_t imagesToFly(const Flying& flying, const Flight& flight, const ValidatedParameters& parameters,
                        const std::vector<std::size_t>& rows) {
  const Feedback feedback = feedbackOf(parameters);
  const auto images = [&](const std::vector<std::size_t>& upTo) {
    const std::vector<bool> drawn = drawnRows(flying, flight, feedback, upTo);
    return static_cast<std::size_t>(std::count(drawn.begin(), drawn.end(), true));
  };
  return images(rows) * flightsOf(flying, feedback) +
         (parameters->hold.enabled ? images(rowsToLearn(rows)) : 0);
}

std::optional<std::vector<FlownFrame>> flyFrames(experiment::Stage& stage, const Flying& flying,
                                                 const Flight& flight, const ValidatedParameters& parameters,
                                                 const std::vector<std::size_t>& rows) {
  std::vector<FlownFrame> frames = framesOf(flight, rows);
  CostModel model;
  if (parameters->hold.enabled) {
    const std::vector<std::size_t> learnt = rowsToLearn(rows);
    std::vector<FlownFrame> ignored = framesOf(flight, learnt);
    Pilot pilot(stage, flying, parameters, model);
    if (!pilot.fly(flight, learnt, ignored)) return std::nullopt;
    model = pilot.model();
  }
  const std::size_t flights = flightsOf(flying, feedbackOf(parameters));
  for (std::size_t i = 0; i < flights; ++i)
    if (!Pilot(stage, flying, parameters, model).fly(flight, rows, frames)) return std::nullopt;
  return frames;
}

}  // namespace trimtab::harness
