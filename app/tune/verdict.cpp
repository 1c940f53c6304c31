#include "verdict.h"

#include <algorithm>
#include <cmath>

#include "trimtab/units/number.h"

namespace trimtab::tune {
namespace {

/// Reports whether a preset keeps what the plan asks for on the flights [first, first + count).
bool fits(const Plan& plan, const Tuned& preset, std::size_t first, std::size_t count) {
  if (plan.maxError) return measuredError(plan, preset, first, count) <= *plan.maxError;
  return !plan.budgetMs || longestMs(plan, preset, first, count) <= *plan.budgetMs;
}

/// Returns what is to be small where the limit is kept.
double worth(const Plan& plan, const Tuned& preset) {
  const std::size_t count = plan.flights.size();
  return plan.maxError ? longestMs(plan, preset, 0, count) : measuredError(plan, preset, 0, count);
}

std::string limitOf(const Plan& plan) {
  if (plan.budgetMs) return "Within " + numberText(*plan.budgetMs, 4) + " ms";
  const ErrorKindRow& error = rowOf(plan.error);
  return "Within a " + std::string(error.words) + " of " + numberText(*plan.maxError, 3) +
         std::string(error.unit);
}

std::string timeText(const harness::AnswerRow& row) {
  if (!std::isfinite(row.p95Ms)) return "median " + numberText(row.medianMs, 3) + " ms";
  return "p95 " + numberText(row.p95Ms, 3) + " ms (" + harness::boundsText(row.p95BoundsMs) + ')';
}

std::string frontText(const std::vector<Tuned>& presets) {
  const auto onFront = [](const Tuned& preset) { return preset.role == Role::found && preset.onFront; };
  const auto count = std::count_if(presets.begin(), presets.end(), onFront);
  return "No limit was asked for: of the presets that were found and drawn, " + std::to_string(count) +
         (count == 1 ? " lies" : " lie") + " on the front of time against error.";
}

constexpr const char* kNotProven = " No flight was held out, so nothing is proven of others.";

}  // namespace

double measuredMs(const Plan& plan, const harness::AnswerRow& row) {
  const double asked = plan.time == TimeMeasure::median ? row.medianMs
                       : plan.time == TimeMeasure::p95  ? row.p95Ms
                                                        : row.p99Ms;
  return std::isfinite(asked) ? asked : std::isfinite(row.p95Ms) ? row.p95Ms : row.medianMs;
}

double longestMs(const Plan& plan, const Tuned& preset, std::size_t first, std::size_t count) {
  double longest = 0;
  for (std::size_t i = first; i < first + count && i < preset.measured.size(); ++i)
    longest = std::max(longest, measuredMs(plan, preset.measured[i]));
  return longest;
}

double measuredError(const Plan& plan, const harness::AnswerRow& row) {
  return row.*rowOf(plan.error).drawn;
}

double measuredError(const Plan& plan, const Tuned& preset, std::size_t first, std::size_t count) {
  std::vector<double> flights;
  for (std::size_t i = first; i < first + count && i < preset.measured.size(); ++i)
    flights.push_back(measuredError(plan, preset.measured[i]));
  return errorOfFlights(plan.error, flights);
}

void markFront(const Plan& plan, std::vector<Tuned>& presets) {
  const std::size_t count = plan.flights.size();
  for (Tuned& preset : presets) {
    const double ms = longestMs(plan, preset, 0, count), error = measuredError(plan, preset, 0, count);
    preset.onFront = std::none_of(presets.begin(), presets.end(), [&](const Tuned& other) {
      const double otherMs = longestMs(plan, other, 0, count),
                   otherError = measuredError(plan, other, 0, count);
      return otherMs <= ms && otherError <= error && (otherMs < ms || otherError < error);
    });
  }
}

std::string answerOf(const Plan& plan, const std::vector<Tuned>& presets) {
  const bool proven = !plan.heldOut.empty();
  if (!plan.budgetMs && !plan.maxError) return frontText(presets) + (proven ? "" : kNotProven);
  const Tuned* best = nullptr;
  for (const Tuned& preset : presets)
    if (fits(plan, preset, 0, plan.flights.size()) &&
        (best == nullptr || worth(plan, preset) < worth(plan, *best)))
      best = &preset;
  if (best == nullptr)
    return limitOf(plan) +
           " on the flights that the search saw: no preset that was drawn. The table says how far each is "
           "off.";
  const std::size_t first = proven ? plan.flights.size() : 0;
  const std::size_t count = proven ? plan.heldOut.size() : plan.flights.size();
  std::string text =
      limitOf(plan) +
      (!proven ? " on the flights that the search saw: preset "
       : fits(plan, *best, first, count)
           ? " on flights that the search has not seen: preset "
           : " on the flights that the search saw, but not on those that it has not seen: there preset ") +
      best->name;
  for (std::size_t i = 0; i < count; ++i) {
    const harness::AnswerRow& row = best->measured[first + i];
    text += (i == 0 ? ", " : "; ");
    if (count > 1) text += (proven ? plan.heldOut[i] : plan.flights[i]).name + ' ';
    text += timeText(row) + ", " + errorText(plan.error, measuredError(plan, row));
  }
  const Tuned& start = presets.front();
  text += "; " + start.name + ' ' + numberText(longestMs(plan, start, first, count), 3) + " ms, " +
          errorText(plan.error, measuredError(plan, start, first, count)) + '.';
  if (!proven) text += kNotProven;
  return text;
}

}  // namespace trimtab::tune
