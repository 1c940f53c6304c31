#include "run_plan.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <system_error>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/sha256.h"
#include "trimtab/units/number.h"

namespace trimtab::harness {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string digestOf(const Plan::NamedFlight& flight) {
  std::string text = flightCsv(flight.flight);
  // These values have no columns in a flight's file.
  for (const AircraftState& state : flight.flight.states) {
    if (state.aboveGround) text += numberText(state.aboveGround->value()) + ' ';
    if (state.airspeed) text += numberText(state.airspeed->value()) + ' ';
    if (state.velocity)
      for (const MetresPerSecond v : {state.velocity->north, state.velocity->east, state.velocity->down})
        text += numberText(v.value()) + ' ';
    text += '\n';
  }
  return text;
}

std::string digestOf(const Plan::NamedPreset& preset) {
  std::string text;
  for (const ParameterRow& row : parameterRows())
    text += std::string(row.key) + '=' + toText(row, row.get(*preset.parameters)) + '\n';
  return text;
}

template <class Named>
std::string textOf(const std::vector<Named>& list) {
  std::string text;
  for (const Named& named : list) {
    Sha256 sum;
    sum.add(digestOf(named));
    text += (text.empty() ? "" : ", ") + named.name + " (" + sum.hex().substr(0, 16) + ')';
  }
  return text.empty() ? "none" : text;
}

Findings differences(const fs::path& file, const Json& held, const PlanLines& wanted) {
  Findings findings;
  for (const auto& [key, here] : wanted) {
    const auto at = held.find(key);
    const std::string there = at == held.end()  ? "nothing"
                              : at->is_string() ? at->get<std::string>()
                                                : at->dump();
    if (there != here)
      findings.push_back({Severity::error, file.string(), key,
                          "what this folder was made with, " + there + " (or another folder)", here});
  }
  return findings;
}

}  // namespace

std::string planText(const std::vector<Plan::NamedFlight>& flights) {
  return textOf(flights);
}
std::string planText(const std::vector<Plan::NamedPreset>& presets) {
  return textOf(presets);
}

Result<Done> openRunFolder(const fs::path& folder, const char* planFile, const PlanLines& plan,
                           std::initializer_list<const char*> results) {
  const fs::path file = folder / planFile;
  std::error_code error;
  if (fs::exists(file, error)) {
    const Result<std::string> text = readWhole(file);
    if (!text) return text.findings();
    const Json held = Json::parse(*text, nullptr, false);
    if (!held.is_object())
      return Finding{Severity::error, file.string(), "", "the plan of a run", "something else"};
    if (Findings different = differences(file, held, plan); !different.empty()) return different;
    return Done{};
  }
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    return Finding{Severity::error, folder.string(), "", "a folder for the results", "a file"};
  for (const char* name : results)
    if (fs::exists(folder / name, error))
      return Finding{Severity::error, (folder / name).string(), "",
                     "a new folder, or that of a run that was stopped",
                     std::string("a file without its ") + planFile};
  fs::create_directories(folder, error);
  if (error)
    return Finding{Severity::error, folder.string(), "", "a folder that can be written", error.message()};
  Json json;
  for (const auto& [key, value] : plan) json[key] = value;
  return writeAtomically(file, json.dump(2) + '\n');
}

}  // namespace trimtab::harness
