#include <cmath>
#include <cstdio>
#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/link/log_options.h"
#include "commands.h"
#include "settings.h"
#include "trimtab/decision/decide.h"
#include "trimtab/measure/trace.h"
#include "trimtab/policy/compiled_policy.h"
#include "trimtab/preset/policy_lines.h"
#include "trimtab/session/session.h"
#include "trimtab/units/number.h"

namespace trimtab::cli {
namespace {

using Json = nlohmann::ordered_json;

struct DecideOptions {
  std::string preset = "default", flight, columns;
  std::vector<std::string> settings;
  std::optional<double> altitudeFt, pitchDeg, aboveGroundFt;
  double rollDeg = 0, headingDeg = 0;
  bool json = false, csv = false;
};

/// Holds what one run decides: rows in order, and for a trace how many came out as they were recorded.
struct Decided {
  std::vector<TraceRow> rows;
  std::optional<std::size_t> asRecorded;
};

/// Decides as an IG does. `feed` gives the session one state.
template <class Feed>
TraceRow decidedRow(Session& session, const Feed& feed) {
  TraceRow row;
  row.before = session.memory();
  feed();
  row.input = session.input();
  row.decision = session.decision();
  row.levers = leversOf(row.decision, *session.parameters());
  return row;
}

/// The altitude is the one that the preset's reference asks for, unless the height above ground is given
/// apart.
Result<Decided> decideOne(const DecideOptions& options, const ValidatedParameters& parameters) {
  Findings findings;
  // Checks what a flight's row may say.
  const auto check = [&findings](const char* option, std::optional<double> value, double low, double high,
                                 const char* unit) {
    if (!value || (*value >= low && *value <= high)) return;
    findings.push_back({Severity::error, option, "", numberText(low) + ".." + numberText(high) + ' ' + unit,
                        numberText(*value)});
  };
  constexpr double kLowestFt = -66000, kHighestFt = 3.3e6;
  check("--altitude-ft", options.altitudeFt, kLowestFt, kHighestFt, "ft");
  check("--pitch-deg", options.pitchDeg, -90, 90, "deg");
  check("--roll-deg", options.rollDeg, -360, 360, "deg");
  check("--heading-deg", options.headingDeg, -360, 360, "deg");
  check("--above-ground-ft", options.aboveGroundFt, -kHighestFt, kHighestFt, "ft");
  if (!findings.empty()) return findings;

  AircraftState state;
  state.position.height = Feet{*options.altitudeFt}.as<Metres>();
  state.attitude = {Degrees{options.headingDeg}, Degrees{*options.pitchDeg}, Degrees{options.rollDeg}};
  state.aboveGround = Feet{options.aboveGroundFt.value_or(*options.altitudeFt)}.as<Metres>();
  Session session(parameters);
  return Decided{{decidedRow(session, [&] { session.fly(state); })}, std::nullopt};
}

Result<Decided> decideTrace(const std::string& file, const ValidatedParameters& parameters) {
  Result<std::vector<TraceRow>> trace = readTrace(file);
  if (!trace) return trace.findings();
  Decided decided{std::move(*trace), 0};
  Session session(parameters);
  for (TraceRow& row : decided.rows) {
    const TraceRow recorded = row;
    row = decidedRow(session, [&] { session.replay(recorded); });
    if (&row == &decided.rows.front()) row.before = recorded.before;
    row.frame = recorded.frame;
    row.hold = recorded.hold;
    if (row.hold) row.levers.drawn = withBudget(row.levers.policy, row.hold->held);
    if (row.decision == recorded.decision) ++*decided.asRecorded;
  }
  return Result<Decided>(std::move(decided), trace.findings());
}

Result<Decided> decideFlight(const DecideOptions& options, const ValidatedParameters& parameters) {
  if (isTraceFile(options.flight)) return decideTrace(options.flight, parameters);
  const Result<Flight> flight = link::openFlightOption(options.flight, options.columns);
  if (!flight) return flight.findings();
  Decided decided;
  decided.rows.reserve(flight->states.size());
  Session session(parameters);
  for (const AircraftState& state : flight->states)
    decided.rows.push_back(decidedRow(session, [&] { session.fly(state, state.time); }));
  return Result<Decided>(std::move(decided), flight.findings());
}

/// A rule that fires, and its share in each lever that it sets.
struct FiredRule {
  std::size_t rule = 0;  ///< from 0
  double firing = 0;
  std::vector<std::pair<Lever, double>> shares;
};

std::vector<FiredRule> firedRules(const TraceRow& row, const CompiledPolicy& policy) {
  PolicyDecision decision;
  policy.decide(row.input.signalValues, decision);
  std::vector<FiredRule> fired;
  for (std::size_t i = 0; i < decision.firing.size(); ++i) {
    if (!(decision.firing[i] > 0)) continue;
    FiredRule rule{i, decision.firing[i], {}};
    for (const LeverRow& lever : kLeverRows)
      if (const double share = policy.share(i, lever.lever, decision); share > 0)
        rule.shares.emplace_back(lever.lever, share);
    fired.push_back(std::move(rule));
  }
  return fired;
}

/// Returns what the policy made of the signals; null without one. Rules have their numbers, from 1.
Json policyJson(const TraceRow& row, const CompiledPolicy* policy) {
  if (policy == nullptr) return nullptr;
  const PolicyOutcome& outcome = row.decision.policy;
  Json levers = Json::object(), signals = Json::object(), unknown = Json::array(), rules = Json::array();
  for (const LeverRow& lever : kLeverRows)
    if (outcome.moves(lever.lever)) levers[std::string(lever.key)] = outcome[lever.lever];
  for (const SignalRow& signal : kSignalRows) {
    const double value = row.input.signalValues[signal.signal];
    signals[std::string(signal.key)] = std::isnan(value) ? Json(nullptr) : Json(value);
    if (outcome.unknownAsked >> indexOf(signal.signal) & 1) unknown.push_back(signal.key);
  }
  for (const FiredRule& fired : firedRules(row, *policy)) {
    Json shares = Json::object();
    for (const auto& [lever, share] : fired.shares) shares[std::string(rowOf(lever).key)] = share;
    rules.push_back({{"rule", fired.rule + 1}, {"firing", fired.firing}, {"shares", std::move(shares)}});
  }
  return {{"levers", std::move(levers)},
          {"signals", std::move(signals)},
          {"unknown_asked", std::move(unknown)},
          {"rules", std::move(rules)}};
}

/// Every lever after each step of the chain, and which step changed it last.
Json chainJson(const LeverChain& chain) {
  Json levers = Json::object();
  for (const FrameLeverRow& row : kFrameLeverRows) {
    Json lever = Json::object();
    for (std::size_t i = 0; i < kLeverSteps; ++i) {
      const auto step = static_cast<LeverStep>(i);
      const double value = valueOf(chain.after(step), row);
      lever[std::string(toText(step))] = std::isfinite(value) ? Json(value) : Json(nullptr);
    }
    lever["changed_by"] = toText(lastChange(chain, row));
    levers[std::string(row.key)] = std::move(lever);
  }
  return levers;
}

/// Returns the policy's rules as text; none if it is switched off.
std::vector<std::string> ruleTexts(const ValidatedParameters& parameters) {
  std::vector<std::string> texts;
  const auto policy = policyOf(parameters->policy);
  if (parameters.policy() != nullptr && policy)
    for (const PolicyRule& rule : policy->rules) texts.push_back(ruleText(rule));
  return texts;
}

Json toJson(const TraceRow& row, const ValidatedParameters& parameters) {
  const FrameDecision& d = row.decision;
  const LeverChain& levers = row.levers;
  return {{"altitude_ft", d.altitudeFt},
          {"pitch_deg", d.pitchDeg},
          {"altitude_membership", d.altitudeMembership},
          {"pitch_membership", d.pitchMembership},
          {"total_membership", d.totalMembership},
          {"scheme", toText(d.scheme)},
          {"band", d.band},
          {"depth_map_px", d.occlusionResolution
                               ? Json{d.occlusionResolution->widthPx, d.occlusionResolution->heightPx}
                               : Json(nullptr)},
          {"lod_scale", levers.policy.lodScale},
          {"levers", chainJson(levers)},
          {"reason", toText(d.reason)},
          {"policy", policyJson(row, parameters.policy())},
          {"explanation", explain(d, parameters)}};
}

bool sameOutcome(const FrameDecision& a, const FrameDecision& b) {
  return a.scheme == b.scheme && a.band == b.band;
}

std::size_t changes(const std::vector<TraceRow>& rows) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < rows.size(); ++i) count += !sameOutcome(rows[i - 1].decision, rows[i].decision);
  return count;
}

