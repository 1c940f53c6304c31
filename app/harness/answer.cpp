#include "answer.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "trimtab/measure/machine_watch.h"
#include "trimtab/units/not_finite.h"
#include "words.h"

namespace trimtab::harness {
namespace {

/// A budget is held if this share of the frames is within it.
constexpr double kHeldShare = 0.95;

/// Returns the value, or infinity if it was not measured: that is worse than whatever was.
double orWorst(double value) {
  return std::isnan(value) ? kInfinity : value;
}

/// Rounds a value as a person sees it, because a difference that nobody reads decides nothing.
double toThreeDigits(double value) {
  if (!std::isfinite(value) || value == 0) return orWorst(value);
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2);
  return std::round(value / unit) * unit;
}

double shareOver(const Unit& unit, double budgetMs) {
  std::size_t timed = 0, over = 0;
  for (const MeasuredFrame& frame : unit.frames) {
    if (std::isnan(frame.cost.total)) continue;
    ++timed;
    if (frame.cost.total > budgetMs) ++over;
  }
  if (timed == 0 || std::isnan(budgetMs)) return kNan;
  return static_cast<double>(over) / static_cast<double>(timed);
}

std::string percentText(double share) {
  return fixedText(share * 100, share > 0 && share < 0.1 ? 1 : 0) + " %";
}

/// Names a unit, such as "default (proposed)".
std::string nameText(const AnswerRow& row) {
  return row.name.preset + " (" + caseText(row.name.method) + ')';
}

std::string namesText(const Answer& answer, const std::vector<std::size_t>& rows) {
  std::vector<std::string> names;
  for (const std::size_t row : rows) names.push_back(nameText(answer.rows[row]));
  return enumerated(names);
}

/// The units of an answer's rows, compared as strictly as their number demands.
class Judge {
 public:
  Judge(const Results& results, const Answer& answer) {
    for (const Unit& unit : results.units)
      if (unit.name.flight == answer.flight) units_.push_back(&unit);
    // Any two of them may be set apart, by either of two quantities.
    const double pairs = static_cast<double>(units_.size() * (units_.size() - 1)) / 2;
    confidence_ = 1 - (1 - kConfidence) / std::max(1.0, 2 * pairs);
  }

  UnitDifference compare(std::size_t with, std::size_t row) const {
    return differenceOf(*units_[with], *units_[row], confidence_);
  }

