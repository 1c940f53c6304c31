#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "results.h"

/// Answers what a person asks of results: which preset fits the budget, and which of those is the best.
namespace trimtab::harness {

/// One unit in the numbers that decide. A number that was not measured is NaN.
struct AnswerRow {
  UnitName name;
  std::size_t frames = 0;
  double medianMs = 0, p95Ms = 0, p99Ms = 0;  ///< of the frame times
  double overShare = 0;                       ///< 0..1: the share of frames that are longer than the budget
  double flip = 0;                            ///< mean of the frames
  double geometricPx = 0;                     ///< largest of all frames, px
  double pop = 0;                             ///< 95th percentile of the temporal pop, of 255
  bool fits = false;                          ///< the 95th percentile of the frame times is within the budget
};

/// The units of one flight against one budget.
struct Answer {
  std::string flight;
  double budgetMs = 0;
  std::vector<AnswerRow> rows;      ///< in the order of the results
  std::optional<std::size_t> best;  ///< index into rows; nothing if none fits
  std::string why;  ///< whole sentences for a person: why it is the best, or how far off all are
};

/// Whether one unit is better than another if both fit: a smaller FLIP to three digits, then a shorter 95th
/// percentile.
bool better(const AnswerRow& one, const AnswerRow& other);
/// Summarises one unit. If the budget is NaN, nothing fits it.
AnswerRow answerRow(const Unit& unit, double budgetMs);
/// Compares the units of a flight. The best one is, of those that fit, the one with the smallest FLIP to
/// three digits, and of equal ones the one with the shortest 95th percentile.
Answer answerOf(const Results& results, const std::string& flight, double budgetMs);
/// Returns the answer for each flight, in the order of the results, under the budget of the results.
std::vector<Answer> answersOf(const Results& results);

}  // namespace trimtab::harness
