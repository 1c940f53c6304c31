#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "policy_bench.h"
#include "row.h"
#include "tests/core/fuzzy/fuzzylite_oracle.h"
#include "tests/support.h"
#include "trimtab/decision/decide.h"
#include "trimtab/host/flight.h"
#include "trimtab/measure/trace.h"
#include "trimtab/preset/preset.h"
#include "trimtab/session/session.h"
#include "trimtab/trimtab.h"

/// Group `decisions`: what deciding costs and how exact it is, over the sample flight.

namespace {
std::size_t allocations = 0;
}
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace trimtab::bench {
namespace {

const AltitudeParameters kAltitude;
const PitchParameters kPitch;
const SchemeParameters kScheme;

std::vector<FrameInput> inputsOf(const Flight& flight) {
  std::vector<FrameInput> inputs(flight.states.size());
  for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].state = flight.states[i];
  return inputs;
}

/// Total membership and depth-map width, summed: equal sums show that two ways decide alike.
struct Sums {
  double total = 0, width = 0;
};

/// The same decision as it is often written first: terms by name in a map, functions behind std::function,
/// curves and bands as maps. It has no hysteresis and gives no reasons.
class ByName {
 public:
  ByName() {
    for (const CurvePoint& p : kAltitude.curve.span()) curves_["altitude"][p.x] = p.y;
    for (const CurvePoint& p : kPitch.curve.span()) curves_["pitch"][p.x] = p.y;
    for (const Band& b : kScheme.bands.span()) bands_[b.low] = {b.widthPx, b.heightPx};
    for (const char* name : {"altitude", "pitch"})
      terms_[name] = [this, key = std::string(name)](double x) {
        const std::map<double, double>& curve = curves_.at(key);
        const auto after = curve.upper_bound(x);
        if (after == curve.begin()) return after->second;
        const auto before = std::prev(after);
        if (after == curve.end()) return before->second;
        return before->second +
               (after->second - before->second) * ((x - before->first) / (after->first - before->first));
      };
  }
  void decideAll(const std::vector<FrameInput>& inputs, Sums& sums) const {
    for (const FrameInput& input : inputs) {
      std::map<std::string, double> state{{"altitude", input.state.position.height.in<Feet>()},
                                          {"pitch", input.state.attitude.pitch.value()}};
      double total = 0;
      for (const auto& [name, term] : terms_) total += term(state.at(name));
      const auto band = bands_.upper_bound(total);
      sums.total += total;
      if (band != bands_.begin()) sums.width += std::prev(band)->second.first;
    }
  }

 private:
  std::map<std::string, std::map<double, double>> curves_;
  std::map<std::string, std::function<double(double)>> terms_;
  std::map<double, std::pair<int, int>> bands_;
};

Sums decideAll(const std::vector<FrameInput>& inputs, const ValidatedParameters& parameters) {
  Sums sums;
  DecisionMemory memory;
  for (const FrameInput& input : inputs) {
    const FrameDecision d = decide(input, parameters, memory);
    sums.total += d.totalMembership;
    sums.width += d.occlusionResolution ? d.occlusionResolution->widthPx : 0;
  }
  return sums;
}

void speed(Report& report, const std::vector<FrameInput>& inputs) {
  const int repeats = report.quick() ? 20 : 200;
  const auto decisions = static_cast<double>(inputs.size());
  TuningParameters plainParameters = *defaultParameters();
  plainParameters.scheme.hysteresis = Membership{0};
  const ValidatedParameters plain = *validate(plainParameters);
  Sums ours, theirs;
  const double mine = leastSeconds(repeats, [&] { keep(ours = decideAll(inputs, plain)); });
  const ByName byName;
  const double peer = leastSeconds(repeats, [&] {
    theirs = {};
    byName.decideAll(inputs, theirs);
    keep(theirs);
  });
  const bool alike = std::abs(ours.total - theirs.total) < 1e-6 && ours.width == theirs.width;
  Row row{"decisions.per_second",
          "decide() a second over the sample flight",
          decisions / mine,
          "1/s",
          alike ? "the same decisions by maps of names and std::function"
                : "a peer that decided otherwise: not valid",
          decisions / peer,
          "run"};
  if (!alike) row.ratio = NAN;
  report.add(ratioAtLeast(1, row));

  // The least that any way must do: read every state, write every decision.
  std::vector<FrameDecision> decisionsOut(inputs.size());
  const double copying = leastSeconds(repeats, [&] {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      decisionsOut[i].altitudeFt = inputs[i].state.position.height.value();
      decisionsOut[i].pitchDeg = inputs[i].state.attitude.pitch.value();
      keep(decisionsOut[i]);
    }
  });
  report.add(ratioAtMost(
      100, {"decisions.time", "time of one decide() against reading the state alone", mine / decisions * 1e9,
            "ns", "reading altitude and pitch of the same states", copying / decisions * 1e9, "run"}));
}

