#include "answer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "app/plot/svg.h"
#include "html_model.h"
#include "trimtab/units/not_finite.h"

namespace trimtab::harness {
namespace {

/// What was not measured is worse than whatever was.
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
  if (timed == 0 || std::isnan(budgetMs)) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(over) / static_cast<double>(timed);
}

std::string percentText(double share) {
  return plot::decimal(share * 100, share > 0 && share < 0.1 ? 1 : 0) + " %";
}

/// Names a unit, such as "default (proposed)".
std::string nameText(const AnswerRow& row) {
  return row.name.preset + " (" + caseText(row.name.method) + ')';
}

std::string bestText(const Answer& answer, const std::vector<std::size_t>& ranked) {
  const AnswerRow& best = answer.rows[ranked.front()];
  std::string text = nameText(best) + " is the best under " + roundedText(answer.budgetMs) +
                     " ms: " + percentText(1 - best.overShare) + " of its frames are within it (p95 " +
                     roundedText(best.p95Ms) + " ms)";
  if (ranked.size() == 1) return text + ", and nothing else fits.";
  const std::string fitting = " of the " + std::to_string(ranked.size()) + " that fit";
  const AnswerRow& next = answer.rows[ranked[1]];
  if (toThreeDigits(next.flip) != toThreeDigits(best.flip))
    return text + ". It has the smallest FLIP" + fitting + ", " + roundedText(best.flip) + "; " +
           nameText(next) + " follows with " + roundedText(next.flip) + '.';
  text += std::isnan(best.flip) ? ". None" + fitting + " has a FLIP"
                                : ". It shares the smallest FLIP" + fitting + ", " + roundedText(best.flip);
  return text + "; it has the shortest p95 of these, and " + nameText(next) + " follows with " +
         roundedText(next.p95Ms) + " ms.";
}

std::string noneText(const Answer& answer) {
  if (answer.rows.empty()) return "Nothing was measured.";
  if (std::isnan(answer.budgetMs)) return "No budget is known, so that none can be said to fit.";
  const AnswerRow& closest =
      *std::min_element(answer.rows.begin(), answer.rows.end(), [](const AnswerRow& a, const AnswerRow& b) {
        return std::tuple(orWorst(a.p95Ms), orWorst(a.flip)) < std::tuple(orWorst(b.p95Ms), orWorst(b.flip));
      });
  return "None fits " + roundedText(answer.budgetMs) +
         " ms, because more than 5 % of the frames of each are longer. " + nameText(closest) +
         " comes closest, with a p95 of " + roundedText(closest.p95Ms) + " ms and " +
         percentText(closest.overShare) + " of its frames over the budget.";
}

}  // namespace

bool better(const AnswerRow& one, const AnswerRow& other) {
  return std::tuple(toThreeDigits(one.flip), one.p95Ms) < std::tuple(toThreeDigits(other.flip), other.p95Ms);
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
  row.overShare = shareOver(unit, budgetMs);
  row.flip = of("flip").mean;
  row.geometricPx = of("geometric_max_px").worst;
  row.pop = of("pop").p95;
  row.fits = row.p95Ms <= budgetMs;
  return row;
}

Answer answerOf(const Results& results, const std::string& flight, double budgetMs) {
  Answer answer{flight, budgetMs, {}, {}, {}};
  std::vector<std::size_t> ranked;
  for (const Unit& unit : results.units) {
    if (unit.name.flight != flight) continue;
    if (answer.rows.emplace_back(answerRow(unit, budgetMs)).fits) ranked.push_back(answer.rows.size() - 1);
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [&](std::size_t a, std::size_t b) { return better(answer.rows[a], answer.rows[b]); });
  if (!ranked.empty()) answer.best = ranked.front();
  answer.why = answer.best ? bestText(answer, ranked) : noneText(answer);
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

}  // namespace trimtab::harness
