#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "tests/support.h"
#include "trimtab/decision/decide.h"
#include "trimtab/host/flight.h"
#include "trimtab/measure/trace.h"
#include "trimtab/motion/head_motion.h"
#include "trimtab/preset/preset.h"
#include "trimtab/session/session.h"
#include "trimtab/trimtab.h"

// libtrimtab from outside, by programs in C, C++ and Python, beside the session in C++.
namespace trimtab::test {
namespace {

constexpr std::size_t kStates = 36000;
const std::string kHere = (sourceDir() / "tests/core/interface").string();

std::string digits(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

ValidatedParameters shipped(const char* name) {
  return *validate(loadPreset(name)->parameters);
}

/// A recorded flight, again and again, with a head that sweeps.
std::vector<AircraftState> states() {
  const Result<Flight> flight = readFlight(sourceDir() / "resources/flights/kansai-valley.csv");
  EXPECT_TRUE(flight) << toString(flight.findings());
  std::vector<AircraftState> all;
  for (std::size_t i = 0; all.size() < kStates; ++i) {
    AircraftState state;
    const AircraftState& flown = flight->states[i % flight->states.size()];
    state.position = flown.position;
    state.attitude = flown.attitude;
    state.packet = i;
    state.time = 0.1 * static_cast<double>(i);
    if (i % 1000 < 500)
      state.head = Attitude{Degrees{60 * std::sin(static_cast<double>(i) / 40)}, Degrees{-5}, Degrees{0}};
    all.push_back(state);
  }
  return all;
}

std::string tableOf(const std::vector<AircraftState>& states) {
  std::string table;
  for (const AircraftState& s : states) {
    const Attitude none{Degrees{NAN}, Degrees{NAN}, Degrees{NAN}}, head = s.head.value_or(none);
    for (const double value :
         {s.time, s.position.latitude.value(), s.position.longitude.value(), s.position.height.value(),
          s.attitude.heading.value(), s.attitude.pitch.value(), s.attitude.roll.value(), head.heading.value(),
          head.pitch.value(), head.roll.value()})
      table += digits(value) + ' ';
    table.back() = '\n';
  }
  return table;
}

/// What examples/decide.c prints, by the session in C++.
std::string bySession(const std::vector<AircraftState>& states, const char* preset) {
  Session session(shipped(preset));
  std::string lines;
  std::uint64_t packet = 0;
  for (const AircraftState& state : states) {
    session.fly(state);
    const std::optional<FrameRequest> request = session.request(state.time, 1280, 720);
    for (const FrameLeverRow& row : kFrameLeverRows)
      lines += digits(valueOf(request->levers.drawn, row)) + ' ';
    const FrameDecision& d = request->decision;
    (((((lines += toText(d.scheme)) += ' ') += toText(d.reason)) += ' ') += toText(d.motion.reason)) += '\n';
    FrameResult result;
    result.cost.total = NAN;
    result.visible.triangles = 20000 + 1000 * (++packet % 300);
    session.finished(result, state.time);
  }
  return lines;
}

/// Compiles a program of this folder as its users do.
std::string built(const std::string& file, const ScratchDir& dir) {
  const std::string out = (dir / std::filesystem::path(file).filename().string()).string() + ".out";
  const std::string compiler = file.ends_with(".c") ? "cc -std=c99" : TRIMTAB_CXX " -std=c++17";
  const Ran ran = run(compiler + " -Wall -Wextra -pedantic -Werror -I" + sourceDir().string() +
                      "/core/interface/include " + kHere + '/' + file + " -o " + out +
                      " -L" TRIMTAB_LIBRARY_DIR " -ltrimtab -lm -Wl,-rpath," TRIMTAB_LIBRARY_DIR);
  EXPECT_EQ(ran.exitCode, 0) << ran.err;
  return out;
}

TEST(Interface, decidesAsTheSessionToTheBitFromCCppAndPython) {
  const ScratchDir dir;
  const std::vector<AircraftState> flown = states();
  const std::string table = (dir / "states.txt").string();
  writeFile(table, tableOf(flown));
  const std::string programs[] = {built("examples/decide.c", dir), built("examples/decide.cpp", dir),
                                  "python3 " + kHere + "/examples/decide.py " TRIMTAB_LIBRARY};
  for (const char* preset : {"default", "helmet-search"}) {
    const std::string expected = bySession(flown, preset);
    ASSERT_EQ(static_cast<std::size_t>(std::count(expected.begin(), expected.end(), '\n')), kStates);
    for (const std::string& program : programs) {
      const Ran ran = run(program + ' ' + preset + ' ' + table);
      EXPECT_EQ(ran.exitCode, 0) << ran.err;
      EXPECT_TRUE(ran.out == expected) << program << " decides otherwise with " << preset;
    }
  }
}

TEST(Interface, allocatesNothingAFrame) {
  const ScratchDir dir;
  const std::string program = built("allocations.c", dir);
  for (const char* preset : {"default", "low-level", "helmet-search"}) {
    const Ran ran = run(program + ' ' + preset);
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    EXPECT_EQ(ran.out, "0\n") << preset;
  }
}

/// A session of a shipped preset, through C.
struct Made {
  explicit Made(const char* nameOrFile = "default") {
    EXPECT_EQ(trimtab_preset_load(nameOrFile, &preset, nullptr), TRIMTAB_OK);
    EXPECT_EQ(trimtab_session_create(preset, &session), TRIMTAB_OK);
  }
  ~Made() {
    trimtab_session_free(session);
    trimtab_preset_free(preset);
  }
  std::string explained() const {
    char text[400];
    trimtab_session_explain(session, text, sizeof text);
    return text;
  }
  trimtab_preset* preset = nullptr;
  trimtab_session* session = nullptr;
};

TEST(Interface, loadsExportsInAllFormatsAndSaysWhatIsWrong) {
  const ScratchDir dir;
  for (const ExportFormat format : {ExportFormat::json, ExportFormat::xml, ExportFormat::ini}) {
    std::string text = exportText(shipped("low-level"), "low-level", Provenance{}, format);
    trimtab_preset* preset = nullptr;
    EXPECT_EQ(trimtab_preset_parse(text.data(), text.size(), "export", &preset, nullptr), TRIMTAB_OK);
    trimtab_preset_free(preset);
    preset = nullptr;
    text.replace(text.find("low-level"), 3, "LOW");
    trimtab_findings* findings = nullptr;
    EXPECT_EQ(trimtab_preset_parse(text.data(), text.size(), "export", &preset, &findings), TRIMTAB_REFUSED);
    EXPECT_EQ(preset, nullptr);
    trimtab_finding finding{};
    finding.size = sizeof finding;
    ASSERT_EQ(trimtab_findings_get(findings, 0, &finding), TRIMTAB_OK);
    EXPECT_EQ(finding.severity, 2);
    EXPECT_NE(std::string(finding.where).find("export"), std::string::npos);
    EXPECT_EQ(trimtab_findings_get(findings, 1000, &finding), TRIMTAB_MISUSE);
    trimtab_findings_free(findings);
  }
}

TEST(Interface, writesATraceThatReplaysToTheBit) {
  const ScratchDir dir;
  const std::string file = (dir / "trace.csv").string();
  const Made made;
  ASSERT_EQ(trimtab_session_trace_start(made.session, file.c_str(), nullptr), TRIMTAB_OK);
  trimtab_state s{};
  s.size = sizeof s;
  trimtab_state_clear(&s);
  s.height_m = 1500;
  for (; s.time_s < 3; s.time_s += 0.1) ASSERT_EQ(trimtab_session_fly(made.session, &s), TRIMTAB_OK);
  ASSERT_EQ(trimtab_session_trace_finish(made.session, nullptr), TRIMTAB_OK);
  EXPECT_GT(readFile(file).size(), 1000u);
  const auto trace = readTrace(file);
  ASSERT_TRUE(trace) << toString(trace.findings());
  ASSERT_EQ(trace->size(), 30u);
  Session session(shipped("default"));
  for (const TraceRow& row : *trace) {
    session.replay(row);
    EXPECT_EQ(session.decision(), row.decision);
  }
  EXPECT_EQ(made.explained(), explain(session.decision(), session.parameters()));
}

/// An IG whose triangles fall by some power of the allowed error, which nobody told the library.
TEST(Interface, holdsABudgetByWhatTheProgramReports) {
  constexpr double kBudgetMs = 14;
  constexpr int kImages = 800, kLearning = 150;
  TuningParameters p;
  p.hold.enabled = true;
  p.measure.budget = Milliseconds{kBudgetMs};
  const ScratchDir dir;
  const std::string file = (dir / "held.json").string();
  writeFile(file, exportText(*validate(p), "held", {}, ExportFormat::json));
  for (const double power : {0.7, 1.4}) {
    const Made made(file.c_str());
    trimtab_state s{};
    s.size = sizeof s;
    trimtab_state_clear(&s);
    trimtab_frame frame{};
    frame.size = sizeof frame;
    trimtab_frame_clear(&frame);
    std::mt19937 random(3);
    int over = 0;
    for (int i = 0; i < kImages; ++i) {
      s.time_s = i / 60.0;
      s.packet = static_cast<std::uint64_t>(i);
      s.height_m = 1500;
      s.latitude_deg = 1e-5 * i;
      ASSERT_EQ(trimtab_session_fly(made.session, &s), TRIMTAB_OK);
      ASSERT_EQ(trimtab_session_request(made.session, s.time_s, 640, 360, nullptr), TRIMTAB_OK);
      double errorPx = 0;
      ASSERT_EQ(trimtab_session_lever(made.session, "screen_space_error", &errorPx, nullptr), TRIMTAB_OK);
      const double there = 1.2e5 * (1 + 0.4 * std::sin(i / 60.0));
      frame.triangles = static_cast<std::uint64_t>(there * std::pow(2 / errorPx, power));
      frame.draw_ms = frame.total_ms = std::normal_distribution<double>(1, 0.02)(random) *
                                       (3 + 2e-4 * static_cast<double>(frame.triangles));
      ASSERT_EQ(trimtab_session_finished(made.session, &frame, s.time_s), TRIMTAB_OK);
      over += i >= kLearning && frame.total_ms > 1.1 * kBudgetMs;
    }
    EXPECT_LE(over, (kImages - kLearning) / 100) << power;
  }
}

TEST(Interface, saysWhyADatagramLeadsToNoState) {
  const Made made;
  char line[300] = "";
  EXPECT_EQ(trimtab_session_datagram(made.session, "nonsense", 8, "127.0.0.1:9", 1, 1), TRIMTAB_NOTHING);
  EXPECT_GT(trimtab_session_explain_host(made.session, line, sizeof line), 20u);
  EXPECT_NE(std::string(line).find("expected"), std::string::npos) << line;
  EXPECT_STREQ(trimtab_session_link(made.session, 1), "never");
}

TEST(Interface, readsAndFillsStructsOfOtherVersions) {
  const Made made;
  struct {
    trimtab_state state;
    double later = 7;
  } newer{};
  newer.state.size = sizeof newer;
  EXPECT_EQ(trimtab_state_clear(&newer.state), TRIMTAB_OK);
  EXPECT_EQ(newer.later, 7) << "a field that this version does not know was written";
  EXPECT_EQ(trimtab_session_fly(made.session, &newer.state), TRIMTAB_OK);
  newer.state.size = sizeof newer.state - 8;
  EXPECT_EQ(trimtab_session_fly(made.session, &newer.state), TRIMTAB_MISUSE);
  EXPECT_EQ(trimtab_session_fly(made.session, nullptr), TRIMTAB_MISUSE);
  double value = 0;
  EXPECT_EQ(trimtab_session_lever(made.session, "no_lever", &value, nullptr), TRIMTAB_MISUSE);
}

}  // namespace
}  // namespace trimtab::test