  /// Returns the best of some rows: the one that leads, then those that do not differ from it.
  std::vector<std::size_t> bestOf(const Answer& answer, std::vector<std::size_t> rows) const {
    const auto rank = [&](std::size_t row) {
      return std::tuple(orWorst(answer.rows[row].flip), orWorst(answer.rows[row].medianMs));
    };
    std::stable_sort(rows.begin(), rows.end(),
                     [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    if (rows.empty()) return rows;
    std::size_t leader = rows.front();
    for (const std::size_t row : rows)
      if (compare(leader, row).verdict() == MeasuredDifference::less) leader = row;
    std::erase_if(rows, [&](std::size_t row) {
      return row == leader || compare(leader, row).verdict() == MeasuredDifference::more;
    });
    rows.insert(rows.begin(), leader);
    return rows;
  }

 private:
  std::vector<const Unit*> units_;
  double confidence_ = kConfidence;
};

std::vector<std::size_t> rowsOf(const Answer& answer, Fit fit) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < answer.rows.size(); ++i)
    if (answer.rows[i].fit == fit) rows.push_back(i);
  return rows;
}

/// "FLIP 0.0112 and p95 10 ms", of one row or of the range of several.
std::string numbersText(const Answer& answer) {
  const auto range = [&](double AnswerRow::*of) {
    double low = kInfinity, high = -kInfinity;
    for (const std::size_t row : answer.best)
      if (const double value = answer.rows[row].*of; std::isfinite(value))
        low = std::min(low, value), high = std::max(high, value);
    if (low > high) return std::string("-");
    const std::string from = roundedText(low), to = roundedText(high);
    return from == to ? from : from + " to " + to;
  };
  return "FLIP " + range(&AnswerRow::flip) + ", p95 " + range(&AnswerRow::p95Ms) + " ms";
}

/// Returns which of those that fit comes next, and by how much it is behind.
std::string nextText(const Answer& answer, const Judge& judge, const std::vector<std::size_t>& fitting) {
  std::vector<std::size_t> others;
  for (const std::size_t row : fitting)
    if (!answer.isBest(row)) others.push_back(row);
  if (others.empty()) return answer.best.size() < answer.rows.size() ? "Nothing else surely fits." : "";
  const std::size_t next = judge.bestOf(answer, others).front();
  const UnitDifference difference = judge.compare(answer.best.front(), next);
  const std::string name = nameText(answer.rows[next]);
  return difference.flip == MeasuredDifference::more
             ? name + " follows with a FLIP of " + roundedText(answer.rows[next].flip) + '.'
             : name + " follows: its FLIP does not differ, and its frames are " +
                   inWords(difference.frameTime) + '.';
}

std::string bestText(const Answer& answer, const Judge& judge, const std::vector<std::size_t>& fitting,
                     Fit fit) {
  const std::string budget = roundedText(answer.budgetMs) + " ms";
  const bool alone = answer.best.size() == 1;
  const bool told = std::none_of(answer.best.begin() + 1, answer.best.end(), [&](std::size_t row) {
    return judge.compare(answer.best.front(), row).verdict() == MeasuredDifference::unknown;
  });
  std::string text = namesText(answer, answer.best) +
                     (alone  ? " is"
                      : told ? " do not differ, and are"
                             : " cannot be told apart by so few frames, and are") +
                     " the best under " + budget + " (" + numbersText(answer) + ").";
  if (fit == Fit::unsure)
    text += " That 95 % of the frames are within the budget is not sure of " +
            std::string(alone ? "it" : "any") + ": measure more frames.";
  if (const std::string next = nextText(answer, judge, fitting); !next.empty()) text += ' ' + next;
  std::vector<std::size_t> open = rowsOf(answer, Fit::unsure);
  std::erase_if(open, [&](std::size_t row) { return answer.isBest(row); });
  if (fit == Fit::yes && !open.empty())
    text += " Whether " + namesText(answer, open) + (open.size() == 1 ? " fits" : " fit") +
            " cannot be told from " + counted(answer.rows[open.front()].frames, "frame") + '.';
  return text;
}

std::string noneText(const Answer& answer) {
  if (answer.rows.empty()) return "Nothing was measured.";
  if (std::isnan(answer.budgetMs)) return "No budget is known, so that none can be said to fit.";
  const AnswerRow& closest =
      *std::min_element(answer.rows.begin(), answer.rows.end(), [](const AnswerRow& a, const AnswerRow& b) {
        return std::tuple(orWorst(a.overShare), orWorst(a.medianMs), orWorst(a.flip)) <
               std::tuple(orWorst(b.overShare), orWorst(b.medianMs), orWorst(b.flip));
      });
  return "None fits " + roundedText(answer.budgetMs) + " ms; " + nameText(closest) + " comes closest, with " +
         percentText(closest.overShare) + " of its frames over it.";
}

}  // namespace

MeasuredDifference UnitDifference::verdict() const {
  return flip == MeasuredDifference::less || flip == MeasuredDifference::more
             ? flip
             : trimtab::differenceOf(frameTime);
}

bool Answer::isBest(std::size_t row) const {
  return std::find(best.begin(), best.end(), row) != best.end();
}

UnitDifference differenceOf(const Unit& a, const Unit& b, double confidence) {
  const Quantity& flip = *quantityOf("flip");
  const auto valuesOf = [&](const Unit& unit) {
    std::vector<double> values;
    for (const MeasuredFrame& frame : unit.frames) values.push_back(flip.of(frame));
    return values;
  };
  UnitDifference difference{MeasuredDifference::none, frameTimeRatio(a, b, confidence)};
  const double meanA = summarise(a, flip).mean, meanB = summarise(b, flip).mean;
  if (std::isnan(meanA) != std::isnan(meanB))
    difference.flip = std::isnan(meanA) ? MeasuredDifference::less : MeasuredDifference::more;
  else if (toThreeDigits(meanA) != toThreeDigits(meanB))
    difference.flip = errorDifference(valuesOf(a), valuesOf(b), confidence);
  return difference;
}

