#include "store.h"

#include <cstdio>
#include <system_error>

#include "run_plan.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/scene/osg_database.h"
#include "trimtab/units/number.h"

namespace trimtab::harness {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPlanFile = "plan.json";
constexpr const char* kParts = "parts";

std::string rowsText(const std::vector<std::vector<std::size_t>>& rows) {
  std::string text = "rows";
  for (const auto& ofFlight : rows) {
    for (const std::size_t row : ofFlight) text += ' ' + std::to_string(row);
    text += ';';
  }
  return text;
}

/// Returns what a folder's measurements depend on.
PlanLines identity(const Plan& plan, const std::string& machine) {
  const terrain::TerrainInfo& info = plan.terrain->info();
  const bool foreign = dynamic_cast<const scene::OsgDatabase*>(plan.terrain.get()) != nullptr;
  const std::string kind = foreign
                               ? "a scene of OpenSceneGraph of " + std::to_string(info.bytes) + " bytes"
                               : std::to_string(info.columns) + " x " + std::to_string(info.rows) + " posts";
  std::string cases;
  for (const CullingCase method : plan.cases)
    cases += (cases.empty() ? "" : ", ") + std::string(caseName(method));
  return {
      {"format", "trimtab-bench-plan"},
      {"version", plan.version},
      {"machine", machine},
      {"terrain", plan.terrainName + ", " + kind + " from " + numberText(info.southWest.latitude.value()) +
                      ", " + numberText(info.southWest.longitude.value()) + ", checksum " + info.checksum},
      {"flights", planText(plan.flights)},
      {"presets", planText(plan.presets)},
      {"cases", cases},
      {"size", std::to_string(plan.widthPx) + "x" + std::to_string(plan.heightPx)},
      {"frames", plan.rows.empty() ? std::to_string(plan.frames) : rowsText(plan.rows)},
      {"repeats", std::to_string(plan.repeats)},
      {"whole", plan.whole ? "every row drawn" : "rows drawn before sampled frames"},
      {"worst", std::to_string(plan.worst)},
      {"skips", plan.skips ? "measured" : "not measured"}};
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
  const auto opened = openRunFolder(folder, kPlanFile, identity(plan, machine),
                                    {"results.json", "frames.csv", "report.html", kParts});
  if (!opened) return opened.findings();
  std::error_code error;
  fs::create_directories(folder / kParts, error);
  if (error)
    return Finding{Severity::error, (folder / kParts).string(), "", "a folder that can be written",
                   error.message()};
  return Store(folder);
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
