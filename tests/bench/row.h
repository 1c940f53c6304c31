#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

/// Rows of measured facts: what every benchmark program prints, as text or as JSON.
namespace trimtab::bench {

/// A measured number beside a peer's. `ratio` is value / peerValue unless it is given.
struct Row {
  std::string id;    ///< "group.what"
  std::string what;  ///< a sentence
  double value = 0;
  std::string unit = {};
  std::string peer = {};  ///< what it is held against; empty: nothing but the goal
  std::optional<double> peerValue = {};
  std::string peerFrom = {};  ///< "run": measured here and now; "quoted": from a publication
  std::optional<double> ratio = {};
  std::string goal = {};  ///< filled in by the functions below
  bool holds = true;
};

// A row with its goal, held or not. NaN holds no goal.

Row ratioAtLeast(double goal, Row row);
Row ratioAtMost(double goal, Row row);
Row valueAtLeast(double goal, Row row);
Row valueAtMost(double goal, Row row);

/// Options --quick, --only and --json, and the rows so far. In text mode rows are printed as they come.
class Report {
 public:
  /// Ends the program with status 2 on any other option.
  Report(int argc, char** argv);
  bool quick() const { return quick_; }
  /// Whether to measure a part of the program: with --only, one whose name begins with what was asked for.
  bool wants(const std::string& part);
  void add(Row row);
  /// Prints what is left; the program's exit status: 0 whether goals hold or not, 2 if --only names no part.
  int finish() const;

 private:
  bool quick_ = false, json_ = false, measured_ = false;
  std::string only_, parts_;
  std::vector<Row> rows_;
};

/// Seconds that `work` takes: the least of `repeats` runs, after one that is not counted.
template <class Work>
double leastSeconds(int repeats, const Work& work);

/// The same for several works in turn, so that all have the machine as it is: the least of `turns`. Each work
/// is a pair of its repeats a turn and itself.
template <class... Works>
std::array<double, sizeof...(Works)> leastInTurn(int turns, const Works&... works);

/// Keeps the compiler from leaving out what makes `value`.
template <class T>
inline void keep(const T& value) {
  asm volatile("" : : "r,m"(value) : "memory");
}

double monotonicSeconds();
/// Returns the processor time of all threads of this program so far, milliseconds. Other programs add little
/// to it.
double processorMs();

template <class Work>
double leastSeconds(int repeats, const Work& work) {
  work();
  double least = 0;
  for (int i = 0; i < repeats; ++i) {
    const double start = monotonicSeconds();
    work();
    const double took = monotonicSeconds() - start;
    if (i == 0 || took < least) least = took;
  }
  return least;
}

template <class... Works>
std::array<double, sizeof...(Works)> leastInTurn(int turns, const Works&... works) {
  std::array<double, sizeof...(Works)> least{};
  for (int turn = 0; turn < turns; ++turn) {
    const std::array<double, sizeof...(Works)> now{leastSeconds(works.first, works.second)...};
    for (std::size_t i = 0; i < now.size(); ++i)
      least[i] = turn == 0 || now[i] < least[i] ? now[i] : least[i];
  }
  return least;
}

}  // namespace trimtab::bench
