#include "run_folder.h"

#include <nlohmann/json.hpp>
#include <system_error>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/preset/sha256.h"
#include "trimtab/units/number.h"

namespace trimtab::tune {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPlanFile = "tune-plan.json";

std::string digestOf(std::string_view text) {
  Sha256 sum;
  sum.add(text);
  return sum.hex().substr(0, 16);
}

/// Returns what the files of a folder depend on, one text for each thing, so that differences can be named.
Json identityOf(const Plan& plan, const std::string& machine) {
  const auto flights = [](const std::vector<harness::Plan::NamedFlight>& list) {
    std::string text;
    for (const auto& flight : list)
      text += (text.empty() ? "" : ", ") + flight.name + " (" + digestOf(flightCsv(flight.flight)) + ')';
    return text.empty() ? std::string("none") : text;
  };
  std::string start, free;
  for (const ParameterRow& row : parameterRows())
    start += std::string(row.key) + '=' + toText(row, row.get(*plan.start)) + '\n';
  for (const std::string& text : plan.free) free += (free.empty() ? "" : " ") + text;
  const terrain::TerrainInfo& info = plan.terrain->info();
  return {{"format", "trimtab-tune-plan"},
          {"version", plan.version},
          {"machine", machine},
          {"terrain", plan.terrainName + ", checksum " + info.checksum},
          {"flights", flights(plan.flights)},
          {"start", plan.startName + " (" + digestOf(start) + ')'},
          {"free", free},
          {"size", std::to_string(plan.widthPx) + 'x' + std::to_string(plan.heightPx)},
          {"time", plan.time == TimeMeasure::median ? "median"
                   : plan.time == TimeMeasure::p95  ? "p95"
                                                    : "p99"},
          {"drawn rows", std::to_string(plan.drawnRows)},
          {"evaluations", std::to_string(plan.evaluations)},
          {"searches", std::to_string(plan.searches)},
          {"seed", std::to_string(plan.seed)}};
}

}  // namespace

Result<RunFolder> RunFolder::open(const fs::path& folder, const Plan& plan, const std::string& machine) {
  const Json wanted = identityOf(plan, machine);
  const fs::path file = folder / kPlanFile;
  std::error_code error;
  if (fs::exists(file, error)) {
    const Result<std::string> text = readWhole(file);
    if (!text) return text.findings();
    const Json held = Json::parse(*text, nullptr, false);
    if (!held.is_object())
      return Finding{Severity::error, file.string(), "", "the plan of a tuning run", "something else"};
    Findings different;
    for (const auto& [key, value] : wanted.items())
      if (const auto at = held.find(key); at == held.end() || *at != value)
        different.push_back({Severity::error, file.string(), key,
                             "what this folder was made with, " +
                                 (at == held.end() ? std::string("nothing") : at->dump()) +
                                 " (or another folder)",
                             value.dump()});
    if (!different.empty()) return different;
    return RunFolder(folder);
  }
  if (fs::exists(folder, error) && !(fs::is_directory(folder, error) && fs::is_empty(folder, error)))
    return Finding{Severity::error, folder.string(), "",
                   "a new or empty folder, or that of a tuning run that was stopped", "something else"};
  fs::create_directories(folder, error);
  if (error)
    return Finding{Severity::error, folder.string(), "", "a folder that can be written", error.message()};
  if (const auto written = writeAtomically(file, wanted.dump(2) + '\n'); !written) return written.findings();
  return RunFolder(folder);
}

fs::path RunFolder::samplesFile(std::size_t flight) const {
  return folder_ / ("samples-" + std::to_string(flight) + ".json");
}
fs::path RunFolder::searchFile(std::size_t search) const {
  return folder_ / ("search-" + std::to_string(search) + ".json");
}

std::optional<DrawnSamples> RunFolder::samples(std::size_t flight) const {
  std::error_code error;
  const fs::path file = samplesFile(flight);
  if (!fs::exists(file, error)) return std::nullopt;
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
  std::error_code error;
  const fs::path file = searchFile(search);
  if (!fs::exists(file, error)) return std::nullopt;
  const Result<std::string> text = readWhole(file);
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
