#include "trimtab/hold/cost_model_file.h"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string_view>
#include <thread>
#include <vector>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

constexpr std::string_view kHeader = "trimtab-cost-model 4";

constexpr int kFirstNumber = 3;  ///< its line

/// Names every number that no model can have, with its line.
Findings unsound(const CostModel::State& state, const std::filesystem::path& file) {
  Findings findings;
  int line = kFirstNumber;
  CostModel::State::forEachNumber(state, [&](const std::string& key, double number, double low, double high) {
    if (!(number >= low && number <= high))
      findings.push_back({Severity::warning, file.string() + ':' + std::to_string(line), key,
                          numberText(low, 6) + ".." + numberText(high, 6), numberText(number, 6)});
    ++line;
  });
  return findings;
}

std::string processorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) {
      const std::size_t colon = line.find(": ");
      if (colon != std::string::npos) return line.substr(colon + 2);
    }
  return "unknown processor";
}

}  // namespace

std::string machineName(const std::string& glRenderer) {
  return processorName() + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores; " +
         glRenderer;
}

Result<Done> writeCostModel(const std::filesystem::path& file, const std::string& machine,
                            const CostModel& model) {
  if (auto may = canReplace(file); !may) return may;
  std::string text = std::string(kHeader) + '\n' + machine + '\n';
  const CostModel::State state = model.state();
  if (Findings findings = unsound(state, file); !findings.empty()) return findings;
  CostModel::State::forEachNumber(state, [&](const std::string&, double number, double, double) {
    std::array<char, 32> cell;
    text.append(cell.data(), std::to_chars(cell.data(), cell.data() + cell.size(), number).ptr);
    text += '\n';
  });
  std::error_code ignored;  // a folder that cannot be made is found when the file is written
  std::filesystem::create_directories(file.parent_path(), ignored);
  return writeAtomically(file, text);
}

Result<CostModel::State> readCostModel(const std::filesystem::path& file, const std::string& machine) {
  const Result<std::string> whole = readWhole(file);
  if (!whole) return whole.findings();
  std::string_view text = *whole;
  const auto finding = [&](int line, std::string expected, std::string_view found) {
    return Finding{Severity::warning, file.string() + ':' + std::to_string(line), "", std::move(expected),
                   '"' + std::string(found.substr(0, 60)) + '"'};
  };
  if (const std::string_view header = takeLine(text); header != kHeader)
    return finding(1, '"' + std::string(kHeader) + '"', header);
  if (const std::string_view on = takeLine(text); on != machine)
    return finding(2, "a model of this machine, \"" + machine + '"', on);
  CostModel::State state;
  int line = kFirstNumber - 1;
  std::optional<Finding> bad;
  CostModel::State::forEachNumber(state, [&](const std::string&, double& number, double, double) {
    ++line;
    const std::string_view cell = takeLine(text);
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    const bool good = error == std::errc{} && end == cell.data() + cell.size() && std::isfinite(number);
    if (!good && !bad) bad = finding(line, "a number", cell);
  });
  if (!bad && !text.empty()) bad = finding(line + 1, "the end of the file", takeLine(text));
  if (bad) return *bad;
  if (Findings findings = unsound(state, file); !findings.empty()) return findings;
  return state;
}

Findings recallCostModel(CostModel& model, const std::string& machine) {
  const std::filesystem::path file = costModelFile(machine);
  std::error_code error;
  if (file.empty() || !std::filesystem::exists(file, error)) return {};
  const Result<CostModel::State> state = readCostModel(file, machine);
  if (state) model.restore(*state);
  return state.findings();
}

Findings rememberCostModel(const CostModel& model, const std::string& machine) {
  constexpr std::size_t kWorthWriting = 100;
  const std::filesystem::path file = costModelFile(machine);
  if (file.empty() || model.images() < kWorthWriting) return {};
  return writeCostModel(file, machine, model).findings();
}

std::filesystem::path costModelFile(const std::string& machine) {
  constexpr std::size_t kLongest = 200;
  std::string name = machine.substr(0, kLongest);
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '-';
  const std::filesystem::path inCaches = std::filesystem::path("trimtab") / ("cost-model-" + name + ".txt");
  if (const char* caches = std::getenv("XDG_CACHE_HOME"); caches != nullptr && *caches != '\0')
    return caches / inCaches;
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
    return std::filesystem::path(home) / ".cache" / inCaches;
  return {};
}

}  // namespace trimtab
