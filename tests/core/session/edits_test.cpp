#include <gtest/gtest.h>

#include <bit>
#include <functional>

#include "tests/support.h"
#include "trimtab/frame/frame_result.h"
#include "trimtab/host/received_state.h"
#include "trimtab/session/session.h"

namespace trimtab {
namespace {

constexpr double kPacketHz = 60, kAfterHostS = 1000;

/// A preset with head motion, and with a policy that asks for the head's rate or without any.
TuningParameters headPreset(bool policy) {
  TuningParameters p;
  p.motion.control = MotionControl::with_restoration;
  p.policy.enabled = policy;
  if (policy) {
    p.policy.terms.line = {"head_rate fast = ramp 20 120", "sight_rate fast = ramp 20 120"};
    p.policy.rules.line = {"if head_rate is fast then lod_scale = 2",
                           "if sight_rate is fast then render_scale = 0.5"};
  }
  return p;
}

ValidatedParameters runnable(const TuningParameters& parameters) {
  const auto validated = validate(parameters);
  EXPECT_TRUE(validated) << toString(validated.findings());
  return *validated;
}

AircraftState stateOfPacket(int packet) {
  AircraftState state;
  state.time = packet / kPacketHz;
  state.packet = static_cast<std::uint64_t>(packet) + 1;
  state.position = {Degrees{36.6 + packet * 1e-5}, Degrees{128.3}, Metres{1500}};
  state.attitude = {Degrees{90 + 5 * state.time}, Degrees{2}, Degrees{0}};
  return state;
}

/// How the states come: of a flight, over a link, or of a free camera.
using Give = std::function<void(Session&, const AircraftState&)>;
const std::pair<const char*, Give> kWaysOfStates[] = {
    {"a flight", [](Session& s, const AircraftState& state) { s.fly(state, state.time); }},
    {"a host",
     [](Session& s, const AircraftState& state) {
       const double arrival = state.time + kAfterHostS;
       s.receive(std::vector{ReceivedState{state, arrival, arrival}});
     }},
    {"the free camera", [](Session& s, const AircraftState& state) { s.look(state); }}};

/// What an edit must not change, whatever it is of. Triangles and load follow the image.
struct UntouchedByEdits {
  SignalValues signals;
  double rateDegPerS = 0;
  bool fast = false;
  MotionReason reason = MotionReason::off;
  MotionMemory memory;
};

UntouchedByEdits seenIn(const Session& session) {
  const MotionDecision& motion = session.decision().motion;
  return {session.signalValues(), motion.rateDegPerS, motion.fast, motion.reason, session.memory().motion};
}

void expectSame(const UntouchedByEdits& a, const UntouchedByEdits& b, const std::string& when) {
  for (const SignalRow& row : kSignalRows) {
    if (row.signal == Signal::triangles || row.signal == Signal::load) continue;
    const double left = a.signals[row.signal], right = b.signals[row.signal];
    EXPECT_EQ(std::bit_cast<std::uint64_t>(left), std::bit_cast<std::uint64_t>(right))
        << when << ": " << row.key << " " << left << " and " << right;
  }
  EXPECT_EQ(a.rateDegPerS, b.rateDegPerS) << when;
  EXPECT_EQ(a.fast, b.fast) << when;
  EXPECT_EQ(a.reason, b.reason) << when;
  EXPECT_EQ(a.memory, b.memory) << when;
}

Session sweptSession(const TuningParameters& parameters, bool watched) {
  Session session(runnable(parameters));
  if (watched) session.watchSignals();
  session.head().useLog(*parseSweep("sweep:120/1s/0.5"));
  return session;
}

void drawImage(Session& session, double now) {
  FrameResult result;
  result.cost.total = 12;
  result.visible.triangles = 5000;
  ASSERT_TRUE(session.request(now, 64, 64));
  session.finished(result, now);
}

/// Edits of what has nothing to do with the head, some between every two packets, as a drag makes them.
TEST(SessionEdit, disturbsNoSignalWhileTheHeadMoves) {
  for (const auto& [way, give] : kWaysOfStates)
    for (const bool policy : {false, true})
      for (const bool watched : {true, false}) {
        const TuningParameters parameters = headPreset(policy);
        Session plain = sweptSession(parameters, watched), edited = sweptSession(parameters, watched);
        double fastest = 0;
        for (int packet = 0; packet < 240; ++packet) {
          const AircraftState state = stateOfPacket(packet);
          const double now = state.time + kAfterHostS;
          const std::string when =
              std::string(way) + (policy ? ", a policy" : "") + ", packet " + std::to_string(packet);
          give(plain, state);
          give(edited, state);
          expectSame(seenIn(edited), seenIn(plain), when);
          for (int edit = 0; edit < packet % 4; ++edit) {
            TuningParameters other = parameters;
            other.lod.screenSpaceError = Pixels{1.0 + edit};
            other.scheme.hysteresis = Membership{0.01 * (packet % 5)};
            other.measure.budget = Milliseconds{10.0 + edit};
            edited.setParameters(runnable(other));
            expectSame(seenIn(edited), seenIn(plain), when + ", after an edit");
            drawImage(edited, now);
          }
          drawImage(plain, now);
          drawImage(edited, now);
          fastest = std::max(fastest, plain.decision().motion.rateDegPerS);
          if (HasFailure()) return;
        }
        EXPECT_GT(fastest, 100) << "the head must turn, or nothing is shown";
      }
}

TEST(SessionEdit, ofHeadMotionDecidesTheLastTurnAnew) {
  Session session = sweptSession(headPreset(false), true);
  int packet = 0;
  while (session.decision().motion.rateDegPerS < 100) session.fly(stateOfPacket(packet++));
  const double rate = session.decision().motion.rateDegPerS;
  ASSERT_TRUE(session.decision().motion.fast);
  TuningParameters wide = headPreset(false);
  wide.motion.leftFov = wide.motion.rightFov = Degrees{rate / 2};
  session.setParameters(runnable(wide));
  EXPECT_EQ(session.decision().motion.rateDegPerS, rate);
  EXPECT_FALSE(session.decision().motion.fast);
  session.setParameters(runnable(headPreset(false)));
  EXPECT_TRUE(session.decision().motion.fast);
}

}  // namespace
}  // namespace trimtab
