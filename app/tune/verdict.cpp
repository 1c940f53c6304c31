#include "verdict.h"

#include <algorithm>
#include <cmath>

#include "trimtab/units/number.h"

namespace trimtab::tune {
namespace {

/// Reports whether a preset keeps what the plan asks for on the flights that the search saw.
bool fits(const Plan& plan, const Tuned& preset) {
  const std::size_t count = plan.flights.size();
  if (plan.maxError) return meanFlip(preset, 0, count) <= *plan.maxError;
  return !plan.budgetMs || longestMs(plan, preset, 0, count) <= *plan.budgetMs;
}

/// Returns what is to be small where the limit is kept.
double worth(const Plan& plan, const Tuned& preset) {
  const std::size_t count = plan.flights.size();
  return plan.maxError ? longestMs(plan, preset, 0, count) : meanFlip(preset, 0, count);
}

std::string limitOf(const Plan& plan) {
  if (plan.budgetMs) return "Within " + numberText(*plan.budgetMs, 4) + " ms";
  if (plan.maxError) return "Within a mean FLIP of " + numberText(*plan.maxError, 3);
  return "Without a limit";
}

}  // namespace

double measuredMs(const Plan& plan, const harness::AnswerRow& row) {
  if (plan.time == TimeMeasure::median) return row.medianMs;
  return plan.time == TimeMeasure::p99 && std::isfinite(row.p99Ms) ? row.p99Ms : row.p95Ms;
}

double longestMs(const Plan& plan, const Tuned& preset, std::size_t first, std::size_t count) {
  double longest = 0;
  for (std::size_t i = first; i < first + count && i < preset.measured.size(); ++i)
    longest = std::max(longest, measuredMs(plan, preset.measured[i]));
  return longest;
}

double meanFlip(const Tuned& preset, std::size_t first, std::size_t count) {
  double sum = 0;
  for (std::size_t i = first; i < first + count && i < preset.measured.size(); ++i)
    sum += preset.measured[i].flip;
  return sum / static_cast<double>(count);
}

void markFront(const Plan& plan, std::vector<Tuned>& presets) {
  const std::size_t count = plan.flights.size();
  for (Tuned& preset : presets) {
    const double ms = longestMs(plan, preset, 0, count), flip = meanFlip(preset, 0, count);
    preset.onFront = std::none_of(presets.begin(), presets.end(), [&](const Tuned& other) {
      const double otherMs = longestMs(plan, other, 0, count), otherFlip = meanFlip(other, 0, count);
      return otherMs <= ms && otherFlip <= flip && (otherMs < ms || otherFlip < flip);
    });
  }
}

std::string answerOf(const Plan& plan, const std::vector<Tuned>& presets) {
  const Tuned* best = nullptr;
  for (const Tuned& preset : presets)
    if (fits(plan, preset) && (best == nullptr || worth(plan, preset) < worth(plan, *best))) best = &preset;
  if (best == nullptr)
    return limitOf(plan) +
           " on the flights that the search saw: no preset that was drawn. The table says how far each is "
           "off.";
  const bool proven = !plan.heldOut.empty();
  const std::size_t first = proven ? plan.flights.size() : 0;
  const std::size_t count = proven ? plan.heldOut.size() : plan.flights.size();
  std::string text = limitOf(plan) +
                     (proven ? " on flights that the search has not seen: preset "
                             : " on the flights that the search saw: preset ") +
                     best->name;
  for (std::size_t i = 0; i < count; ++i) {
    const harness::AnswerRow& row = best->measured[first + i];
    text += (i == 0 ? ", " : "; ");
    if (count > 1) text += (proven ? plan.heldOut[i] : plan.flights[i]).name + ' ';
    text += "p95 " + numberText(row.p95Ms, 3) + " ms (" + harness::boundsText(row.p95BoundsMs) + "), FLIP " +
            numberText(row.flip, 2);
  }
  const Tuned& start = presets.front();
  text += "; " + start.name + ' ' + numberText(longestMs(plan, start, first, count), 3) + " ms, FLIP " +
          numberText(meanFlip(start, first, count), 2) + '.';
  if (!proven) text += " No flight was held out, so nothing is proven of others.";
  return text;
}

}  // namespace trimtab::tune