AnswerRow answerRow(const Unit& unit, double budgetMs) {
  const auto of = [&unit](const char* key) { return summarise(unit, *quantityOf(key)); };
  const Summary ms = of("frame_ms");
  AnswerRow row;
  row.name = unit.name;
  row.frames = unit.frames.size();
  row.medianMs = ms.median;
  row.p95Ms = ms.p95;
  row.p99Ms = ms.p99;
  row.p95BoundsMs = quantileBounds(finiteOf(unit, *quantityOf("frame_ms")), kHeldShare);
  row.overShare = shareOver(unit, budgetMs);
  row.flip = of("flip").mean;
  row.geometricPx = of("geometric_max_px").worst;
  row.pop = of("pop").p95;
  row.fit = row.p95BoundsMs.high <= budgetMs  ? Fit::yes
            : row.p95BoundsMs.low <= budgetMs ? Fit::unsure
                                              : Fit::no;
  return row;
}

Answer answerOf(const Results& results, const std::string& flight, double budgetMs) {
  Answer answer{flight, budgetMs, {}, {}, {}};
  for (const Unit& unit : results.units)
    if (unit.name.flight == flight) answer.rows.push_back(answerRow(unit, budgetMs));
  const Judge judge(results, answer);
  Fit fit = Fit::yes;
  std::vector<std::size_t> fitting = rowsOf(answer, fit);
  if (fitting.empty()) fitting = rowsOf(answer, fit = Fit::unsure);
  answer.best = judge.bestOf(answer, fitting);
  // A budget that lies between two that do not differ does not make them differ.
  for (std::size_t row = 0; row < answer.rows.size() && !fitting.empty(); ++row)
    if (answer.rows[row].fit != fit && std::isfinite(answer.rows[row].medianMs) &&
        judge.compare(answer.best.front(), row).verdict() == MeasuredDifference::none)
      answer.best.push_back(row);
  answer.why = answer.best.empty() ? noneText(answer) : bestText(answer, judge, fitting, fit);
  if (const std::string busy = busyText(results.othersShare); !busy.empty()) answer.why += ' ' + busy;
  return answer;
}

std::vector<Answer> answersOf(const Results& results) {
  std::vector<Answer> answers;
  for (const Unit& unit : results.units) {
    const bool known = std::any_of(answers.begin(), answers.end(),
                                   [&](const Answer& answer) { return answer.flight == unit.name.flight; });
    if (!known) answers.push_back(answerOf(results, unit.name.flight, results.budgetMs));
  }
  return answers;
}

std::string boundsText(const QuantileBounds& bounds) {
  if (std::isfinite(bounds.low) && std::isfinite(bounds.high))
    return roundedText(bounds.low) + " to " + roundedText(bounds.high);
  if (std::isfinite(bounds.low)) return roundedText(bounds.low) + " or more";
  return std::isfinite(bounds.high) ? roundedText(bounds.high) + " or less" : "-";
}

std::string verdictText(const Answer& answer, std::size_t row) {
  const Fit fit = answer.rows[row].fit;
  const std::string fits = fit == Fit::yes ? "fits" : fit == Fit::unsure ? "may fit" : "over budget";
  if (!answer.isBest(row)) return fits;
  const std::string best = answer.best.size() == 1 ? "best" : "one of the best";
  return fit == Fit::yes ? best : best + ", " + fits;
}

std::vector<std::size_t> bestOf(const Results& results, const Answer& answer,
                                const std::vector<std::size_t>& rows) {
  const auto of = [&](Fit fit) {
    std::vector<std::size_t> kept;
    for (const std::size_t row : rows)
      if (answer.rows[row].fit == fit) kept.push_back(row);
    return kept;
  };
  const std::vector<std::size_t> sure = of(Fit::yes);
  return Judge(results, answer).bestOf(answer, sure.empty() ? of(Fit::unsure) : sure);
}

}  // namespace trimtab::harness
