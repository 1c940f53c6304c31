#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "app/harness/report.h"
#include "app/harness/text.h"
#include "commands.h"
#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"

namespace trimtab::cli {
namespace {

struct ResultsOptions {
  std::vector<std::string> folders;
  std::string output;
  bool json = false;
};

Result<harness::Results> readResults(const std::filesystem::path& folder) {
  const std::filesystem::path file = std::filesystem::is_directory(folder) ? folder / "results.json" : folder;
  const Result<std::string> text = readWhole(file);
  if (!text) return text.findings();
  return harness::parseResults(*text, file.string());
}

/// Joins the units of all runs to one table. Flights of one name over two terrains count as two.
void append(const harness::Results& run, harness::Results& all) {
  const auto named = [&run](harness::UnitName name) {
    name.flight += ", " + run.terrain;
    return name;
  };
  for (harness::Unit unit : run.units) {
    unit.name = named(unit.name);
    all.units.push_back(std::move(unit));
  }
  for (harness::Comparison comparison : run.comparisons) {
    comparison.a = named(comparison.a);
    comparison.b = named(comparison.b);
    all.comparisons.push_back(std::move(comparison));
  }
  all.terrain += (all.terrain.empty() ? "" : "; ") + run.terrain;
}

/// Returns what keeps the figures of two runs from standing in one table.
Findings mismatch(const harness::Results& first, const harness::Results& run, const std::string& folder) {
  Findings findings;
  const auto compare = [&](const char* key, const std::string& expected, const std::string& found) {
    if (expected != found) findings.push_back({Severity::error, folder, key, expected, found});
  };
  const auto size = [](const harness::Results& r) {
    return std::to_string(r.widthPx) + "x" + std::to_string(r.heightPx);
  };
  compare("machine", first.machine, run.machine);
  compare("version", first.version, run.version);
  compare("size", size(first), size(run));
  compare("repeats", std::to_string(first.repeats), std::to_string(run.repeats));
  return findings;
}

int run(const ResultsOptions& arguments) {
  std::optional<harness::Results> all;
  Findings findings;
  for (const std::string& folder : arguments.folders) {
    const auto one = readResults(folder);
    if (!one) {
      findings.insert(findings.end(), one.findings().begin(), one.findings().end());
      continue;
    }
    if (!all) {
      all = *one;
      all->terrain.clear();
      all->units.clear();
      all->comparisons.clear();
    }
    const Findings unlike = mismatch(*all, *one, folder);
    findings.insert(findings.end(), unlike.begin(), unlike.end());
    append(*one, *all);
  }
  report(findings);
  if (!findings.empty()) return kRefused;
  if (!arguments.output.empty()) {
    harness::Results shown = *all;
    // The pictures are in the folders of the runs.
    for (harness::Unit& unit : shown.units) unit.worst.clear();
    const auto written = writeAtomically(arguments.output, harness::htmlReport(shown, {}));
    report(written.findings());
    if (!written) return kRefused;
  }
  std::cout << (arguments.json ? harness::toJson(*all) : harness::toText(*all));
  return std::cout.flush() ? kDone : kRefused;
}

}  // namespace

void addResults(CLI::App& app, int& exitCode) {
  auto arguments = std::make_shared<ResultsOptions>();
  CLI::App* command = app.add_subcommand(
      "results", "Several runs of bench, of one machine and size, as one table and one page");
  command->add_option("folders", arguments->folders, "Folders of bench, or their results.json")->required();
  command->add_option("-o,--output", arguments->output, "HTML page with tables and plots of all runs");
  command->add_flag("--json", arguments->json, "One JSON document on standard output");
  command->callback([arguments, &exitCode] { exitCode = cli::run(*arguments); });
}

}  // namespace trimtab::cli
