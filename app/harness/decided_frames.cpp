#include "decided_frames.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <deque>
#include <utility>

#include "trimtab/measure/statistics.h"
#include "trimtab/scene/data_extent.h"
#include "trimtab/session/session.h"
#include "trimtab/terrain/format/database.h"

namespace trimtab::harness {
namespace {

using Clock = std::chrono::steady_clock;

/// Rows that a blur can reach back over at 60 Hz and its longest; older ones have no trace left.
constexpr std::size_t kLongestTrace = 64;

/// A decision takes less than a clock tick: many, each from the memory as the row met it.
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

bool blurs(const FrameRequest& request) {
  return request.decision.motion.blur.strength > 0;
}

}  // namespace

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

std::vector<DecidedFrame> decideFrames(const Plan& plan, const Plan::NamedFlight& flight,
                                       const ValidatedParameters& parameters,
                                       const std::vector<std::size_t>& rows) {
  Session session(parameters);
  session.setGround(plan.terrain);
  const auto& states = flight.flight.states;
  std::vector<DecidedFrame> frames;
  std::deque<FrameRequest> before;
  auto wanted = rows.begin();
  for (std::size_t row = 0; row < states.size() && wanted != rows.end(); ++row) {
    const bool first = row == 0;
    const DecisionMemory memory =
        first && !flight.trace.empty() ? flight.trace.front().before : session.memory();
    if (flight.trace.empty())
      session.fly(states[row], states[row].time);
    else
      session.replay(flight.trace[row]);
    auto request = session.request(session.input().state.time, plan.widthPx, plan.heightPx);
    // Only a session without a state has none.
    assert(request);
    if (row == *wanted) {
      ++wanted;
      DecidedFrame frame;
      frame.row = row;
      frame.timeS = states[row].time;
      frame.decideMs = decideMilliseconds(session.input(), parameters, memory);
      const bool traces = blurs(*request) || (!before.empty() && blurs(before.back()));
      const std::size_t kept = std::min<std::size_t>(before.size(), traces ? kLongestTrace : 1);
      frame.before.assign(before.end() - static_cast<std::ptrdiff_t>(kept), before.end());
      frame.request = *request;
      frames.push_back(std::move(frame));
    }
    before.push_back(*std::move(request));
    if (before.size() > kLongestTrace) before.pop_front();
  }
  return frames;
}

}  // namespace trimtab::harness
