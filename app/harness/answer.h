#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "results.h"
#include "trimtab/measure/statistics.h"

/// Answers what a person asks of results: which preset fits the budget, and which of those is the best.
namespace trimtab::harness {

/// Says whether 95 % of the frames of a flight are within the budget, as far as the measured frames can tell;
/// the best comes first.
enum class Fit {
  yes,     ///< it is sure by 95 %
  unsure,  ///< the measured frames are too few, or lie too close to the budget, to tell
  no       ///< it is sure by 95 % that they are not, or no time was measured
};

/// One unit in the numbers that decide. A number that was not measured is NaN, and so is a percentile that
/// the frames are not enough for.
struct AnswerRow {
  UnitName name;
  std::size_t frames = 0;
  double medianMs = 0, p95Ms = 0, p99Ms = 0;  ///< of the frame times
  QuantileBounds p95BoundsMs;                 ///< of the flight's 95th percentile
  double overShare = 0;                       ///< 0..1: the share of frames that are longer than the budget
  double flip = 0;                            ///< mean of the frames
  double geometricPx = 0;                     ///< largest of all frames, px
  double pop = 0;                             ///< 95th percentile of the temporal pop, of 255
  Fit fit = Fit::no;
};

/// Says how one unit of a flight compares with another. The verdict uses one of the two: FLIP where it
/// differs, and the frame time where it does not.
struct UnitDifference {
  MeasuredDifference flip = MeasuredDifference::unknown;
  PairedRatio frameTime;

  /// Returns the difference that decides between the two: less is better.
  MeasuredDifference verdict() const;
};

/// The units of one flight against one budget.
struct Answer {
  std::string flight;
  double budgetMs = 0;
  std::vector<AnswerRow> rows;    ///< in the order of the results
  std::vector<std::size_t> best;  ///< indices into rows, which do not differ; empty if none fits
  std::string why;  ///< whole sentences for a person: why they are the best, or how far off all are

  bool isBest(std::size_t row) const;
};

/// Summarises one unit. If the budget is NaN, nothing fits it.
AnswerRow answerRow(const Unit& unit, double budgetMs);
/// Compares b with a, two units of one flight. Means of FLIP that are equal to three digits do not differ,
/// because nobody reads more.
UnitDifference differenceOf(const Unit& a, const Unit& b, double confidence = kConfidence);

/// Answers for the units of a flight.
///
/// The first of those that fit (if none surely does, of those that may) is the one with the smallest FLIP,
/// or one that is better still because it surely takes less time at a FLIP that does not differ. The best are
/// it and all others that do not differ from it in FLIP and in frame time, whatever the budget cuts between
/// them. However many units there are, in at most 5 of 100 runs noise alone sets apart any two of them.
Answer answerOf(const Results& results, const std::string& flight, double budgetMs);
/// Returns the answer for each flight, in the order of the results, under the budget of the results.
std::vector<Answer> answersOf(const Results& results);
/// Returns "9.8 to 10.3", or "9.8 or more" if there is no upper bound.
std::string boundsText(const QuantileBounds& bounds);
/// Says in a few words what the answer says of a row: "best", "one of the best", "fits", "may fit" or "over
/// budget".
std::string verdictText(const Answer& answer, std::size_t row);
/// Returns those of some rows of an answer that are the best among them, as answerOf() chooses them.
std::vector<std::size_t> bestOf(const Results& results, const Answer& answer,
                                const std::vector<std::size_t>& rows);

}  // namespace trimtab::harness