void printJson(const DecideOptions& options, const Decided& decided, const ValidatedParameters& parameters) {
  if (options.flight.empty()) {
    Json document = toJson(decided.rows.front(), parameters);
    document["policy_rules"] = ruleTexts(parameters);
    std::cout << document.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
    return;
  }
  Json list = Json::array();
  for (const TraceRow& row : decided.rows) {
    Json entry{{"time_s", row.input.state.time}, {"packet", row.input.state.packet}};
    entry.update(toJson(row, parameters));
    list.push_back(std::move(entry));
  }
  Json document{{"preset", options.preset},
                {"flight", options.flight},
                {"rows", decided.rows.size()},
                {"changes", changes(decided.rows)},
                {"as_recorded", decided.asRecorded ? Json(*decided.asRecorded) : Json(nullptr)},
                {"policy_rules", ruleTexts(parameters)},
                {"decisions", std::move(list)}};
  std::cout << document.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
}

/// Prints a flight's decisions as a trace; it flies again.
void printCsv(const Decided& decided) {
  std::string text = traceHeader() + '\n';
  for (const TraceRow& row : decided.rows) appendTraceRow(text, row);
  std::cout << text;
}

/// "  rule 2 fires 0.500 (LOD scale 40 %): if ..."
void printFiredRules(const TraceRow& row, const ValidatedParameters& parameters) {
  if (parameters.policy() == nullptr) return;
  const std::vector<std::string> texts = ruleTexts(parameters);
  for (const FiredRule& fired : firedRules(row, *parameters.policy())) {
    std::string shares;
    for (const auto& [lever, share] : fired.shares)
      shares += (shares.empty() ? "" : ", ") + std::string(rowOf(lever).label) + " " +
                numberText(100 * share, 3) + " %";
    std::cout << "  rule " << fired.rule + 1 << " fires " << numberText(fired.firing, 3) << " (" << shares
              << "): " << texts[fired.rule] << '\n';
  }
}

