#include "row.h"

#include <time.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace trimtab::bench {
namespace {

std::string number(double value) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}
std::string number(const std::optional<double>& value) {
  return value ? number(*value) : "null";
}

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text,
                std::abs(value) >= 1e5 || (value != 0 && std::abs(value) < 1e-3) ? "%.3g" : "%.5g", value);
  return text;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", static_cast<unsigned>(c));
      out += escape;
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string json(const Row& r) {
  return "{\"id\": " + quoted(r.id) + ", \"what\": " + quoted(r.what) + ", \"value\": " + number(r.value) +
         ", \"unit\": " + quoted(r.unit) + ", \"peer\": " + (r.peer.empty() ? "null" : quoted(r.peer)) +
         ", \"peer_value\": " + number(r.peerValue) +
         ", \"peer_from\": " + (r.peerFrom.empty() ? "null" : quoted(r.peerFrom)) +
         ", \"ratio\": " + number(r.ratio) + ", \"goal\": " + quoted(r.goal) +
         ", \"holds\": " + (r.holds ? "true" : "false") + "}";
}

void print(const Row& r) {
  std::printf("%-5s %-34s %s %s", r.holds ? "holds" : "SHORT", r.id.c_str(), shortNumber(r.value).c_str(),
              r.unit.c_str());
  if (r.peerValue)
    std::printf("; %s: %s %s (%s)", r.peer.c_str(), shortNumber(*r.peerValue).c_str(), r.unit.c_str(),
                r.peerFrom.c_str());
  if (r.ratio) std::printf("; ratio %s", shortNumber(*r.ratio).c_str());
  std::printf("; goal %s\n      %s\n", r.goal.c_str(), r.what.c_str());
  std::fflush(stdout);
}

void completeRatio(Row& row) {
  if (!row.ratio && row.peerValue && *row.peerValue != 0) row.ratio = row.value / *row.peerValue;
}

Row withGoal(Row row, bool ofRatio, bool atLeast, double goal) {
  completeRatio(row);
  row.goal = std::string(ofRatio ? "ratio" : "value") + (atLeast ? " >= " : " <= ") + shortNumber(goal);
  const double measured = ofRatio ? row.ratio.value_or(NAN) : row.value;
  row.holds = atLeast ? measured >= goal : measured <= goal;
  return row;
}

}  // namespace

Row ratioAtLeast(double goal, Row row) {
  return withGoal(std::move(row), true, true, goal);
}
Row ratioAtMost(double goal, Row row) {
  return withGoal(std::move(row), true, false, goal);
}
Row valueAtLeast(double goal, Row row) {
  return withGoal(std::move(row), false, true, goal);
}
Row valueAtMost(double goal, Row row) {
  return withGoal(std::move(row), false, false, goal);
}

Report::Report(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--quick") == 0)
      quick_ = true;
    else if (std::strcmp(argv[i], "--json") == 0)
      json_ = true;
    else if (std::strcmp(argv[i], "--only") == 0 && i + 1 < argc)
      only_ = argv[++i];
    else {
      std::fprintf(stderr, "usage: %s [--quick] [--only PART] [--json]\n", argv[0]);
      std::exit(2);
    }
  }
}

bool Report::wants(const std::string& part) {
  parts_ += " " + part;
  const bool wanted = part.starts_with(only_);
  measured_ |= wanted;
  return wanted;
}

void Report::add(Row row) {
  completeRatio(row);
  if (!json_) print(row);
  rows_.push_back(std::move(row));
}

// One row a line, so that scripts can join the rows of several programs.
int Report::finish() const {
  if (!only_.empty() && !measured_) {
    std::fprintf(stderr, "no part %s; there are:%s\n", only_.c_str(),
                 parts_.empty() ? " none" : parts_.c_str());
    return 2;
  }
  if (!json_) return 0;
  std::printf("{\"rows\": [\n");
  for (std::size_t i = 0; i < rows_.size(); ++i)
    std::printf("%s%s\n", json(rows_[i]).c_str(), i + 1 < rows_.size() ? "," : "");
  std::printf("]}\n");
  return 0;
}

double processorMs() {
  timespec t{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

double monotonicSeconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace trimtab::bench
