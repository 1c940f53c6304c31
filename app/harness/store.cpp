#include "store.h"

#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/sha256.h"
#include "trimtab/scene/osg_database.h"
#include "trimtab/units/number.h"

namespace trimtab::harness {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPlanFile = "plan.json";
constexpr const char* kParts = "parts";

std::string digest(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes);
  return sum.hex().substr(0, 16);
}

std::string flightDigest(const Plan::NamedFlight& flight) {
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
  return digest(text);
}

std::string presetDigest(const ValidatedParameters& parameters) {
  std::string text;
  for (const ParameterRow& row : parameterRows())
    text += std::string(row.key) + '=' + toText(row, row.get(*parameters)) + '\n';
  return digest(text);
}

/// Returns what a folder's measurements depend on, one text for each thing, so that differences can be named.
Json identity(const Plan& plan, const std::string& machine) {
  const terrain::TerrainInfo& info = plan.terrain->info();
  const bool foreign = dynamic_cast<const scene::OsgDatabase*>(plan.terrain.get()) != nullptr;
  const std::string kind = foreign
                               ? "a scene of OpenSceneGraph of " + std::to_string(info.bytes) + " bytes"
                               : std::to_string(info.columns) + " x " + std::to_string(info.rows) + " posts";
  Json json = {
      {"format", "trimtab-bench-plan"},
      {"version", plan.version},
      {"machine", machine},
      {"terrain", plan.terrainName + ", " + kind + " from " + numberText(info.southWest.latitude.value()) +
                      ", " + numberText(info.southWest.longitude.value()) + ", checksum " + info.checksum}};
  std::string flights, presets, cases;
  const auto append = [](std::string& list, const std::string& text) {
    list += (list.empty() ? "" : ", ") + text;
  };
  for (const auto& flight : plan.flights) append(flights, flight.name + " (" + flightDigest(flight) + ")");
  for (const auto& preset : plan.presets)
    append(presets, preset.name + " (" + presetDigest(preset.parameters) + ")");
  for (const CullingCase method : plan.cases) append(cases, std::string(caseName(method)));
  json["flights"] = flights;
  json["presets"] = presets;
  json["cases"] = cases;
  json["size"] = std::to_string(plan.widthPx) + "x" + std::to_string(plan.heightPx);
  json["frames"] = std::to_string(plan.frames);
  json["repeats"] = std::to_string(plan.repeats);
  json["whole"] = plan.whole ? "every row drawn" : "rows drawn before sampled frames";
  json["worst"] = std::to_string(plan.worst);
  json["skips"] = plan.skips ? "measured" : "not measured";
  return json;
}

Findings differences(const fs::path& file, const Json& held, const Json& wanted) {
  Findings findings;
  const auto text = [](const Json& object, const std::string& key) {
    const auto at = object.find(key);
    return at == object.end() ? std::string("nothing")
           : at->is_string()  ? at->get<std::string>()
                              : at->dump();
  };
  for (const auto& [key, value] : wanted.items())
    if (const std::string there = text(held, key), here = text(wanted, key); there != here)
      findings.push_back({Severity::error, file.string(), key,
                          "what this folder was measured with, " + there + " (or another folder)", here});
  return findings;
}

std::string frameFile(std::size_t flight, std::size_t row) {
  char name[64];
  std::snprintf(name, sizeof name, "%s/%zu-%06zu.json", kParts, flight, row);
  return name;
}
std::string skipsFile(std::size_t flight) {
  return std::string(kParts) + '/' + std::to_string(flight) + "-skips.json";
}

}  // namespace

Result<Store> Store::open(const fs::path& folder, const Plan& plan, const std::string& machine) {
  const Store store(folder);
  const Json wanted = identity(plan, machine);
  const fs::path file = folder / kPlanFile;
  std::error_code error;
  if (fs::exists(file, error)) {
    const Result<std::string> text = readWhole(file);
    if (!text) return text.findings();
    const Json held = Json::parse(*text, nullptr, false);
    if (!held.is_object())
      return Finding{Severity::error, file.string(), "", "the plan of a bench run", "something else"};
    if (Findings different = differences(file, held, wanted); !different.empty()) return different;
    return store;
  }
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    return Finding{Severity::error, folder.string(), "", "a folder for the results", "a file"};
  for (const char* name : {"results.json", "frames.csv", "report.html", kParts})
    // An empty folder is left of a run that was stopped before it wrote its plan.
    if (fs::exists(folder / name, error) &&
        !(std::string_view(name) == kParts && fs::is_empty(folder / name, error)))
      return Finding{Severity::error, (folder / name).string(), "",
                     "a new folder, or that of a run that was stopped", "a file without its plan.json"};
  fs::create_directories(folder / kParts, error);
  if (error)
    return Finding{Severity::error, folder.string(), "", "a folder that can be written", error.message()};
  if (const auto written = store.write(kPlanFile, wanted.dump(2) + '\n'); !written) return written.findings();
  return store;
}

Result<Done> Store::write(const std::string& name, const std::string& bytes) const {
  const Result<Done> done = writeAtomically(folder_ / name, bytes);
  if (done) return done;
  return needs(done.findings(), bytes.size());
}

Findings Store::needs(Findings findings, std::size_t bytes) const {
  std::error_code error;
  const fs::space_info space = fs::space(folder_, error);
  for (Finding& finding : findings) {
    finding.expected += " and room for " + std::to_string(bytes) + " bytes";
    if (!error) finding.found += " (" + std::to_string(space.available) + " bytes are free)";
  }
  return findings;
}

std::optional<std::vector<Unit>> Store::read(const std::string& name) const {
  std::error_code error;
  if (!fs::exists(folder_ / name, error)) return std::nullopt;
  const Result<std::string> text = readWhole(folder_ / name);
  if (!text) return std::nullopt;
  // One that cannot be read is measured again.
  Result<Results> results = parseResults(*text, (folder_ / name).string());
  if (!results) return std::nullopt;
  return std::move(results).value().units;
}

std::optional<std::vector<Unit>> Store::frame(std::size_t flight, std::size_t row) const {
  return read(frameFile(flight, row));
}

fs::path Store::fileOf(std::size_t flight, std::size_t row) const {
  return folder_ / frameFile(flight, row);
}

Result<Done> Store::writeFrame(std::size_t flight, std::size_t row, std::vector<Unit> units) const {
  Results part;
  part.units = std::move(units);
  return write(frameFile(flight, row), toJson(part));
}

std::optional<std::vector<Unit>> Store::skips(std::size_t flight) const {
  return read(skipsFile(flight));
}

Result<Done> Store::writeSkips(std::size_t flight, std::vector<Unit> units) const {
  Results part;
  part.units = std::move(units);
  return write(skipsFile(flight), toJson(part));
}

}  // namespace trimtab::harness