void printText(const DecideOptions& options, const Decided& decided, const ValidatedParameters& parameters) {
  if (options.flight.empty()) {
    std::cout << explain(decided.rows.front().decision, parameters) << '\n';
    printFiredRules(decided.rows.front(), parameters);
    return;
  }
  const FrameDecision* last = nullptr;
  for (const TraceRow& row : decided.rows) {
    if (!last || !sameOutcome(*last, row.decision))
      std::printf("%10.3f s  %s\n", row.input.state.time, explain(row.decision, parameters).c_str());
    last = &row.decision;
  }
  std::printf("%zu rows, %zu changes\n", decided.rows.size(), changes(decided.rows));
  if (decided.asRecorded)
    std::printf("%zu of %zu decisions are as the trace recorded them\n", *decided.asRecorded,
                decided.rows.size());
  std::fflush(stdout);
}

int run(const DecideOptions& options) {
  const std::optional<ValidatedParameters> parameters = parametersFor(options.preset, options.settings);
  if (!parameters) return kRefused;
  const Result<Decided> decided =
      options.flight.empty() ? decideOne(options, *parameters) : decideFlight(options, *parameters);
  report(decided.findings());
  if (!decided) return kRefused;
  if (options.json)
    printJson(options, *decided, *parameters);
  else if (options.csv)
    printCsv(*decided);
  else
    printText(options, *decided, *parameters);
  std::cout.flush();
  return std::cout ? kDone : kRefused;
}

}  // namespace

void addDecide(CLI::App& app, int& exitCode) {
  auto options = std::make_shared<DecideOptions>();
  CLI::App* command =
      app.add_subcommand("decide", "Decide scheme and depth-map size for one state or for a flight");
  command->add_option("--preset", options->preset, "A shipped preset's name or a preset file")
      ->capture_default_str();
  CLI::Option* flight = command->add_option("--flight", options->flight, "A flight, a capture or a trace");
  command->add_option("--columns", options->columns, link::kColumnsHelp)->needs(flight);
  CLI::Option* altitude = command->add_option("--altitude-ft", options->altitudeFt,
                                              "Altitude, above what the preset's altitude reference says");
  CLI::Option* pitch = command->add_option("--pitch-deg", options->pitchDeg, "Pitch, nose up positive");
  CLI::Option* ground = command->add_option("--above-ground-ft", options->aboveGroundFt,
                                            "Height above ground, where it differs");
  command->add_option("--roll-deg", options->rollDeg,
                      "Roll, right wing down positive; recorded, not decided by");
  command->add_option("--heading-deg", options->headingDeg, "Heading; recorded, not decided by");
  command->add_option("--set", options->settings, "KEY=VALUE: one parameter, whatever the preset says");
  CLI::Option* json = command->add_flag(
      "--json", options->json,
      "One JSON document. With a policy each decision has `policy`: the value of each lever that rules set, "
      "the signals (null if nobody knows them), the unknown ones that rules ask for, and the rules that "
      "fire, "
      "by their number in `policy_rules`, with their share in each lever");
  CLI::Option* csv = command->add_flag(
      "--csv", options->csv,
      "A decision trace, which flies again; with a policy it has columns of signals and levers. Which rules "
      "fire follows from the signals: decide the trace with --json");
  altitude->needs(pitch);
  pitch->needs(altitude);
  ground->needs(altitude);
  flight->excludes(altitude);
  json->excludes(csv);
  command->callback([options, &exitCode] {
    if (options->flight.empty() && !options->altitudeFt)
      throw CLI::RequiredError("--flight, or --altitude-ft and --pitch-deg");
    exitCode = run(*options);
  });
}

}  // namespace trimtab::cli
