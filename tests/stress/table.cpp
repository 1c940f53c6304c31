#include "table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

#include "tests/support.h"

namespace trimtab::stress {
namespace {

struct Entry {
  std::string field, name, unit, why;
  double worst, bound;
  std::size_t seen;

  bool holds() const { return seen > 0 && worst <= bound; }
  bool hasMargin() const { return bound > 0 && worst > 0; }
  double margin() const { return bound / worst; }
};

std::vector<Entry>& entries() {
  static std::vector<Entry> list;
  return list;
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::string marginText(const Entry& e) {
  if (!e.holds()) return "FAILS";
  if (e.bound == 0) return "exact";
  return e.hasMargin() ? formatted("%.3g", e.margin()) : "no error";
}

std::string table() {
  std::string text =
      "| field | case | worst | bound | margin | unit | samples | why this bound |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const Entry& e : entries())
    text += formatted("| %s | %s | %.3g | %.3g | %s | %s | %zu | ", e.field.c_str(), e.name.c_str(), e.worst,
                      e.bound, marginText(e).c_str(), e.unit.c_str(), e.seen) +
            e.why + " |\n";
  const auto failing =
      std::count_if(entries().begin(), entries().end(), [](const Entry& e) { return !e.holds(); });
  const Entry* least = nullptr;
  for (const Entry& e : entries())
    if (e.hasMargin() && (least == nullptr || e.margin() < least->margin())) least = &e;
  text +=
      formatted("\n%zu cases, %zu beyond their bound", entries().size(), static_cast<std::size_t>(failing));
  if (least != nullptr)
    text +=
        formatted("; worst margin %.3g (%s: %s)", least->margin(), least->field.c_str(), least->name.c_str());
  return text + '\n';
}

/// The table of a whole run goes to build/stress.txt; TRIMTAB_STRESS_TABLE names another place, and then a
/// part of the suite is written as well.
std::filesystem::path tableFile() {
  if (const char* file = std::getenv("TRIMTAB_STRESS_TABLE")) return file;
  if (GTEST_FLAG_GET(filter) != "*") return {};
  return test::programDir().parent_path() / "stress.txt";
}

class Printer : public testing::Environment {
 public:
  void TearDown() override {
    const std::string text = table();
    std::cout << text << std::flush;
    const std::filesystem::path file = tableFile();
    if (file.empty()) return;
    std::ofstream out(file, std::ios::binary);
    out << text;
    out.close();
    EXPECT_TRUE(out) << "cannot write " << file;
  }
};

[[maybe_unused]] const testing::Environment* const kPrinter =
    testing::AddGlobalTestEnvironment(new Printer);  // GoogleTest deletes it

}  // namespace

bool isLong() {
  const char* value = std::getenv("TRIMTAB_STRESS_LONG");
  return value != nullptr && std::string(value) != "0" && std::string(value) != "";
}

Case::Case(std::string field, std::string name, double bound, std::string unit, std::string why)
    : row_(entries().size()) {
  entries().push_back({std::move(field), std::move(name), std::move(unit), std::move(why), 0, bound, 0});
}

Case::~Case() {
  Entry& entry = entries()[row_];
  entry.worst = worst_;
  entry.seen = seen_;
  EXPECT_GT(seen_, 0u) << entry.field << ": " << entry.name << ": nothing was tried";
  EXPECT_TRUE(entry.holds() || seen_ == 0)
      << entry.field << ": " << entry.name << ": worst " << digits(worst_) << ' ' << entry.unit << " beyond "
      << digits(entry.bound) << (at_.empty() ? "" : " at " + at_);
}

std::string digits(double value) {
  return formatted("%.17g", value);
}

}  // namespace trimtab::stress
