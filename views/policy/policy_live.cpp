// SPDX-License-Identifier: GPL-3.0-or-later
#include "policy_live.h"

#include <cmath>

#include "views/model/theme.h"

namespace trimtab::views {
namespace {

constexpr double kSampleS = 0.1, kGapS = 5;
constexpr std::size_t kMostSamples = 4000;

QString withUnit(double value, int decimals, std::string_view unit) {
  const QString text = numberText(value, decimals);
  return unit.empty() ? text : text + QLatin1Char(' ') + fromView(unit);
}

}  // namespace

void PolicyTrack::push(double time, const SignalValues& flight) {
  if (!samples_.empty()) {
    const double since = time - samples_.back().time;
    if (since < 0 || since > kGapS) samples_.clear();
    if (since >= 0 && since < kSampleS) return;
  }
  if (samples_.size() == kMostSamples) samples_.pop_front();
  samples_.push_back({time, flight});
  ++revision_;
}

QString signalText(Signal signal, double value) {
  const SignalRow& row = rowOf(signal);
  const double span = row.range.high - row.range.low;
  return withUnit(value, span <= 10 ? 2 : span <= 1000 ? 1 : 0, row.unit);
}

QString leverText(Lever lever, double value) {
  return withUnit(value, 2, rowOf(lever).unit);
}

QString inParentheses(std::string_view unit) {
  return unit.empty() ? QString() : QStringLiteral(" (%1)").arg(fromView(unit));
}

}  // namespace trimtab::views
