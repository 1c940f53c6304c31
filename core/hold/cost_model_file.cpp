#include "trimtab/hold/cost_model_file.h"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <span>
#include <string_view>
#include <thread>
#include <vector>

#include "trimtab/preset/file_io.h"
#include "trimtab/preset/preset.h"
#include "trimtab/units/number.h"
#include "trimtab/units/text.h"

namespace trimtab {
namespace {

constexpr std::string_view kHeader = "trimtab-cost-model 4", kHeaderBefore = "trimtab-cost-model 3";

constexpr int kFirstNumber = 3;  ///< its line

/// A number of a file that is read, and its line.
struct Cell {
  double number = 0;
  int line = 0;
};

/// Names every number that no model can have, with its line: that of its cell, or if there are none, the line
/// into which it will be written.
Findings unsound(const CostModel::State& state, const std::filesystem::path& file,
                 std::span<const Cell> cells = {}) {
  Findings findings;
  std::size_t i = 0;
  CostModel::State::forEachNumber(state, [&](const std::string& key, double number, double low, double high) {
    const int line = i < cells.size() ? cells[i].line : kFirstNumber + static_cast<int>(i);
    ++i;
    if (!(number >= low && number <= high))
      findings.push_back({Severity::warning, file.string() + ':' + std::to_string(line), key,
                          numberText(low, 6) + ".." + numberText(high, 6), numberText(number, 6)});
  });
  return findings;
}

/// Makes format 4 of the numbers of format 3, which had one more cost of the ground: that of a triangle times
/// the side of the scene, the third of four. It joins the cost of a triangle, as it was for a scene of a
/// million pixels.
void joinSideOfTriangles(std::vector<Cell>& cells) {
  constexpr std::size_t kClock = 43;  ///< numbers of a clock
  /// Its coefficient, column and row of the covariance, and scale among the numbers of a clock, last first.
  constexpr std::array kSide{22, 18, 15, 14, 13, 12, 10, 6, 2};
  for (const std::size_t clock : {kClock, std::size_t{0}}) {
    if (cells.size() < clock + kClock) continue;
    cells[clock + 1].number += cells[clock + 2].number;
    for (const int i : kSide) cells.erase(cells.begin() + static_cast<std::ptrdiff_t>(clock) + i);
  }
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
  const std::string_view header = takeLine(text);
  if (header != kHeader && header != kHeaderBefore)
    return finding(1, '"' + std::string(kHeader) + '"', header);
  if (const std::string_view on = takeLine(text); on != machine)
    return finding(2, "a model of this machine, \"" + machine + '"', on);
  std::vector<Cell> cells;
  for (int line = kFirstNumber; !text.empty(); ++line) {
    const std::string_view cell = takeLine(text);
    double number = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), number);
    if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(number))
      return finding(line, "a number", cell);
    cells.push_back({number, line});
  }
  const int lines = kFirstNumber + static_cast<int>(cells.size());
  if (header == kHeaderBefore) joinSideOfTriangles(cells);
  CostModel::State state;
  std::size_t count = 0;
  CostModel::State::forEachNumber(state, [&](const std::string&, double& number, double, double) {
    if (count < cells.size()) number = cells[count].number;
    ++count;
  });
  if (cells.size() < count) return finding(lines, "a number", "");
  if (cells.size() > count)
    return finding(cells[count].line, "the end of the file", numberText(cells[count].number, 6));
  if (Findings findings = unsound(state, file, cells); !findings.empty()) return findings;
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
