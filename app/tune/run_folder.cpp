#include "run_folder.h"

#include <nlohmann/json.hpp>

#include "app/harness/run_plan.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"

namespace trimtab::tune {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Returns what the files of a folder depend on.
harness::PlanLines identityOf(const Plan& plan, const std::string& machine) {
  std::string free;
  for (const std::string& text : plan.free) free += (free.empty() ? "" : " ") + text;
  return {{"format", "trimtab-tune-plan"},
          {"version", plan.version},
          {"machine", machine},
          {"terrain", plan.terrainName + ", checksum " + plan.terrain->info().checksum},
          {"flights", harness::planText(plan.flights)},
          {"held out", harness::planText(plan.heldOut)},
          {"start", harness::planText({harness::Plan::NamedPreset{plan.startName, plan.start}})},
          {"free", free},
          {"size", std::to_string(plan.widthPx) + 'x' + std::to_string(plan.heightPx)},
          {"time", plan.time == TimeMeasure::median ? "median"
                   : plan.time == TimeMeasure::p95  ? "p95"
                                                    : "p99"},
          {"error", std::string(rowOf(plan.error).key)},
          {"drawn rows", std::to_string(plan.drawnRows)},
          {"evaluations", std::to_string(plan.evaluations)},
          {"searches", std::to_string(plan.searches)},
          {"seed", std::to_string(plan.seed)}};
}

}  // namespace

Result<RunFolder> RunFolder::open(const fs::path& folder, const Plan& plan, const std::string& machine) {
  const auto opened = harness::openRunFolder(
      folder, "tune-plan.json", identityOf(plan, machine),
      {"samples-0.json", "search-0.json", "tried", "measured", "presets", "tune.html"});
  if (!opened) return opened.findings();
  return RunFolder(folder);
}

fs::path RunFolder::samplesFile(std::size_t flight) const {
  return folder_ / ("samples-" + std::to_string(flight) + ".json");
}
fs::path RunFolder::searchFile(std::size_t search) const {
  return folder_ / ("search-" + std::to_string(search) + ".json");
}

std::optional<DrawnSamples> RunFolder::samples(std::size_t flight) const {
  const fs::path file = samplesFile(flight);
  const Result<std::string> text = readWhole(file);
  if (!text) return std::nullopt;
  Result<DrawnSamples> samples = parseSamples(*text, file.string());
  if (!samples) return std::nullopt;
  return std::move(samples).value();
}

Result<Done> RunFolder::write(std::size_t flight, const DrawnSamples& samples) const {
  return writeAtomically(samplesFile(flight), toJson(samples));
}

std::optional<std::vector<Candidate>> RunFolder::search(std::size_t search) const {
  const Result<std::string> text = readWhole(searchFile(search));
  if (!text) return std::nullopt;
  try {
    const Json document = Json::parse(*text);
    std::vector<Candidate> front;
    for (const Json& candidate : document.at("front"))
      front.push_back({candidate.at("place"), candidate.at("objectives").get<Objectives>()});
    return front;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

Result<Done> RunFolder::write(std::size_t search, const std::vector<Candidate>& front) const {
  Json candidates = Json::array();
  for (const Candidate& candidate : front)
    candidates.push_back({{"objectives", candidate.objectives}, {"place", candidate.place}});
  return writeAtomically(searchFile(search),
                         Json{{"format", "trimtab-tune-search"}, {"front", candidates}}.dump(1) + '\n');
}

}  // namespace trimtab::tune