void exactness(Report& report, const std::vector<FrameInput>& inputs) {
  if (test::fuzzylitePresent()) {
    const test::Grid grid = test::gridFor(kAltitude, kPitch, 401, 251);
    std::string error;
    const auto theirs = test::byFuzzylite(kAltitude, kPitch, grid, error);
    double worst = theirs.size() == grid.size() ? 0 : NAN;
    std::size_t point = 0;
    if (theirs.size() == grid.size())
      for (const double a : grid.altitude)
        for (const double p : grid.pitch) {
          const test::FuzzyResult ours = test::byUs(kAltitude, kPitch, a, p);
          for (std::size_t i = 0; i < ours.size(); ++i)
            worst = std::max(worst, std::abs(ours[i] - theirs[point][i]));
          ++point;
        }
    report.add(valueAtMost(1e-9, {"decisions.fuzzylite_difference",
                                  "largest difference from fuzzylite over " + std::to_string(point) +
                                      " points, all combinations",
                                  worst, ""}));
  }

  // A trace of the flight, written, read and decided again.
  const ValidatedParameters parameters = defaultParameters();
  std::string text = traceHeader() + '\n';
  DecisionMemory memory;
  for (const FrameInput& input : inputs) {
    TraceRow row;
    row.input = input;
    row.before = memory;
    row.decision = decide(input, parameters, memory);
    row.frame = TraceFrame{};
    appendTraceRow(text, row);
  }
  const Result<std::vector<TraceRow>> trace = parseTrace(text, "trace");
  const double differing = trace && trace->size() == inputs.size()
                               ? static_cast<double>(decideAgain(*trace, parameters).size())
                               : NAN;
  report.add(valueAtMost(
      0, {"decisions.replay_differences",
          "decisions of the sample flight that differ after its trace is read back", differing, ""}));

  const std::size_t before = allocations;
  keep(decideAll(inputs, parameters));
  const std::size_t made = allocations - before;
  report.add(
      valueAtMost(0, {"decisions.allocations", "memory allocations of all decisions of the sample flight",
                      static_cast<double>(made), ""}));
}

void traceSpeed(Report& report, const std::vector<FrameInput>& inputs) {
  TraceRow row;
  row.frame = TraceFrame{};
  std::string text;
  text.reserve(1024 * inputs.size());
  const auto rows = static_cast<double>(inputs.size());
  const double mine = leastSeconds(report.quick() ? 3 : 20, [&] {
    text.clear();
    for (const FrameInput& input : inputs) {
      row.input = input;
      appendTraceRow(text, row);
    }
    keep(text);
  });
  // As many numbers as a row has, printed so that they read back.
  const auto columns = static_cast<int>(std::count(
                           text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find('\n')), ',')) +
                       1;
  const double peer = leastSeconds(report.quick() ? 3 : 20, [&] {
    text.clear();
    char cell[40];
    for (const FrameInput& input : inputs) {
      for (int i = 0; i < columns; ++i)
        text.append(cell,
                    static_cast<std::size_t>(std::snprintf(
                        cell, sizeof cell, "%.17g,", i < 8 ? input.state.position.latitude.value() : 0.0)));
      text += '\n';
    }
    keep(text);
  });
  report.add(ratioAtMost(1, {"decisions.trace_row", "time to write one row of a trace", mine / rows * 1e6,
                             "us", "as many numbers by snprintf %.17g", peer / rows * 1e6, "run"}));
}

/// A state through the C interface against Session::fly, with a policy.
void throughC(Report& report, const Flight& flight) {
  trimtab_preset* preset = nullptr;
  trimtab_session* session = nullptr;
  if (trimtab_preset_load("low-level", &preset, nullptr) != TRIMTAB_OK ||
      trimtab_session_create(preset, &session) != TRIMTAB_OK)
    return;
  std::vector<trimtab_state> states;
  for (const AircraftState& s : flight.states) {
    trimtab_state& state = states.emplace_back();
    state.size = sizeof state;
    trimtab_state_clear(&state);
    state.time_s = s.time;
    state.latitude_deg = s.position.latitude.value();
    state.longitude_deg = s.position.longitude.value();
    state.height_m = s.position.height.value();
    state.heading_deg = s.attitude.heading.value();
    state.pitch_deg = s.attitude.pitch.value();
    state.roll_deg = s.attitude.roll.value();
  }
  Session own(*validate(loadPreset("low-level")->parameters));
  const auto fly = [&] {
    for (const AircraftState& s : flight.states) own.fly(s);
  };
  const auto flyInC = [&] {
    for (const trimtab_state& s : states) trimtab_session_fly(session, &s);
  };
  const auto [direct, byC] = leastInTurn(report.quick() ? 3 : 20, std::pair{3, fly}, std::pair{3, flyInC});
  trimtab_session_free(session);
  trimtab_preset_free(preset);
  const auto decisions = static_cast<double>(states.size());
  report.add(ratioAtMost(
      1.5, {"decisions.through_c", "time of a decision through the C interface", byC / decisions * 1e6, "us",
            "Session::fly from C++ over the same states", direct / decisions * 1e6, "run"}));
}

}  // namespace
}  // namespace trimtab::bench

int main(int argc, char** argv) {
  using namespace trimtab;
  bench::Report report(argc, argv);
  const Result<Flight> flight = readFlight(test::sourceDir() / "resources/flights/yecheon-circuit.csv");
  if (!flight) {
    std::fprintf(stderr, "%s\n", toString(flight.findings()).c_str());
    return 1;
  }
  const std::vector<FrameInput> inputs = bench::inputsOf(*flight);
  if (report.wants("speed")) bench::speed(report, inputs);
  if (report.wants("policy")) bench::policies(report);
  if (report.wants("through_c")) bench::throughC(report, *flight);
  if (report.wants("trace")) bench::traceSpeed(report, inputs);
  if (report.wants("exactness")) bench::exactness(report, inputs);
  return report.finish();
}
