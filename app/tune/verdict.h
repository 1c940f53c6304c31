#pragma once

#include <string>
#include <vector>

#include "tune.h"

/// Says what drawn presets are worth.
namespace trimtab::tune {

/// Returns the time that a plan counts of a flight, milliseconds; a lower percentile where the frames are too
/// few for it.
double measuredMs(const Plan& plan, const harness::AnswerRow& row);
/// Returns the error that a plan counts of a flight; NaN if it was not measured.
double measuredError(const Plan& plan, const harness::AnswerRow& row);
/// Return the longest time, milliseconds, and the error of the flights [first, first + count).
double longestMs(const Plan& plan, const Tuned& preset, std::size_t first, std::size_t count);
double measuredError(const Plan& plan, const Tuned& preset, std::size_t first, std::size_t count);

/// Sets Tuned::onFront by what was measured on the flights that the search saw.
void markFront(const Plan& plan, std::vector<Tuned>& presets);

/// Returns the answer in whole sentences: the best preset that keeps what the plan asks for on the flights
/// that the search saw, and what it is worth on the others.
std::string answerOf(const Plan& plan, const std::vector<Tuned>& presets);

}  // namespace trimtab::tune
